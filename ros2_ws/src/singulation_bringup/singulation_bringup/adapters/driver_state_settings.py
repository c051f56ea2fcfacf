"""Parameters of ``driver_state_adapter``."""

from dataclasses import dataclass

from singulation_core import InvalidInputError
from singulation_node.parameters import parameter

SIGNALS, ASSUMED = "signals", "assumed"


@dataclass(frozen=True)
class DriverStateSettings:
    """How the state of an ABB controller is read."""

    require_egm: bool = parameter(
        True,
        "motion counts as taken only while the StateMachine add-in says that both arms run EGM; false where the add-in "
        "is not installed",
        read_only=True,
    )
    rapid_tasks: tuple[str, ...] = parameter(("T_ROB_L", "T_ROB_R"), "RAPID tasks of the two arms", read_only=True)
    runtime_age: float = parameter(1.0, "what was said of EGM is forgotten after this time [s]", low=0.1, high=10.0)
    grippers: str = parameter(
        SIGNALS,
        "whether the hands are calibrated: ask their I/O signals, or assumed: say that they are",
        choices=(SIGNALS, ASSUMED),
        read_only=True,
    )
    left_gripper_signal: str = parameter(
        "hand_StatusCalibrated_L", "I/O signal that is 1 once the left hand is calibrated", read_only=True
    )
    right_gripper_signal: str = parameter(
        "hand_StatusCalibrated_R", "I/O signal that is 1 once the right hand is calibrated", read_only=True
    )
    gripper_period: float = parameter(1.0, "time between two questions for a signal [s]", low=0.1, high=60.0)

    def __post_init__(self) -> None:
        if len(self.rapid_tasks) != 2 or len(set(self.rapid_tasks)) != 2:
            raise InvalidInputError(f"parameter rapid_tasks is {self.rapid_tasks}, need the two tasks of the arms")
