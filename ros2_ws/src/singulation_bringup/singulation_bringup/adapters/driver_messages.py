"""Message types of drivers that may or may not be installed; looked for when they are needed, not before."""

import importlib
from typing import Any

from singulation_core import ResultCode, SingulationError


def driver_type(package: str, kind: str, name: str, source: str) -> Any:
    """A message or service type of a driver.

    Args:
        package: such as ``abb_robot_msgs``.
        kind: ``msg`` or ``srv``.
        name: of the type.
        source: where the package comes from, for the text.

    Raises:
        SingulationError: ``NOT_READY``: it is not installed, or not sourced.
    """
    try:
        return getattr(importlib.import_module(f"{package}.{kind}"), name)
    except (ImportError, AttributeError) as error:
        raise SingulationError(
            ResultCode.NOT_READY,
            f"{package}/{kind}/{name} cannot be imported ({error}); build or install {source} "
            "and source it before this workspace",
        ) from None
