"""Is a posture clear of everything, and if not, what is in the way?"""

from collections.abc import Mapping
from dataclasses import astuple, dataclass
from enum import Enum
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from yumi_push_executor.clearance.near import NearPairs
from yumi_push_executor.clearance.scene import Margins, Pair, Scene
from yumi_push_executor.clearance.shapes import Kind
from yumi_push_executor.kinematics.model import arm_model, robot

_CHANGING = (Kind.FINGER_BLOCK, Kind.FINGER_TABLE, Kind.MOVED_BLOCKS)  # from stage to stage


class Stage(Enum):
    """What may be touched: it changes along a motion."""

    TRAVEL = "travelling"  # nothing
    LEAVE = "rising from where it stands"  # fingers: any block, they leave it upwards
    DESCEND = "going down"  # nothing, but fingers may come near blocks
    PUSH = "pushing"  # fingers: the pushed blocks
    CLEAR = "leaving the view"  # nothing, and blocks may be wherever the push can have carried them


@dataclass(frozen=True)
class Contact:
    """What comes too near to what: names of the two shapes, their distance and what it should be [m]."""

    first: str
    second: str
    distance: float
    margin: float

    def __str__(self) -> str:
        return f"{self.first} and {self.second} {self.distance * 1e3:.1f} mm apart, need {self.margin * 1e3:.1f} mm"


class Checker:
    """Clearance of one moving arm in a scene that stands still.

    Args:
        scene: everything around it.
        postures: of both arms, (7,) angles [rad].
        opening: distance between the jaws of the moving arm [m].
        margins: smallest allowed distances.
    """

    def __init__(self, scene: Scene, postures: Mapping[str, FloatArray], opening: float, margins: Margins) -> None:
        self._scene, self._margins = scene, margins
        self._model, self._data = robot(), robot().createData()
        self._positions = list(arm_model(scene.arm).positions)
        self._q = np.zeros(self._model.nq)
        for name, angles in postures.items():
            self._q[list(arm_model(name).positions)] = angles
        self._q[list(arm_model(scene.arm).fingers)] = 0.5 * opening
        self._geometry_data = pin.GeometryData(scene.geometry)
        sizes = margins.by_kind()
        for request, pair in zip(self._geometry_data.collisionRequests, scene.pairs, strict=True):
            request.security_margin = sizes[pair.kind]
        self._near = NearPairs(scene, self._data, self._geometry_data, self._q, max(astuple(margins)))
        self._changing = [(k, pair) for k, pair in enumerate(scene.pairs) if pair.kind in _CHANGING]
        self._stage: Stage | None = None
        self._counted = np.ones(len(scene.pairs), dtype=bool)  # in this stage
        self._active = np.ones(len(scene.pairs), dtype=bool)  # in Pinocchio's data
        self.checked = 0  # postures so far

    def first_contact(self, postures: FloatArray, stage: Stage) -> tuple[int, Contact] | None:
        """Index of the first of (n, 7) postures that is not clear, and what is in its way; None if all are."""
        self._enter(stage)
        data = self._activate(self._near.along(postures))
        for index, posture in enumerate(postures):
            self._q[self._positions] = posture
            self.checked += 1
            if pin.computeCollisions(self._model, self._data, self._scene.geometry, data, self._q, True):
                return index, self._contact(data, self._first_pair())
        return None

    def smallest_slack(self, posture: FloatArray, stage: Stage) -> tuple[float, Contact]:
        """Distance minus margin of the pair that is nearest to being in the way [m], and that pair."""
        self._enter(stage)
        data = self._activate(np.ones(len(self._counted), dtype=bool))
        self._q[self._positions] = posture
        pin.computeDistances(self._model, self._data, self._scene.geometry, data, self._q)
        slack = np.array([one.min_distance for one in data.distanceResults])
        slack -= [one.security_margin for one in data.collisionRequests]
        slack[~self._active] = np.inf
        worst = int(slack.argmin())
        return float(slack[worst]), self._contact(data, worst)

    def _first_pair(self) -> int:
        """The pair found by the check just made; those switched off may still carry the result of another stage."""
        data = self._geometry_data
        return next(int(k) for k in np.flatnonzero(self._active) if data.collisionResults[int(k)].isCollision())

    def _enter(self, stage: Stage) -> None:
        """Margins and exceptions of a stage."""
        if stage is self._stage:
            return
        margins, requests = self._margins_in(stage), self._geometry_data.collisionRequests
        for k, pair in self._changing:
            requests[k].security_margin = margins[pair.kind]
            self._counted[k] = self._counts(pair, stage)
        self._stage = stage

    def _activate(self, near: NDArray[np.bool_]) -> Any:
        """Pinocchio's working data with only those pairs switched on that count in this stage and are near."""
        data, wanted = self._geometry_data, self._counted & near
        for k in np.flatnonzero(wanted != self._active):
            (data.activateCollisionPair if wanted[k] else data.deactivateCollisionPair)(int(k))
        self._active = wanted
        return data

    def _margins_in(self, stage: Stage) -> dict[Kind, float]:
        margins = self._margins.by_kind()
        if stage in (Stage.DESCEND, Stage.PUSH):
            margins[Kind.FINGER_BLOCK] = self._margins.descent
        if stage in (Stage.DESCEND, Stage.PUSH, Stage.LEAVE):
            margins[Kind.FINGER_TABLE] = self._margins.finger_table
        return margins

    def _counts(self, pair: Pair, stage: Stage) -> bool:
        if pair.kind is Kind.MOVED_BLOCKS:
            return stage is Stage.CLEAR
        if pair.kind is Kind.FINGER_BLOCK:
            return stage is not Stage.LEAVE and not (stage is Stage.PUSH and pair.block in self._scene.touched)
        return True  # fingers and table

    def _contact(self, data: Any, pair: int) -> Contact:
        geometry = self._scene.geometry
        pin.computeDistance(geometry, data, pair)
        first, second = (_spoken(geometry.geometryObjects[one].name) for one in self._scene.pairs[pair].shapes)
        distance = float(data.distanceResults[pair].min_distance)
        return Contact(first, second, distance, float(data.collisionRequests[pair].security_margin))


def _spoken(name: str) -> str:
    """Shape name without the number of the primitive."""
    return name if " " in name or "_" not in name else name.rsplit("_", 1)[0].replace("_", " ")
