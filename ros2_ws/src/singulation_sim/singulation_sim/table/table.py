"""Blocks on a table and the fingertips that come down between them, push them, or land on them."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from singulation_core import Arrangement
from singulation_core.polygon import separation
from singulation_core.push_world import PushPhysics, PushWorld
from singulation_sim.table.jaws import FingerGeometry, Fingertip

_SMALL_MOVE = 5e-4  # m; fingertips that moved less since the last step of the physics wait for more
_SMALL_TURN = 5e-3  # rad
_TOUCHING = 1e-4  # m; overlap that still counts as touching
_INTO_TABLE = -1e-3  # m; a tip below this has hit the table
_DEEPER = 1e-3  # m; a contact is reported again when the tip has gone this much further down


@dataclass(frozen=True, slots=True)
class Contact:
    """A fingertip met something that does not give way; ``finger`` is its name."""

    finger: str
    text: str


class Table:
    """Blocks, pushed by fingertips.

    A fingertip acts on blocks while it is lower than the tallest of them. It has to come down beside them: coming down
    on a block, or on the table, is a contact that stops a real robot, and is returned as such.

    Known limit: a fingertip that came down beside the blocks pushes those too that are lower than its tip.

    Args:
        arrangement: blocks in ``table``, with their heights.
        physics: of pushing.
        finger: geometry of the fingertips.
    """

    def __init__(
        self, arrangement: Arrangement, physics: PushPhysics | None = None, finger: FingerGeometry | None = None
    ) -> None:
        self.finger = finger or FingerGeometry()
        self._footprint = self.finger.footprint
        self._outline = self._footprint.polygons[0]
        self._world = PushWorld(arrangement, physics)
        self._heights = {item.id: item.height for item in arrangement.objects}
        self._tallest = max(self._heights.values(), default=0.0)
        self._placed: dict[str, tuple[float, float, float]] = {}
        self._reported: dict[str, float] = {}  # height of the tip at its last contact [m]

    def arrangement(self, stamp: float) -> Arrangement:
        """Where the blocks are, stamped [s]."""
        return self._world.arrangement(stamp)

    def move(self, tips: Mapping[str, Fingertip], settle: bool = False) -> Sequence[Contact]:
        """Move fingertips, given by name; those that are not given stay where they are.

        Args:
            tips: where they are now.
            settle: also carry out moves that are too small to matter yet.

        Returns:
            What fingertips ran into; a contact that stays is not repeated unless the tip goes deeper.
        """
        contacts = []
        for name, tip in tips.items():
            text = self._meet(name, tip)
            if not text:
                self._reported.pop(name, None)
            elif tip.height < self._reported.get(name, math.inf) - _DEEPER:
                self._reported[name] = tip.height
                contacts.append(Contact(name, text))
        self._push({name: tip.pose for name, tip in tips.items() if name in self._placed}, settle)
        return contacts

    def squeezed(self, name: str) -> Sequence[int]:
        """Ids of blocks that a lowered fingertip presses into, because they cannot give way."""
        return self._below(self._placed[name]) if name in self._placed else []

    def _meet(self, name: str, tip: Fingertip) -> str:
        """Put a fingertip down or lift it, as its height says; what it ran into, empty if nothing."""
        if tip.height < _INTO_TABLE:
            return f"{name} is {-tip.height * 1e3:.1f} mm below the table surface"
        if tip.height >= self._tallest:
            self._lift(name)
        elif name not in self._placed:
            return self._lower(name, tip)
        return ""

    def _lower(self, name: str, tip: Fingertip) -> str:
        below = self._below(tip.pose)
        hit = [item for item in below if self._heights[item] > tip.height]
        if hit:
            x, y, _ = tip.pose
            return f"{name} came down on block(s) {hit} at x {x:.4f} m, y {y:.4f} m of the table"
        if not below:
            self._world.place(name, self._footprint, tip.pose)
            self._placed[name] = tip.pose
        return ""

    def _below(self, pose: tuple[float, float, float]) -> Sequence[int]:
        """Ids of blocks that a fingertip at this pose overlaps."""
        x, y, heading = pose
        cosine, sine = math.cos(heading), math.sin(heading)
        outline = self._outline @ np.array(((cosine, sine), (-sine, cosine))) + (x, y)
        blocks = self._world.arrangement().objects
        return [item.id for item in blocks if separation(outline, item.outline) < -_TOUCHING]

    def _lift(self, name: str) -> None:
        if self._placed.pop(name, None) is not None:
            self._world.lift(name)

    def _push(self, poses: Mapping[str, tuple[float, float, float]], settle: bool) -> None:
        changes = [np.abs(np.subtract(pose, self._placed[name])) for name, pose in poses.items()]
        moved = max((float(change[:2].max()) for change in changes), default=0.0)
        turned = max((float(change[2]) for change in changes), default=0.0)
        if moved >= _SMALL_MOVE or turned >= _SMALL_TURN or (settle and (moved > 0.0 or turned > 0.0)):
            self._world.move(poses)
            self._placed.update(poses)
