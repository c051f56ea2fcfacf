"""Where the two fingertips of a hand are, from the pose of its tool frame."""

import math
from dataclasses import dataclass

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_core.push_world import Footprint
from yumi_push_executor.kinematics import TIP_OFFSET


@dataclass(frozen=True, slots=True)
class FingerGeometry:
    """Tip of one SmartGripper finger [m], measured on the published mesh; the fingers close along the tool's x axis.

    Args:
        thickness: along the closing direction.
        width: across it.
    """

    thickness: float = 0.0062
    width: float = 0.012

    @property
    def footprint(self) -> Footprint:
        """The tip as a rectangle; its x axis is the closing direction."""
        x, y = self.thickness / 2.0, self.width / 2.0
        return Footprint(polygons=(np.array(((-x, -y), (x, -y), (x, y), (-x, y))),))


@dataclass(frozen=True, slots=True)
class Fingertip:
    """Pose of a fingertip over the table.

    Args:
        pose: x, y [m] and heading of the closing direction [rad] in ``table``.
        height: of the tip above the table [m].
    """

    pose: tuple[float, float, float]
    height: float


def fingertips(tool: FloatArray, opening: float, finger: FingerGeometry) -> tuple[Fingertip, Fingertip]:
    """Both fingertips of a hand.

    Args:
        tool: 4x4 pose of ``tool0`` in ``table``.
        opening: distance between the fingers [m].
        finger: their geometry.
    """
    middle = tool[:3, 3] + TIP_OFFSET * tool[:3, 2]
    closing = tool[:3, 0]
    heading = math.atan2(closing[1], closing[0])
    offset = (opening + finger.thickness) / 2.0 * closing
    first, second = (middle + sign * offset for sign in (-1.0, 1.0))
    return _tip(first, heading), _tip(second, heading)


def _tip(point: FloatArray, heading: float) -> Fingertip:
    x, y, z = point.tolist()
    return Fingertip((x, y, heading), z)
