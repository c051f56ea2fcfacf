"""Is a posture clear of everything, and if not, what is in the way?"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import Any

import numpy as np
import pinocchio as pin

from singulation_core.polygon import FloatArray
from yumi_push_executor.clearance.scene import Margins, Pair, Scene
from yumi_push_executor.clearance.shapes import Kind
from yumi_push_executor.kinematics.model import arm_model, robot


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
        self._stages: dict[Stage, Any] = {}
        self.checked = 0  # postures so far

    def first_contact(self, postures: FloatArray, stage: Stage) -> tuple[int, Contact] | None:
        """Index of the first of (n, 7) postures that is not clear, and what is in its way; None if all are."""
        data = self._stage(stage)
        for index, posture in enumerate(postures):
            self._q[self._positions] = posture
            self.checked += 1
            if pin.computeCollisions(self._model, self._data, self._scene.geometry, data, self._q, True):
                pair = next(k for k, one in enumerate(data.collisionResults) if one.isCollision())
                return index, self._contact(data, pair)
        return None

    def smallest_slack(self, posture: FloatArray, stage: Stage) -> tuple[float, Contact]:
        """Distance minus margin of the pair that is nearest to being in the way [m], and that pair."""
        data = self._stage(stage)
        self._q[self._positions] = posture
        pin.computeDistances(self._model, self._data, self._scene.geometry, data, self._q)
        slack = np.array([one.min_distance for one in data.distanceResults])
        slack -= [one.security_margin for one in data.collisionRequests]
        slack[~np.array(data.activeCollisionPairs)] = np.inf
        worst = int(slack.argmin())
        return float(slack[worst]), self._contact(data, worst)

    @cached_property
    def _sizes(self) -> dict[Kind, float]:
        return self._margins.by_kind()

    def _stage(self, stage: Stage) -> Any:
        """Pinocchio's working data with the margins and exceptions of a stage."""
        if stage not in self._stages:
            data = pin.GeometryData(self._scene.geometry)
            for k, pair in enumerate(self._scene.pairs):
                if not self._counts(pair, stage):
                    data.deactivateCollisionPair(k)
                data.collisionRequests[k].security_margin = self._margin(pair, stage)
            self._stages[stage] = data
        return self._stages[stage]

    def _margin(self, pair: Pair, stage: Stage) -> float:
        if pair.kind is Kind.FINGER_BLOCK and stage in (Stage.DESCEND, Stage.PUSH):
            return self._margins.descent
        if pair.kind is Kind.FINGER_TABLE and stage in (Stage.DESCEND, Stage.PUSH, Stage.LEAVE):
            return self._margins.finger_table
        return self._sizes[pair.kind]

    def _counts(self, pair: Pair, stage: Stage) -> bool:
        if pair.kind is Kind.MOVED_BLOCKS:
            return stage is Stage.CLEAR
        if pair.kind is Kind.FINGER_BLOCK:
            return stage is not Stage.LEAVE and not (stage is Stage.PUSH and pair.block in self._scene.touched)
        return True

    def _contact(self, data: Any, pair: int) -> Contact:
        geometry = self._scene.geometry
        pin.computeDistance(geometry, data, pair)
        first, second = (_spoken(geometry.geometryObjects[one].name) for one in self._scene.pairs[pair].shapes)
        distance = float(data.distanceResults[pair].min_distance)
        return Contact(first, second, distance, float(data.collisionRequests[pair].security_margin))


def _spoken(name: str) -> str:
    """Shape name without the number of the primitive."""
    return name if " " in name or "_" not in name else name.rsplit("_", 1)[0].replace("_", " ")
