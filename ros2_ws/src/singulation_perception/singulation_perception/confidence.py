"""How far an outline can be trusted, from what the cloud shows and does not show of it.

The factors are judgements, not probabilities; what counts is their order: an outline with a doubt is worth less than
one without. A confidence below one half says: do not rely on this outline.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.jit import compiled_part_maker

Flags = NDArray[np.bool_]

_USUAL_SUPPORT = 0.9  # share of the outline with points; corners never have them
_USUAL_FILL = 0.8
_DOUBT = 0.45  # each of them alone says: do not rely on this
_CLEAR_LEAD = 0.008  # [m] by which the second best way to cut is dearer when there is no doubt
UNUSUAL_LENGTH = 1.5  # times the median, from which a block may be two
FEWEST_TO_COMPARE = 4

FLUSH, STACKED, CLIPPED, COMPLETED = 0.45, 0.3, 0.8, 0.9


@dataclass(frozen=True, eq=False)
class Evidence:
    """What speaks for each of n outlines.

    Args:
        supported: (n,) share of its length with points of the rim or of a seam near it.
        filled: (n,) share of the pixels of its face that have points.
        flat: (n,) whether the face is a level with many points.
        concave: (n,) whether it covers a pocket that no cut explains.
        truncated: (n,) whether it ends at the border of the workspace or of the image.
        lead: (n,) how much dearer the best way without it was, for the most doubtful seam beside the outline [m].
        loose: (n,) whether a seam beside it ends where nothing shows it.
    """

    supported: FloatArray
    filled: FloatArray
    flat: Flags
    concave: Flags
    truncated: Flags
    lead: FloatArray
    loose: Flags

    @property
    def confidence(self) -> FloatArray:
        """(n,) 0..1."""
        value = 0.3 + 0.7 * np.minimum(1.0, self.supported / _USUAL_SUPPORT)
        value *= np.minimum(1.0, self.filled / _USUAL_FILL)
        value *= 0.35 + 0.65 * np.minimum(1.0, self.lead / _CLEAR_LEAD)
        doubts = (~self.flat).astype(np.int64) + self.concave + self.truncated + self.loose
        return np.minimum(1.0, value * _DOUBT**doubts)


@compiled_part_maker
def supported_share(outline: FloatArray, ring: FloatArray, reach: float, pitch: float) -> float:
    """Share of the length of an outline with points of a ring within ``reach`` [m]."""
    supported, total = 0, 0
    for k in range(len(outline)):
        j = k + 1 if k + 1 < len(outline) else 0
        x, y = outline[j, 0] - outline[k, 0], outline[j, 1] - outline[k, 1]
        length = math.sqrt(x * x + y * y)
        x, y = x / max(length, 1e-12), y / max(length, 1e-12)
        places = max(1, int(length / (3.0 * pitch)))
        seen = np.zeros(places, dtype=np.int64)
        for i in range(len(ring)):
            dx, dy = ring[i, 0] - outline[k, 0], ring[i, 1] - outline[k, 1]
            along = dx * x + dy * y
            if abs(dx * y - dy * x) < reach and 0.0 <= along < length:
                seen[min(places - 1, int(along / length * places))] = 1
        total += places
        for place in range(places):
            supported += seen[place]
    return supported / max(total, 1)
