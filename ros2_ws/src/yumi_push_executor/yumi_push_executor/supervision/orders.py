"""What the supervision hands out: orders to controllers, and how a motion ended."""

from dataclasses import dataclass

from singulation_core import ResultCode
from yumi_push_executor.supervision.segment import Phase
from yumi_push_executor.supervision.trajectory import Trajectory


@dataclass(frozen=True, eq=False, slots=True)
class ArmOrder:
    """A trajectory for one arm, to start at once; it replaces what the arm does."""

    arm: str
    trajectory: Trajectory


@dataclass(frozen=True, slots=True)
class JawOrder:
    """A jaw opening [m] for one arm."""

    arm: str
    opening: float


Order = ArmOrder | JawOrder


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a motion ended.

    Args:
        code: one of the result codes.
        text: why.
        standing: whether both arms were seen to stand.
    """

    code: ResultCode
    text: str
    standing: bool


@dataclass(frozen=True, eq=False, slots=True)
class Step:
    """What a step decided: orders to send now, where the motion is, and its outcome once it has ended."""

    orders: tuple[Order, ...]
    phase: Phase
    fraction: float
    outcome: Outcome | None = None
