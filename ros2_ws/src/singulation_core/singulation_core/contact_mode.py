"""The three ways a gripper touches the object it pushes (paper, section III-B)."""

from enum import IntEnum

from singulation_core.errors import SingulationError
from singulation_core.result_code import ResultCode


class ContactMode(IntEnum):
    """Values are those of ``singulation_msgs/msg/ContactMode``."""

    SINGLE_POINT = 0
    EDGE = 1
    TWO_POINT = 2

    @property
    def label(self) -> str:
        """Lower-case name as used on command lines: ``single_point``, ``edge``, ``two_point``."""
        return self.name.lower()


def contact_mode(value: "ContactMode | int | str") -> ContactMode:
    """Contact mode from its number or name.

    Args:
        value: 0, 1, 2, or a label in any case.

    Raises:
        SingulationError: ``UNKNOWN_CONTACT_MODE``, listing the valid ones.
    """
    try:
        return ContactMode[value.upper()] if isinstance(value, str) else ContactMode(value)
    except (KeyError, ValueError):
        valid = ", ".join(f"{mode.label} ({mode.value})" for mode in ContactMode)
        raise SingulationError(
            ResultCode.UNKNOWN_CONTACT_MODE, f"unknown contact mode {value!r}; one of: {valid}"
        ) from None
