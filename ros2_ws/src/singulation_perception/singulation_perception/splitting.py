"""Splitting a face that holds several touching blocks: the cheapest set of cuts that leaves convex pieces."""

from dataclasses import dataclass, replace

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.creases import groove_line, step_line
from singulation_perception.cutting import along, both_pieces, chord, concave_cost, left_concave
from singulation_perception.face_image import FaceImage
from singulation_perception.promising_cuts import promising_cuts
from singulation_perception.rings import Scale
from singulation_perception.seams import one_seam
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
        rivals: for each cut, how much dearer the best way without it was [m].
        loose: for each cut, whether nothing shows where it ends.
    """

    cost: float
    pieces: tuple[FloatArray, ...]
    cuts: tuple[FloatArray, ...] = ()
    rivals: tuple[float, ...] = ()
    loose: tuple[bool, ...] = ()


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
    best, ways = uncut, [uncut]
    follow = _BRANCHES[depth]
    for k, (left, cost, first, last, *line, loose) in enumerate(
        promising_cuts(ring, scale, image, noise, 2 * follow).tolist()
    ):
        i, j = int(first), int(last)
        cut = ring[[i, j]]
        if k >= follow or cost >= best.cost:
            ways.append(Split(left, (), (cut,)))
            continue
        parts = both_pieces(ring, i, j, tuple(line), scale)
        ways.append(_joined(cost, cut, bool(loose), [split(part, scale, image, noise, depth + 1) for part in parts]))
        best = min(best, ways[-1], key=lambda way: way.cost)
    return _with_rivals(best, ways, scale)


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


def _joined(cost: float, cut: FloatArray, loose: bool, parts: list[Split]) -> Split:
    first, second = parts
    return Split(
        cost + first.cost + second.cost,
        first.pieces + second.pieces,
        (cut, *first.cuts, *second.cuts),
        (np.inf, *first.rivals, *second.rivals),
        (loose, *first.loose, *second.loose),
    )


def _with_rivals(best: Split, ways: list[Split], scale: Scale) -> Split:
    """The best way with the leads of its cuts over all ways that do without them: order makes no other way."""
    rivals = list(best.rivals)
    for k, cut in enumerate(best.cuts):
        for way in ways:
            if way.cost - best.cost < rivals[k] and not any(
                one_seam(*cut.flat, *other.flat, scale.pitch) for other in way.cuts
            ):
                rivals[k] = way.cost - best.cost
    return replace(best, rivals=tuple(rivals))
