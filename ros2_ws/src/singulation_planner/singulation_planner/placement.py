"""Reachability: where the pusher starts and which candidates it can perform (paper, section III-A)."""

import math
from collections import Counter
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from singulation_core import ContactMode, InvalidInputError, Push, PusherGeometry, ResultCode, SingulationError
from singulation_core.polygon import FloatArray, inward_half_planes, validated_outline
from singulation_planner.candidates import Candidates
from singulation_planner.kernels.carry import carried_over
from singulation_planner.kernels.place import BLOCKED, FEASIBLE, MISSES, OUTSIDE, OVER_EDGE, UNTRIED, place
from singulation_planner.kernels.types import IntArray
from singulation_planner.scene import Scene

_REASONS = {
    MISSES: "pass beside the object",
    BLOCKED: "start where another object is in the way",
    OUTSIDE: "start or end outside the workspace",
    OVER_EDGE: "would carry an object over the edge of the workspace",
}
_UNBOUNDED = (np.empty((0, 2)), np.empty(0))


@dataclass(frozen=True, slots=True)
class Placement:
    """How a start point is chosen and what counts as reachable.

    Attributes:
        start: ``outline``: the pusher starts where it would touch the object, less the clearance; all of the travel
            then moves the object, and in clutter it is free more often. ``bounding_circle``: it starts at the
            object's bounding circle, as the authors' code does.
        clearance: gap to every object at the start [m]; None: a sixth of the tip radius (1.5 mm for the YuMi).
        retreat: how far a blocked start may be moved back on its line [m]. 0, the default, takes the next candidate
            instead: in the project's measurements moving back cost half of the gain.
        retreat_step: in steps of this length [m]; None: the tip radius.
        fits: which pushers must be free at the start: that of the ``contact_mode`` of the push, or those of
            ``every_mode``, which makes the modes comparable on equal pushes (as the paper's Table II counts).
        two_point_ratio: distance of two points in bounding radii of the push object (paper, section VI-B).
        widest_jaw: limit of that distance [m]; the YuMi's jaws open by 50 mm.
    """

    start: Literal["outline", "bounding_circle"] = "outline"
    clearance: float | None = None
    retreat: float = 0.0
    retreat_step: float | None = None
    fits: Literal["contact_mode", "every_mode"] = "contact_mode"
    two_point_ratio: float = 0.6
    widest_jaw: float = 0.05

    def __post_init__(self) -> None:
        if self.start not in ("outline", "bounding_circle"):
            raise InvalidInputError(f"placement: start {self.start!r}, need 'outline' or 'bounding_circle'")
        if self.fits not in ("contact_mode", "every_mode"):
            raise InvalidInputError(f"placement: fits {self.fits!r}, need 'contact_mode' or 'every_mode'")
        if not (0.0 <= self.retreat < math.inf):
            raise InvalidInputError(f"placement: retreat {self.retreat} m, need a finite length >= 0")
        for name in ("clearance", "retreat_step", "two_point_ratio", "widest_jaw"):
            value = getattr(self, name)
            if value is not None and not (0.0 < value < math.inf):
                raise InvalidInputError(f"placement: {name} {value}, need a finite positive number")


@dataclass(frozen=True, slots=True)
class Placer:
    """Places candidates of one scene for one contact mode.

    Attributes:
        scene: the objects.
        mode: how the push is performed.
        travel: from start to end [m].
        pusher: (4,) tip radius, half edge width, edge thickness, clearance [m].
        jaws: (n,) half the distance of two points on each object [m].
        walls: inward half planes of the workspace.
        placement: how starts are chosen.
        geometry: of the jaws.
        rejected: how many candidates were refused for which reason, so far.
    """

    scene: Scene
    mode: ContactMode
    travel: float
    pusher: FloatArray
    jaws: FloatArray
    walls: tuple[FloatArray, FloatArray]
    placement: Placement
    geometry: PusherGeometry
    rejected: Counter[int] = field(default_factory=Counter)

    def first_feasible(self, candidates: Candidates) -> tuple[int, FloatArray] | None:
        """Index and (2,) start point of the first candidate that can be performed."""
        starts, status = self._blank(len(candidates.objects))
        index = self._place(candidates, 0, False, starts, status)
        while index >= 0 and self._over_edge(candidates, index, starts[index]):
            status[index] = OVER_EDGE
            index = self._place(candidates, index + 1, False, starts, status)
        if index >= 0:
            return index, starts[index]
        self.rejected.update(status.tolist())
        return None

    def feasible(self, candidates: Candidates) -> tuple[IntArray, FloatArray]:
        """Indices (k,) and start points (k, 2) of all candidates that can be performed."""
        starts, status = self._blank(len(candidates.objects))
        self._place(candidates, 0, True, starts, status)
        for index in np.flatnonzero(status == FEASIBLE).tolist():
            if self._over_edge(candidates, index, starts[index]):
                status[index] = OVER_EDGE
        self.rejected.update(status[status != FEASIBLE].tolist())
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

    def _blank(self, count: int) -> tuple[FloatArray, IntArray]:
        return np.empty((count, 2)), np.full(count, UNTRIED, dtype=np.int64)

    def _place(self, candidates: Candidates, begin: int, every: bool, starts: FloatArray, status: IntArray) -> int:
        scene, placement = self.scene, self.placement
        step = self.pusher[0] if placement.retreat_step is None else placement.retreat_step
        return int(
            place(
                _modes(self.mode, placement.fits),
                placement.start == "bounding_circle",
                scene.centroids,
                scene.radii,
                scene.vertices,
                scene.firsts,
                candidates.objects,
                candidates.directions,
                candidates.offsets,
                begin,
                every,
                self.jaws,
                self.pusher,
                placement.retreat,
                step,
                self.travel,
                *self.walls,
                starts,
                status,
            )
        )

    def _over_edge(self, candidates: Candidates, index: int, start: FloatArray) -> bool:
        if not len(self.walls[1]):
            return False
        scene, target = self.scene, int(candidates.objects[index])
        tip, half_edge, _, clearance = self.pusher.tolist()
        half_width = half_edge if self.mode is ContactMode.EDGE else tip
        if self.mode is ContactMode.TWO_POINT:
            half_width += float(self.jaws[target])
        return bool(
            carried_over(
                scene.centroids,
                scene.radii,
                *self.walls,
                target,
                *start.tolist(),
                *candidates.directions[index].tolist(),
                half_width,
                self.travel,
                clearance,
            )
        )


_MODES = {
    (mode, fits): np.array([mode, *(other for other in ContactMode if other != mode and fits == "every_mode")])
    for mode in ContactMode
    for fits in ("contact_mode", "every_mode")
}


def _modes(mode: ContactMode, fits: str) -> IntArray:
    return _MODES[mode, fits]


def make_placer(
    scene: Scene,
    mode: ContactMode,
    travel: float,
    geometry: PusherGeometry,
    placement: Placement,
    walls: tuple[FloatArray, FloatArray],
) -> Placer:
    """Placer of a scene for one contact mode."""
    pusher = np.array(
        (geometry.tip_radius, 0.5 * geometry.edge_width, geometry.edge_thickness, clearance_of(placement, geometry))
    )
    jaws = 0.5 * np.minimum(placement.two_point_ratio * scene.radii, placement.widest_jaw)
    return Placer(scene, mode, travel, pusher, jaws, walls, placement, geometry)


def clearance_of(placement: Placement, geometry: PusherGeometry) -> float:
    """Gap between pusher and objects at the start [m]."""
    return geometry.tip_radius / 6.0 if placement.clearance is None else placement.clearance


def workspace_walls(workspace: ArrayLike | None, scene: Scene) -> tuple[FloatArray, FloatArray]:
    """Inward unit normals (k, 2) and offsets (k,) [m] of the workspace.

    Raises:
        InvalidInputError: the polygon is not convex and counter-clockwise.
        SingulationError: ``OUTSIDE_WORKSPACE`` if the centroid of an object lies outside.
    """
    if workspace is None:
        return _UNBOUNDED
    normals, offsets = inward_half_planes(validated_outline(workspace, "workspace"))
    depths = (scene.centroids @ normals.T - offsets).min(axis=1)
    if not (depths.min() >= 0.0):
        worst = int(depths.argmin())
        x, y = scene.centroids[worst]
        raise SingulationError(
            ResultCode.OUTSIDE_WORKSPACE,
            f"object {scene.object_id(worst)} at ({x:.4g}, {y:.4g}) m is {-depths[worst]:.4g} m outside the workspace",
        )
    return np.ascontiguousarray(normals), np.ascontiguousarray(offsets)
