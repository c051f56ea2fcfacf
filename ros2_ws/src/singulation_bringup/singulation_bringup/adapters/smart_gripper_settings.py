"""Parameters of ``smart_gripper_adapter``."""

from dataclasses import dataclass

from singulation_core import InvalidInputError
from singulation_node.parameters import parameter


@dataclass(frozen=True)
class SmartGripperSettings:
    """How ABB's SmartGrippers are ordered and read through the StateMachine add-in."""

    left_finger_joint: str = parameter(
        "gripper_l_joint", "name under which the left fingers are reported", read_only=True
    )
    right_finger_joint: str = parameter("gripper_r_joint", "likewise the right ones", read_only=True)
    rapid_tasks: tuple[str, ...] = parameter(
        ("T_ROB_L", "T_ROB_R"), "RAPID tasks of the left and the right hand", read_only=True
    )
    left_position_signal: str = parameter(
        "hand_ActualPosition_L", "I/O signal with the position of a left finger", read_only=True
    )
    right_position_signal: str = parameter("hand_ActualPosition_R", "likewise a right one", read_only=True)
    counts_per_metre: float = parameter(
        10000.0, "of the position signals; ABB's module counts tenths of a millimetre", low=1.0, high=1e9
    )
    poll_period: float = parameter(0.1, "time between two questions for the positions [s]", low=0.02, high=1.0)
    answer_timeout: float = parameter(2.0, "longest wait for an answer of the driver [s]", low=0.1, high=30.0)

    def __post_init__(self) -> None:
        if len(self.rapid_tasks) != 2 or len(set(self.rapid_tasks)) != 2:
            raise InvalidInputError(f"parameter rapid_tasks is {self.rapid_tasks}, need the two tasks of the hands")
        if not (self.left_finger_joint and self.right_finger_joint):
            raise InvalidInputError("parameters left_finger_joint, right_finger_joint: one is empty, need two names")
