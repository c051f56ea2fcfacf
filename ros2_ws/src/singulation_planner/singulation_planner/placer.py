"""Reachability: where the pusher starts and which candidates it can perform (paper, section III-A)."""

import math
from collections import defaultdict
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from singulation_core import ContactMode, Push, PusherGeometry
from singulation_core.polygon import FloatArray
from singulation_planner.candidates import Candidates
from singulation_planner.kernels.carry import mark_carried_over
from singulation_planner.kernels.place import BLOCKED, FEASIBLE, MISSES, OUTSIDE, OVER_EDGE, UNTRIED, place
from singulation_planner.kernels.types import IntArray
from singulation_planner.placement import Placement, clearance_of
from singulation_planner.scene import Scene
from singulation_planner.workspace import Walls

NOT_SIMULATED = 6  # beside the codes of the kernel
_REASONS = {
    MISSES: "pass beside the object",
    BLOCKED: "start where another object is in the way",
    OUTSIDE: "start or end outside the workspace",
    NOT_SIMULATED: "could not be simulated",
    OVER_EDGE: "would carry an object over the edge of the workspace",
}
_MODES = {
    (mode, fits): np.array([mode, *(other for other in ContactMode if other != mode and fits == "every_mode")])
    for mode in ContactMode
    for fits in ("contact_mode", "every_mode")
}


@dataclass(frozen=True, slots=True)
class Placer:
    """Places candidates of one scene for one contact mode.

    Attributes:
        scene: the objects.
        mode: how the push is performed.
        ways: (3,) travel from start to end, how far a blocked start may be moved back, and in which steps [m].
        pusher: (4,) tip radius, half edge width, edge thickness, clearance [m].
        jaws: (n,) half the distance of two points on each object [m].
        walls: inward half planes of the workspace.
        placement: how starts are chosen.
        geometry: of the jaws.
        rejected: how many candidates were refused for which reason, so far.
    """

    scene: Scene
    mode: ContactMode
    ways: FloatArray
    pusher: FloatArray
    jaws: FloatArray
    walls: Walls
    placement: Placement
    geometry: PusherGeometry
    rejected: defaultdict[int, int] = field(default_factory=partial(defaultdict, int))

    @property
    def travel(self) -> float:
        """From start to end [m]."""
        return float(self.ways[0])

    def first_feasible(self, candidates: Candidates) -> tuple[int, FloatArray] | None:
        """Index and (2,) start point of the first candidate that can be performed."""
        starts, status = self._blank(len(candidates.objects))
        index = self._place(candidates, 0, False, starts, status)
        while index >= 0:
            self._mark_over_edge(candidates, starts, status)
            if status[index] == FEASIBLE:
                break
            index = self._place(candidates, index + 1, False, starts, status)
        if index >= 0:
            return index, starts[index]
        self._count(status)
        return None

    def feasible(self, candidates: Candidates) -> tuple[IntArray, FloatArray]:
        """Indices (k,) and start points (k, 2) of all candidates that can be performed."""
        starts, status = self._blank(len(candidates.objects))
        self._place(candidates, 0, True, starts, status)
        self._mark_over_edge(candidates, starts, status)
        self._count(status[status != FEASIBLE])
        chosen = np.flatnonzero(status == FEASIBLE)
        return chosen, starts[chosen]

    def push(
        self, target: int, start: FloatArray, direction: FloatArray, policy: str = "", gain: float = math.nan
    ) -> Push:
        """The push of object ``target`` of the scene from ``start`` (2,) [m] along a unit vector."""
        return Push(
            start,
            start + self.travel * direction,
            self.mode,
            self.contact_width(target),
            self.scene.object_id(target),
            policy,
            gain,
        )

    def contact_width(self, index: int) -> float:
        """Edge length or distance of the two points on object ``index`` [m]; 0 for a single point."""
        if self.mode is ContactMode.EDGE:
            return self.geometry.edge_width
        return 2.0 * float(self.jaws[index]) if self.mode is ContactMode.TWO_POINT else 0.0

    def why_none(self) -> str:
        """How many candidates were refused for which reason."""
        parts = [f"{self.rejected[code]} {text}" for code, text in _REASONS.items() if self.rejected[code]]
        return f"of {sum(self.rejected.values())} candidate pushes " + ", ".join(parts)

    def _count(self, refused: IntArray) -> None:
        for code, count in enumerate(np.bincount(refused).tolist()):
            self.rejected[code] += count

    def _blank(self, count: int) -> tuple[FloatArray, IntArray]:
        status = np.empty(count, dtype=np.int64)
        status.fill(UNTRIED)
        return np.empty((count, 2)), status

    def _place(self, candidates: Candidates, begin: int, every: bool, starts: FloatArray, status: IntArray) -> int:
        scene, placement = self.scene, self.placement
        return int(
            place(
                _MODES[self.mode, placement.fits],
                placement.start == "bounding_circle",
                (scene.centroids, scene.radii, scene.vertices, scene.firsts),
                candidates.objects,
                candidates.directions,
                candidates.offsets,
                begin,
                every,
                self.jaws,
                self.pusher,
                self.ways,
                self.walls,
                starts,
                status,
            )
        )

    def _mark_over_edge(self, candidates: Candidates, starts: FloatArray, status: IntArray) -> None:
        if not len(self.walls[1]):
            return
        tip, half_edge, _, clearance = self.pusher.tolist()
        half_widths = np.full(len(self.scene), half_edge if self.mode is ContactMode.EDGE else tip)
        if self.mode is ContactMode.TWO_POINT:
            half_widths += self.jaws
        mark_carried_over(
            self.scene.centroids,
            self.scene.radii,
            *self.walls,
            candidates.objects,
            starts,
            candidates.directions,
            half_widths,
            self.travel,
            clearance,
            status,
            FEASIBLE,
            OVER_EDGE,
        )


def make_placer(
    scene: Scene,
    mode: ContactMode,
    travel: float,
    geometry: PusherGeometry,
    placement: Placement,
    walls: Walls,
) -> Placer:
    """Placer of a scene for one contact mode."""
    pusher = np.array(
        (geometry.tip_radius, 0.5 * geometry.edge_width, geometry.edge_thickness, clearance_of(placement, geometry))
    )
    jaws = 0.5 * np.minimum(placement.two_point_ratio * scene.radii, placement.widest_jaw)
    step = geometry.tip_radius if placement.retreat_step is None else placement.retreat_step
    ways = np.array((travel, placement.retreat, step))
    return Placer(scene, mode, ways, pusher, jaws, walls, placement, geometry)
