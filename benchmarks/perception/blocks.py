"""Random blocks and how they lie on the table: apart, in touching groups, corner against edge."""

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from singulation_core.polygon import FloatArray, area_centroid, separation


@dataclass(frozen=True, eq=False)
class Block:
    """A convex prism standing on the table.

    Args:
        outline: (k, 2) counter-clockwise, frame ``table`` [m].
        height: of the top face [m].
        base: of the bottom face [m], above 0 if it stands on another block.
    """

    outline: FloatArray
    height: float
    base: float = 0.0


def random_shape(random: Generator) -> FloatArray:
    """A square, rectangle, right triangle or irregular 5- to 7-gon, 30 to 60 mm wide, centroid at the origin."""
    kind = random.integers(0, 4)
    width, depth = random.uniform(0.03, 0.06, 2)
    if kind == 0:
        shape = 0.5 * width * np.array(((-1, -1), (1, -1), (1, 1), (-1, 1)))
    elif kind == 1:
        shape = 0.5 * np.array(((-width, -depth), (width, -depth), (width, depth), (-width, depth)))
    elif kind == 2:
        shape = np.array(((0, 0), (max(width, 0.04), 0), (0, max(depth, 0.04))))
    else:
        corners = int(random.integers(5, 8))
        angles = (np.arange(corners) + random.uniform(-0.18, 0.18, corners)) * 2 * np.pi / corners
        shape = 0.5 * max(width, 0.04) * np.column_stack((np.cos(angles), np.sin(angles)))
    return np.asarray(turned(shape - area_centroid(shape), random.uniform(0, 2 * np.pi)))


def turned(outline: FloatArray, angle: float) -> FloatArray:
    """The outline turned about the origin."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.asarray(outline @ np.array(((cosine, sine), (-sine, cosine))))


def random_height(random: Generator, kind: str) -> float:
    """``equal`` 30 mm; ``steps`` of 5 mm or ``uniform`` between 20 and 40 mm."""
    if kind == "equal":
        return 0.03
    if kind == "steps":
        return float(0.02 + 0.005 * random.integers(0, 5))
    return float(random.uniform(0.02, 0.04))


def placed_apart(
    random: Generator,
    groups: list[list[FloatArray]],
    area: tuple[float, float, float, float],
    gap: float,
    tries: int = 4000,
) -> list[list[FloatArray]]:
    """Groups of outlines moved to random places so that groups stay ``gap`` apart; those without room are left out."""
    placed: list[list[FloatArray]] = []
    for group in sorted(groups, key=lambda one: -len(one)):
        for _ in range(tries):
            angle = random.uniform(0, 2 * np.pi)
            shift = random.uniform((area[0], area[2]), (area[1], area[3]))
            moved = [turned(one, angle) + shift for one in group]
            if _free(moved, placed, area, gap):
                placed.append(moved)
                break
    return placed


def _free(
    moved: list[FloatArray], placed: list[list[FloatArray]], area: tuple[float, float, float, float], gap: float
) -> bool:
    points = np.vstack(moved)
    low, high = points.min(axis=0), points.max(axis=0)
    if low[0] < area[0] or high[0] > area[1] or low[1] < area[2] or high[1] > area[3]:
        return False
    return all(separation(one, two) >= gap for one in moved for group in placed for two in group)


def touching_group(random: Generator, size: int, gap: float) -> list[FloatArray]:
    """``size`` shapes, each new one with an edge parallel to an edge of one before, ``gap`` away and overlapping it.

    The neighbours meet along at least 40 % of the shorter edge; no shape overlaps another.
    """
    group = [random_shape(random)]
    while len(group) < size:
        for _ in range(200):
            candidate = _beside(random, group[int(random.integers(len(group)))], random_shape(random), gap)
            if all(separation(candidate, one) >= gap - 1e-9 for one in group):
                group.append(candidate)
                break
        else:
            group = [random_shape(random)]
    return _centred(group)


def _beside(random: Generator, one: FloatArray, shape: FloatArray, gap: float) -> FloatArray:
    """``shape`` turned and moved so that one of its edges faces an edge of ``one``."""
    k, j = int(random.integers(len(one))), int(random.integers(len(shape)))
    edge, own = _edge(one, k), _edge(shape, j)
    shape = turned(shape, _angle(edge) + np.pi - _angle(own))
    along = edge / np.linalg.norm(edge)
    length, width = float(np.linalg.norm(edge)), float(np.linalg.norm(own))
    overlap = random.uniform(0.4, 1.0) * min(length, width)
    start = overlap if random.random() < 0.5 else length + width - overlap  # of the own edge, which runs backwards
    outward = np.array((along[1], -along[0]))
    return np.asarray(shape + one[k] + start * along + gap * outward - shape[j])


def corner_contact(random: Generator, gap: float) -> list[FloatArray]:
    """Two shapes, a corner of the second against the middle part of an edge of the first."""
    one, two = random_shape(random), random_shape(random)
    k, j = int(random.integers(len(one))), int(random.integers(len(two)))
    edge = _edge(one, k)
    outward = np.array((edge[1], -edge[0])) / np.linalg.norm(edge)
    two = turned(two, _angle(outward) - _angle(-two[j]))  # centroid straight behind the corner
    return _centred([one, two + one[k] + random.uniform(0.3, 0.7) * edge + gap * outward - two[j]])


def _edge(outline: FloatArray, k: int) -> FloatArray:
    return np.asarray(outline[(k + 1) % len(outline)] - outline[k])


def _angle(vector: FloatArray) -> float:
    return float(np.arctan2(vector[1], vector[0]))


def _centred(group: list[FloatArray]) -> list[FloatArray]:
    middle = np.vstack(group).mean(axis=0)
    return [one - middle for one in group]
