"""Message definitions for bags: ROS's own from rosbags, ours from the ``.msg`` files where they are installed."""

import os
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from singulation_core import InvalidInputError


@cache
def typestore() -> Typestore:
    """The types of ROS 2 Jazzy; ``register_type`` adds to it."""
    return get_typestore(Stores.ROS2_JAZZY)


def register_type(name: str) -> None:
    """Make ``package/msg/Type`` and the types it is made of known to ``typestore()``.

    Raises:
        InvalidInputError: a definition is not installed; says where it was looked for.
    """
    store = typestore()
    missing = {name} - store.fielddefs.keys()
    while missing:
        found = {one: get_types_from_msg(_definition(one), one)[one] for one in missing}
        store.register(found)
        used = {part for definition in found.values() for part in _referenced(definition)}
        missing = used - store.fielddefs.keys()


def _definition(name: str) -> str:
    package, _, short = name.split("/")
    prefixes = [Path(prefix) for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if prefix]
    for prefix in prefixes:
        file = prefix / "share" / package / "msg" / f"{short}.msg"
        if file.is_file():
            return file.read_text(encoding="utf-8")
    raise InvalidInputError(
        f"message type {name}: no share/{package}/msg/{short}.msg in {[str(prefix) for prefix in prefixes]} "
        "(AMENT_PREFIX_PATH); source the workspace that has it"
    )


def _referenced(definition: Any) -> Iterator[str]:
    """Names of message types anywhere inside a parsed definition."""
    if isinstance(definition, str):
        if "/msg/" in definition:
            yield definition
    elif isinstance(definition, tuple | list):
        for part in definition:
            yield from _referenced(part)
