"""Options of the policy ``rollout_push``."""

from dataclasses import dataclass, field
from typing import Literal

from singulation_core import InvalidInputError

WIDTH = 0.4  # default of ``clearance_width`` in mean bounding radii
SHIFT = 0.05  # standard deviation of a block's position in sampled worlds [mean bounding radii]


@dataclass(frozen=True, slots=True)
class Options:
    """What is wanted, and how much work may be spent on it.

    Attributes:
        objective: ``singulation_distance``: the largest s' (the paper's aim); ``clearance``: blocks with a gap of
            ``clearance_width`` all around, which is what a gripper needs.
        budget: processor time for planning [ms]; 0: no simulation, the answer is that of the score. Otherwise at least
            one push is simulated. Where the budget ends the search, the answer depends on the speed of the machine.
        rollouts: simulated pushes at most, second looks at the best ones not counted. Unlike the budget, it gives the
            same push on every machine.
        clearance_width: gap that is wide enough [m]; 0: 0.4 mean bounding radii.
        worlds: in how many sampled worlds (poses, friction, density) the best pushes are judged; 1: in the one seen.
            With more of them starts also keep the blocks' uncertainty free around the jaws, where there is room.
        look_ahead: how many pushes ahead the best ones are judged by what can be reached; 1: greedy.
    """

    objective: Literal["singulation_distance", "clearance"] = "singulation_distance"
    budget: float = field(default=1000.0, metadata={"low": 0.0})
    rollouts: int = 160
    clearance_width: float = field(default=0.0, metadata={"low": 0.0})
    worlds: int = 1
    look_ahead: int = 1

    def __post_init__(self) -> None:
        for name in ("budget", "clearance_width"):
            value = getattr(self, name)
            if not (0.0 <= value < float("inf")):
                raise InvalidInputError(f"rollout_push: {name} {value}, need a finite number >= 0")
        if self.worlds > 1 and self.look_ahead > 1:
            raise InvalidInputError(
                f"rollout_push: worlds {self.worlds} with look_ahead {self.look_ahead}, need 1 for one of them"
            )

    @property
    def start_room(self) -> float:
        """Gap to all blocks that starts should have [mean bounding radii]: jaws cannot come down on a block."""
        return SHIFT if self.worlds > 1 else 0.0
