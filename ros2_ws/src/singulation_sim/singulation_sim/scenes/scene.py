"""Blocks lying close together on the middle of the table, as a person would put a cluttered set down."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from singulation_core import Arrangement, CellGeometry, InvalidInputError, PlanarObject, ResultCode, SingulationError
from singulation_core.polygon import FloatArray, bounding_radius, separation
from singulation_sim.scenes.shapes import SHAPES

# The paper's easy sets are squares, its hard sets mix the three shapes; the groups are those of its simulations.
SCENES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {"mixed": ("square", "triangle", "rectangle"), "squares": ("square",), "empty": ()}
    | {f"group_{k}": (f"group_{k}",) for k in range(4)}
)
_FEWEST, _MOST = 3, 7  # blocks of a set in the paper
_HEIGHTS = (0.02, 0.04)  # m
_GAPS = (0.002, 0.006)  # m between neighbours
_MIDDLE = 0.03  # m; how far from the middle of the workspace the first block may lie
_TRIES = 60  # for a place of one block, and for a set in which all find one
_CLOSE = 1e-4  # m; how exactly a gap is met


@dataclass(frozen=True, slots=True)
class _Placed:
    outline: FloatArray
    centre: FloatArray
    radius: float


@dataclass(frozen=True, slots=True)
class _Room:
    """Where blocks may lie, and how close together."""

    workspace: tuple[float, float, float, float]
    margin: float
    gaps: tuple[float, float]

    @property
    def corners(self) -> FloatArray:
        """(2, 2) lowest and highest x, y."""
        x_min, x_max, y_min, y_max = self.workspace
        return np.array(((x_min, y_min), (x_max, y_max))) + np.array(((self.margin,), (-self.margin,)))

    def somewhere(self, rng: np.random.Generator) -> FloatArray:
        """A point near the middle."""
        return np.asarray(self.corners.mean(axis=0) + rng.uniform(-_MIDDLE, _MIDDLE, 2))

    def holds(self, outline: FloatArray) -> bool:
        """Whether a block lies inside."""
        low, high = self.corners
        return bool((outline >= low).all() and (outline <= high).all())


def random_scene(
    scene: str = "mixed",
    objects: int = 0,
    seed: int = 0,
    cell: CellGeometry | None = None,
    *,
    margin: float = 0.04,
    gaps: tuple[float, float] = _GAPS,
) -> Arrangement:
    """A set of blocks, each close to another, inside the workspace.

    Args:
        scene: one of ``SCENES``; ``empty`` is a bare table, however many objects are asked for.
        objects: how many; 0 for a random number from 3 to 7 as in the paper.
        seed: same seed, same scene.
        cell: whose workspace.
        margin: to the border of the workspace [m].
        gaps: smallest and largest gap of a block to the one it was put beside [m].

    Raises:
        InvalidInputError: unknown scene, a negative number of blocks, or gaps that are none.
        SingulationError: ``OUTSIDE_WORKSPACE`` if so many blocks do not fit.
    """
    if scene not in SCENES:
        raise InvalidInputError(f"unknown scene {scene!r}; one of: {', '.join(SCENES)}")
    if not (objects >= 0):
        raise InvalidInputError(f"scene: {objects} objects, need 0 (a random number) or more")
    if not (0.0 <= gaps[0] <= gaps[1] < math.inf):
        raise InvalidInputError(f"scene: gaps {gaps} m, need 0 <= smallest <= largest")
    rng = np.random.default_rng(seed)
    if not SCENES[scene]:
        return Arrangement([])
    count = objects or int(rng.integers(_FEWEST, _MOST + 1))
    workspace = (cell or CellGeometry()).workspace
    for _ in range(_TRIES):
        outlines = _cluster(rng, SCENES[scene], count, _Room(workspace, margin, gaps))
        if outlines is not None:
            break
    else:
        raise SingulationError(
            ResultCode.OUTSIDE_WORKSPACE, f"scene: {count} blocks do not fit into the workspace {workspace}"
        )
    blocks = [PlanarObject(k + 1, outline, float(rng.uniform(*_HEIGHTS))) for k, outline in enumerate(outlines)]
    return Arrangement(blocks)


def _cluster(rng: np.random.Generator, kinds: Sequence[str], count: int, room: _Room) -> list[FloatArray] | None:
    """Outlines of ``count`` blocks; None if one of them found no place."""
    placed: list[_Placed] = []
    for _ in range(count):
        for _ in range(_TRIES):
            outline = _turned(SHAPES[kinds[int(rng.integers(len(kinds)))]](rng), rng.uniform(0.0, 2.0 * np.pi))
            centre = _beside(rng, outline, placed, room.gaps) if placed else room.somewhere(rng)
            if room.holds(outline + centre):
                placed.append(_Placed(outline + centre, centre, bounding_radius(outline, np.zeros(2))))
                break
        else:
            return None
    return [item.outline for item in placed]


def _beside(
    rng: np.random.Generator, outline: FloatArray, placed: Sequence[_Placed], gaps: tuple[float, float]
) -> FloatArray:
    """Centre at which the outline has a small gap to the first block met on its way towards a random one."""
    gap, radius = rng.uniform(*gaps), bounding_radius(outline, np.zeros(2))
    target = placed[int(rng.integers(len(placed)))]
    angle = rng.uniform(0.0, 2.0 * np.pi)
    direction = np.array((np.cos(angle), np.sin(angle)))
    distance = sum(2.0 * item.radius for item in placed) + radius + target.radius
    # The gap can shrink by no more than the outline advances, so advancing by what is left of it never overlaps.
    while True:
        centre = target.centre + distance * direction
        room = min(separation(outline + centre, item.outline) for item in placed) - gap
        if not (room > _CLOSE):
            return np.asarray(centre)
        distance -= room


def _turned(outline: FloatArray, angle: float) -> FloatArray:
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.asarray(outline @ np.array(((cosine, sine), (-sine, cosine))))
