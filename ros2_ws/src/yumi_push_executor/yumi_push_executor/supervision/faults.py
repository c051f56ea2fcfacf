"""What can end a motion, and how the arm is brought to rest for each."""

from dataclasses import dataclass
from enum import Enum

from singulation_core import ResultCode


class Stop(Enum):
    """Where the arm is held."""

    ALONG_PATH = "along the commanded path"  # when the measured position is not known, or nothing is wrong with the arm
    MEASURED = "at the measured position"  # when the command is not where the arm is


@dataclass(frozen=True, slots=True)
class Fault:
    """A reason to end the motion.

    Args:
        code: of the outcome.
        text: what, the value and what would have been right.
        stop: where to hold.
        lift: whether a retreat upwards may follow, if the driver allows.
        frozen: whether the measured states are not to be believed: only when they change standstill can be seen.
        quiet: how long the arm must have stood before it counts as standing [s]; long where an order may yet arrive.
        both_arms: whether the arm that was not to move is held, too.
    """

    code: ResultCode
    text: str
    stop: Stop = Stop.MEASURED
    lift: bool = False
    frozen: bool = False
    quiet: float = 0.0
    both_arms: bool = False
