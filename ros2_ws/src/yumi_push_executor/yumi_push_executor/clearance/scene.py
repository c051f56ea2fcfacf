"""Everything that stands around one moving arm: body, other arm, table, blocks."""

from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import Any

import coal
import pinocchio as pin

from singulation_core import Arrangement, CellGeometry, InvalidInputError
from singulation_core.polygon import FloatArray, convex_hull
from yumi_push_executor.clearance.shapes import FINGER, Kind, Shape, prism, robot_geometry, robot_pairs, robot_shapes


@dataclass(frozen=True)
class Margins:
    """Smallest allowed distances [m], one for each kind of meeting.

    Args:
        body: arm and own body, or parts of one arm.
        other_arm: between the arms.
        table: arm or gripper and table.
        finger_table: fingertips and table on the straight lines of a push.
        finger_travel: fingertips and table while the arm travels.
        block: arm, gripper or travelling fingers and blocks.
        descent: fingers and blocks while they go down beside them, and blocks passed by in a push.

    Raises:
        InvalidInputError: one of them is not 0..0.2 m.
    """

    body: float = 0.010
    other_arm: float = 0.020
    table: float = 0.010
    finger_table: float = 0.002
    finger_travel: float = 0.030
    block: float = 0.005
    descent: float = 0.0005

    def __post_init__(self) -> None:
        for one in fields(self):
            value = getattr(self, one.name)
            if not (0.0 <= value <= 0.2):
                raise InvalidInputError(f"margins: {one.name} {value} m, need 0 to 0.2")

    def by_kind(self) -> dict[Kind, float]:
        """Margin of every kind of meeting while the arm travels."""
        return {
            Kind.BODY: self.body,
            Kind.OTHER_ARM: self.other_arm,
            Kind.TABLE: self.table,
            Kind.FINGER_TABLE: self.finger_travel,
            Kind.BLOCK: self.block,
            Kind.FINGER_BLOCK: self.block,
            Kind.MOVED_BLOCKS: self.block,
        }


@dataclass(frozen=True)
class Pair:
    """Two shapes that may meet, by their indices, and the id of the block if one of them is one."""

    shapes: tuple[int, int]
    kind: Kind
    block: int = -1


@dataclass(frozen=True, eq=False)
class Scene:
    """Geometry around one moving arm.

    Args:
        arm: that moves.
        geometry: Pinocchio's geometry model with robot, table and blocks.
        pairs: in the order of the geometry model's.
        touched: ids of the blocks that the push touches.
    """

    arm: str
    geometry: Any
    pairs: tuple[Pair, ...]
    touched: frozenset[int]


def build_scene(
    arm: str, cell: CellGeometry, arrangement: Arrangement, touched: Iterable[int], shift: FloatArray, height: float
) -> Scene:
    """Scene for one push.

    Args:
        arm: that moves.
        cell: where the table is.
        arrangement: blocks in ``table``.
        touched: ids of the blocks that the push touches.
        shift: (2,) how far the push can carry them [m].
        height: taken for blocks whose height is not known [m].
    """
    geometry = robot_geometry().copy()
    pairs = [Pair((first, second), kind) for first, second, kind in robot_pairs(arm)]
    pose = cell.body_from_table
    table = _add(geometry, "table", coal.Halfspace(pose[:3, 2], float(pose[:3, 2] @ pose[:3, 3])))
    pairs += [
        Pair((shape.index, table), Kind.FINGER_TABLE if shape.part == FINGER else Kind.TABLE) for shape in _own(arm, 3)
    ]
    for item in arrangement.objects:
        block = _add(geometry, f"block {item.id}", prism(item.outline, 0.0, item.height or height, pose))
        for shape in _own(arm, 5):
            kind = Kind.FINGER_BLOCK if shape.part == FINGER else Kind.BLOCK
            pairs.append(Pair((shape.index, block), kind, item.id))
    touched = frozenset(touched)
    if touched:
        outline, top = _reachable_by_push(arrangement, touched, shift, height)
        moved = _add(geometry, "moved blocks", prism(outline, 0.0, top, pose))
        pairs += [Pair((shape.index, moved), Kind.MOVED_BLOCKS) for shape in _own(arm, 5)]
    for pair in pairs:
        geometry.addCollisionPair(pin.CollisionPair(*pair.shapes))
    return Scene(arm, geometry, tuple(pairs), touched)


def _reachable_by_push(
    arrangement: Arrangement, touched: frozenset[int], shift: FloatArray, height: float
) -> tuple[FloatArray, float]:
    """Hull of all blocks, the touched ones also where the push can carry them; and the greatest height [m]."""
    points = [vertex for item in arrangement.objects for vertex in item.outline]
    points += [vertex + shift for item in arrangement.objects if item.id in touched for vertex in item.outline]
    return convex_hull(points), max(item.height or height for item in arrangement.objects)


def _own(arm: str, lowest_part: int) -> list[Shape]:
    return [shape for shape in robot_shapes() if shape.arm == arm and shape.part >= lowest_part]


def _add(geometry: Any, name: str, shape: Any) -> int:
    return int(geometry.addGeometryObject(pin.GeometryObject(name, 0, pin.SE3.Identity(), shape)))
