"""An animation of a run from what was heard: the true blocks and the jaws where the arms really were."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from singulation_bringup.drawing import colour_of
from singulation_core import Arrangement, CellGeometry, conversions
from singulation_core.polygon import FloatArray
from singulation_core.transforms import inverse
from yumi_push_executor import YumiArm

_PERIOD = 0.1  # s of simulated time between two pictures
_SHOWN = 12.0  # pictures a second
_MOST = 360  # pictures; a longer run is thinned
_SCALE = 1300.0  # pixels for a metre
_BORDER = 0.03  # m around the workspace
_TIP = 0.136  # m from tool0 to the fingertips
_NEAR = 0.06  # m above the table up to which a tip is drawn

_PAPER, _LINE, _INK, _BLOCKS, _COLOURS = 0, 1, 2, 3, 10  # places in the palette
_PALETTE = [250, 250, 250, 190, 190, 190, 25, 25, 25] + [
    round(255 * part) for identity in range(_COLOURS) for part in colour_of(identity)
]


@dataclass(frozen=True, slots=True)
class _Moment:
    time: float
    blocks: Arrangement
    tips: tuple[FloatArray, ...]  # x, y, z in table [m]


class Film:
    """Collects what is heard, at most one picture in ``_PERIOD``.

    Args:
        cell: where table and robot stand.
    """

    def __init__(self, cell: CellGeometry) -> None:
        self._cell = cell
        self._table_from_body = inverse(cell.body_from_table)
        self._arms = {"l": YumiArm("left"), "r": YumiArm("right")}
        self._tips: tuple[FloatArray, ...] = ()
        self._moments: list[_Moment] = []
        self._arms_seen = -1.0
        self._names: dict[int, int] = {}

    def see_arms(self, message: Any) -> None:
        """A joint_states message: remember where the fingertips are."""
        now = conversions.seconds_of(message.header.stamp)
        if not (now >= self._arms_seen + 0.5 * _PERIOD):
            return
        self._arms_seen = now
        angles = dict(zip(message.name, message.position, strict=True))
        tips = []
        for side, arm in self._arms.items():
            joints = [angles.get(f"yumi_rob{side}_joint_{number}") for number in range(1, 8)]
            if None not in joints:
                tool = self._table_from_body @ arm.forward(np.array(joints, dtype=np.float64))
                tips.append(np.asarray((tool @ np.array((0.0, 0.0, _TIP, 1.0)))[:3]))
        self._tips = tuple(tips)

    def see_table(self, message: Any) -> None:
        """A true_objects message: one picture, if the last is old enough."""
        now = conversions.seconds_of(message.header.stamp)
        if not self._moments or now >= self._moments[-1].time + _PERIOD:
            self._moments.append(_Moment(now, conversions.arrangement_from_msg(message), self._tips))

    def name_blocks(self, seen: Arrangement) -> None:
        """Give the true blocks the ids, and so the colours, that the loop has seen them under before anything moved."""
        for item in self._moments[0].blocks.objects if self._moments and len(seen) else ():
            distances = np.hypot(*(seen.centroids - item.centroid).T)
            self._names[item.id] = seen.objects[int(distances.argmin())].id

    def save(self, path: Path) -> bool:
        """Write a GIF; False if nothing was seen."""
        moments = self._moments[:: 1 + len(self._moments) // _MOST]
        if not moments:
            return False
        pictures = [self._draw(moment) for moment in moments]
        pictures[0].save(path, save_all=True, append_images=pictures[1:], duration=round(1000 / _SHOWN), loop=0)
        return True

    def _draw(self, moment: _Moment) -> Image.Image:
        """A picture of few colours, drawn as numbers into a palette: GIF needs no search for colours then."""
        x_min, x_max, y_min, y_max = self._cell.workspace
        height = round((x_max - x_min + 2 * _BORDER) * _SCALE)
        width = round((y_max - y_min + 2 * _BORDER) * _SCALE)
        picture = np.full((height, width), _PAPER, dtype=np.uint8)
        cv2.polylines(picture, [self._pixels(self._cell.workspace_polygon)], True, _LINE)
        for item in moment.blocks.objects:
            outline = self._pixels(item.outline)
            cv2.fillPoly(picture, [outline], _BLOCKS + self._names.get(item.id, item.id) % _COLOURS)
            cv2.polylines(picture, [outline], True, _INK)
        for tip in moment.tips:
            if tip[2] <= _NEAR:
                centre = tuple(int(value) for value in self._pixels(tip[None, :2])[0])
                cv2.circle(picture, centre, round(0.006 * _SCALE), _INK, -1)
        elapsed = moment.time - self._moments[0].time
        cv2.putText(picture, f"{elapsed:.1f} s", (8, height - 10), cv2.FONT_HERSHEY_SIMPLEX, 0.5, _INK)
        image = Image.fromarray(picture, mode="P")
        image.putpalette(_PALETTE)
        return image

    def _pixels(self, points: FloatArray) -> NDArray[np.int32]:
        """Table x, y -> column, row: the robot stands below the picture, y runs to the left."""
        _, x_max, _, y_max = self._cell.workspace
        columns = (y_max + _BORDER - points[:, 1]) * _SCALE
        rows = (x_max + _BORDER - points[:, 0]) * _SCALE
        return np.column_stack((columns, rows)).round().astype(np.int32)
