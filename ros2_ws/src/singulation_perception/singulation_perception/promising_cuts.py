"""The cuts of a ring that are worth following up, found in one compiled call."""

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.cutting import both_pieces, estimated, left_concave
from singulation_perception.face_image import FaceImage
from singulation_perception.jit import compiled_maker, compiled_part
from singulation_perception.rings import Scale
from singulation_perception.seam_lines import seam_line
from singulation_perception.seams import candidates, edges_between, one_seam
from singulation_perception.simplified import simplified
from singulation_perception.traces import trace_strength

_CORNER_TOLERANCE = 0.72  # of the roughness, for Douglas-Peucker when corners are sought
_TOLD = 0.5  # strength of a trace from which on it tells where a cut ends
_SEEN = 0.8  # share of a cut's cost that a trace beyond doubt saves


@compiled_maker
def promising_cuts(ring: FloatArray, scale: Scale, image: FaceImage, noise: float, most: int) -> FloatArray:
    """The cheapest cuts of a ring.

    Args:
        ring: (m, 2) rim of a face, counter-clockwise [m].
        scale: of the cloud.
        image: the face.
        noise: of the heights [m].
        most: how many cuts to weigh; a rough estimate chooses them.

    Returns:
        (c, 9), cheapest first: cost with what is left concave [m], cost of the cut [m], the points of the ring at its
        ends, point and unit direction of its line [m], and whether nothing shows where it ends.
    """
    index = simplified(ring, _CORNER_TOLERANCE * scale.roughness)
    cuts = np.empty((most, 9))
    if len(index) < 4:
        return cuts[:0]
    lines, length, fitted = edges_between(ring, index)
    possible = candidates(ring, index, lines, length, scale.pitch)
    rough = estimated(ring, possible, index, scale)
    count = 0
    for _ in range(most):
        k, least = -1, np.inf
        for i in range(len(rough)):
            if rough[i, 2] < least:
                k, least = i, rough[i, 2]
        if k < 0:
            break
        rough[k, 2] = np.inf
        line = seam_line(ring, possible[k], index, lines, fitted, scale)
        i, j = int(possible[k, 0]), int(possible[k, 1])
        strength = trace_strength(image, ring[i, 0], ring[i, 1], ring[j, 0], ring[j, 1], scale.pitch, noise)
        cost = rough[k, 0] * (1.0 - _SEEN * strength) + rough[k, 1]
        first, second = both_pieces(ring, i, j, line, scale)
        total = cost + left_concave(first, second, scale)
        if total < np.inf:
            same = _same_seam(cuts, np.int64(count), ring, i, j, scale.pitch)
            if same >= 0 and cuts[same, 0] <= total:
                continue
            if same >= 0:
                count -= 1
                for row in range(same, count):
                    for column in range(9):
                        cuts[row, column] = cuts[row + 1, column]
            at = count
            while at > 0 and cuts[at - 1, 0] > total:
                for column in range(9):
                    cuts[at, column] = cuts[at - 1, column]
                at -= 1
            cuts[at, 0], cuts[at, 1], cuts[at, 2], cuts[at, 3] = total, cost, i, j
            cuts[at, 4], cuts[at, 5], cuts[at, 6], cuts[at, 7] = line
            cuts[at, 8] = possible[k, 6] > 0.0 and strength < _TOLD
            count += 1
    return cuts[:count]


@compiled_part
def _same_seam(cuts: FloatArray, count: int, ring: FloatArray, i: int, j: int, pitch: float) -> int:
    """Which of the first ``count`` cuts runs along the seam from point i to point j; -1 if none does."""
    for k in range(count):
        a, b = int(cuts[k, 2]), int(cuts[k, 3])
        ax, ay, bx, by = ring[a, 0], ring[a, 1], ring[b, 0], ring[b, 1]
        if one_seam(ax, ay, bx, by, ring[i, 0], ring[i, 1], ring[j, 0], ring[j, 1], pitch):
            return k
    return -1
