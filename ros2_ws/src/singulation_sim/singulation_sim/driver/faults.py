"""Faults that can be injected, by name, and which of them are present."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from singulation_core import InvalidInputError
from singulation_sim.driver.mode import DriverMode


@dataclass(frozen=True, slots=True)
class Fault:
    """What a fault does.

    Args:
        text: what happens, and what ``value`` means.
        stop: mode the controller goes to, None if the fault is not a stop.
        default: used where the value is 0.
    """

    text: str
    stop: DriverMode | None = None
    default: float = 0.0


_SECONDS = "; value: seconds it lasts, 0 until reset"
_PRESSED = "; value: seconds until it is released (motors stay off until reset), 0 until reset"
_HAND = "; value: 0 both hands, 1 left, 2 right"

FAULTS: Mapping[str, Fault] = MappingProxyType(
    {
        "emergency_stop": Fault("an emergency stop is pressed" + _PRESSED, DriverMode.EMERGENCY_STOP),
        "guard_stop": Fault("the guard circuit opens" + _PRESSED, DriverMode.GUARD_STOP),
        "motors_off": Fault("the motors are switched off" + _PRESSED, DriverMode.MOTORS_OFF),
        "system_failure": Fault("the controller fails" + _PRESSED, DriverMode.SYSTEM_FAILURE),
        "collision": Fault(
            "motion supervision trips: stop, short way back along the path; value: seconds until the controller's "
            "error handler takes motion again, 0 the parameter collision_handler_time, negative not before reset",
            DriverMode.COLLISION_STOP,
        ),
        "egm_timeout": Fault(
            "the link to the controller drops: arms keep their velocity, states repeat, then the session ends; "
            "value: seconds until then, 0 the parameter egm_timeout"
        ),
        "freeze_states": Fault("joint states repeat, with new stamps" + _SECONDS),
        "drop_states": Fault("no joint states" + _SECONDS),
        "nan_states": Fault("joint states are NaN" + _SECONDS),
        "zero_states": Fault("joint states are all zero" + _SECONDS),
        "slow": Fault("joints move slower than commanded, until reset; value: their speed in rad/s", default=0.02),
        "drop_commands": Fault("arm commands get lost" + _SECONDS),
        "delay_commands": Fault("arm commands come late, until reset; value: by how many seconds", default=0.2),
        "gripper_uncalibrated": Fault("a hand loses its calibration, until reset" + _HAND),
        "gripper_stuck": Fault("a hand does not move, until reset" + _HAND),
    }
)


class FaultBoard:
    """Which faults that are not stops are present, and with which value."""

    def __init__(self) -> None:
        self._values: dict[str, float] = {}
        self._ends: dict[str, float] = {}

    def set(self, name: str, value: float, now: float) -> None:
        """Make a fault present from ``now`` [s] on."""
        self._values[name] = value or FAULTS[name].default
        lasts = value if FAULTS[name].text.endswith(_SECONDS) and value > 0.0 else float("inf")
        self._ends[name] = now + lasts

    def value(self, name: str, now: float) -> float | None:
        """Value of a fault, None if it is not present."""
        return self._values[name] if now < self._ends.get(name, now) else None

    def present(self, name: str, now: float) -> bool:
        """Whether a fault is present."""
        return self.value(name, now) is not None

    def clear(self) -> None:
        """Remove all faults."""
        self._values.clear()
        self._ends.clear()


def known_fault(name: str) -> Fault:
    """The fault of this name.

    Raises:
        InvalidInputError: listing the names there are.
    """
    if name not in FAULTS:
        raise InvalidInputError(f"unknown fault {name!r}; one of: {', '.join(FAULTS)}")
    return FAULTS[name]
