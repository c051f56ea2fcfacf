"""A planned motion: what the executor runs and reports."""

from dataclasses import dataclass

from singulation_core import Push
from singulation_core.polygon import FloatArray
from yumi_push_executor.supervision.segment import Phase, Segment


@dataclass(frozen=True, eq=False)
class Motion:
    """One push as a sequence of segments of one arm.

    Args:
        push: what it performs, in ``table``.
        arm: ``left`` or ``right``.
        segments: gripper, approach, descend, push, retreat, clear view; in this order. If the jaws stand low over the
            table, an approach that lifts them comes first.
        opening: distance between the jaws [m].
        heading: of the jaws' closing direction in ``table`` [rad].
        branch: number of the posture it was solved from.
        limit_margin: smallest distance of any joint to its limits on the straight parts [rad].
        candidates: how many ways to do it there were, and how many were tried.
    """

    push: Push
    arm: str
    segments: tuple[Segment, ...]
    opening: float
    heading: float
    branch: int
    limit_margin: float
    candidates: tuple[int, int]

    @property
    def duration(self) -> float:
        """Of all trajectories together, without the gripper's time [s]."""
        return sum(one.trajectory.duration for one in self.segments if one.trajectory is not None)

    @property
    def start(self) -> FloatArray:
        """(7,) angles of the arm where the motion begins [rad]."""
        return next(one.trajectory.start for one in self.segments if one.trajectory is not None)

    def segment(self, phase: Phase) -> Segment:
        """The segment of a phase."""
        return next(one for one in self.segments if one.phase is phase)
