"""The policies by name. A module in this folder that registers a ranking function is a policy; no list is kept."""

import importlib
import pkgutil
from collections.abc import Mapping
from types import MappingProxyType

from singulation_core import ResultCode, SingulationError
from singulation_planner.policy import REGISTERED, Policy

for _module in pkgutil.iter_modules(__path__, f"{__name__}."):
    importlib.import_module(_module.name)

POLICIES: Mapping[str, Policy] = MappingProxyType(REGISTERED)


def find_policy(name: str) -> Policy:
    """The policy of this name.

    Raises:
        SingulationError: ``UNKNOWN_POLICY``, listing the valid names.
    """
    found = POLICIES.get(name)
    if found is None:
        raise SingulationError(
            ResultCode.UNKNOWN_POLICY, f"unknown policy {name!r}; one of: {', '.join(sorted(POLICIES))}"
        )
    return found
