"""Splitting a face that holds several touching blocks: the cheapest set of cuts that leaves convex pieces."""

from dataclasses import dataclass

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.creases import groove_line, step_line
from singulation_perception.cutting import along, both_pieces, chord, concave_cost, left_concave
from singulation_perception.face_image import FaceImage
from singulation_perception.promising_cuts import promising_cuts
from singulation_perception.rings import Scale
from singulation_perception.traces import trace_strength

_BRANCHES = (3, 2, 2, 1)  # cuts that are followed up, by depth
CONVEX = 0.005  # [m] cost of a ring that is left alone
_PROOF = 0.6  # strength of a trace that is cut whatever the outline says


@dataclass(frozen=True)
class Suspects:
    """What to look for inside a face.

    Args:
        groove: more points are missing than usual.
        step: heights scatter more than usual.
        noise: usual scatter [m].
    """

    groove: bool
    step: bool
    noise: float


@dataclass(frozen=True, eq=False)
class Split:
    """Pieces of a ring.

    Args:
        cost: of the cuts and of what remains concave [m].
        pieces: rings.
        cuts: both ends of each cut, (2, 2) [m].
        rivals: for each cut, how much dearer the next best way to cut was [m].
    """

    cost: float
    pieces: tuple[FloatArray, ...]
    cuts: tuple[FloatArray, ...] = ()
    rivals: tuple[float, ...] = ()


def split(ring: FloatArray, scale: Scale, image: FaceImage, noise: float, depth: int = 0) -> Split:
    """Branch and bound over the cuts that the outline suggests.

    Args:
        ring: (m, 2) rim of a face, counter-clockwise [m].
        scale: of the cloud.
        image: the face.
        noise: of the heights [m].
        depth: cuts that led to this ring.
    """
    uncut = Split(concave_cost(ring, scale.roughness), (ring,))
    if depth == len(_BRANCHES) or uncut.cost < CONVEX:
        return uncut
    best, second, chosen = uncut, np.inf, None
    follow = _BRANCHES[depth]
    for _, cost, first, last, *line in promising_cuts(ring, scale, image, noise, 2 * follow)[:follow].tolist():
        if cost >= best.cost:
            break
        i, j = int(first), int(last)
        cut = ring[[i, j]]
        parts = both_pieces(ring, i, j, tuple(line), scale)
        pieces = [split(part, scale, image, noise, depth + 1) for part in parts]
        total = cost + sum(piece.cost for piece in pieces)
        if total < best.cost:
            second, chosen = best.cost, (cut, pieces)
            best = _joined(total, cut, 0.0, pieces)
        else:
            second = min(second, total)
    return uncut if chosen is None else _joined(best.cost, chosen[0], second - best.cost, chosen[1])


def split_seen(
    ring: FloatArray, scale: Scale, image: FaceImage, suspects: Suspects, depth: int = 0
) -> tuple[FloatArray, ...]:
    """Cuts a ring along the grooves and steps that are beyond doubt."""
    lines = [groove_line(image, scale.pitch)] if suspects.groove else []
    lines += [step_line(image, suspects.noise)] if suspects.step else []
    for line in lines:
        if line is None or depth == len(_BRANCHES):
            continue
        i, j = chord(ring, line[0], line[1], line[2])
        if i < 0 or trace_strength(image, *ring[i], *ring[j], scale.pitch, suspects.noise) < _PROOF:
            continue
        parts = both_pieces(ring, i, j, along(ring, i, j, line[0], line[1], line[2]), scale)
        if left_concave(*parts, scale) < CONVEX + concave_cost(ring, scale.roughness):
            return tuple(piece for part in parts for piece in split_seen(part, scale, image, suspects, depth + 1))
    return (ring,)


def _joined(cost: float, cut: FloatArray, rival: float, parts: list[Split]) -> Split:
    first, second = parts
    return Split(
        cost,
        first.pieces + second.pieces,
        (cut, *first.cuts, *second.cuts),
        (rival, *first.rivals, *second.rivals),
    )
