"""What became of a run of the closed loop so far."""

from dataclasses import dataclass, field

from singulation_core import Arrangement, Push, ResultCode


@dataclass(frozen=True, slots=True)
class Outcome:
    """One push that was tried: exactly one code, the arrangements before and after."""

    push: Push
    code: ResultCode
    message: str
    before: Arrangement
    after: Arrangement
    distance_before: float
    distance_after: float


@dataclass(slots=True)
class Progress:
    """How far it is.

    Args:
        outcomes: of the pushes so far.
        distances, gaps, counts: s(A), smallest gap [m] and number of blocks before the first push and after each one.
        lost: lasting ids of blocks that are no longer seen.
    """

    outcomes: list[Outcome] = field(default_factory=list)
    distances: list[float] = field(default_factory=list)
    gaps: list[float] = field(default_factory=list)
    counts: list[int] = field(default_factory=list)
    lost: set[int] = field(default_factory=set)

    def repeat_last_look(self) -> None:
        """Nothing new was seen."""
        self.distances.append(self.distances[-1])
        self.gaps.append(self.gaps[-1])
        self.counts.append(self.counts[-1])

    def forget_last_look(self) -> None:
        """Another look takes its place."""
        for values in (self.distances, self.gaps, self.counts):
            values.pop()


@dataclass(frozen=True, slots=True)
class SingulationResult:
    """How it ended."""

    code: ResultCode
    message: str
    progress: Progress
