"""Which block of this look is which block of the last one: perception numbers them anew every time."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from singulation_core import Arrangement, PlanarObject
from singulation_core.polygon import FloatArray

_FORBIDDEN = 1e6


@dataclass(frozen=True, slots=True)
class TrackingParameters:
    """Limits of what may be the same block.

    Args:
        reach: farthest that a block moves between two looks [m]; a push is a few block sizes long.
        area_change: largest ratio of areas minus one; perception measures areas within a few per cent.
        shape_weight: metres of distance that a doubled area counts as.
    """

    reach: float = 0.15
    area_change: float = 0.5
    shape_weight: float = 0.2


@dataclass(frozen=True, slots=True)
class Tracked:
    """A look with lasting identities.

    Args:
        arrangement: objects under lasting ids.
        lasting_ids: perception's id -> lasting id.
        lost: lasting ids of the last look that are not seen now.
        found: lasting ids that are new.
    """

    arrangement: Arrangement
    lasting_ids: dict[int, int]
    lost: tuple[int, ...]
    found: tuple[int, ...]


class Tracker:
    """Hands out lasting ids, look after look."""

    def __init__(self, parameters: TrackingParameters | None = None) -> None:
        self._parameters = parameters or TrackingParameters()
        self._known: dict[int, PlanarObject] = {}
        self._next_id = 0

    def update(self, seen: Arrangement) -> Tracked:
        """Match a look to the last one by pose and shape (least total cost, one to one)."""
        known = list(self._known.items())
        pairs = _match([item for _, item in known], list(seen.objects), self._parameters)
        lasting: dict[int, int] = {}
        found = []
        for position, item in enumerate(seen.objects):
            if position in pairs:
                lasting[item.id] = known[pairs[position]][0]
            else:
                lasting[item.id] = self._next_id
                found.append(self._next_id)
                self._next_id += 1
        lost = tuple(identity for identity in self._known if identity not in lasting.values())
        objects = [renamed(item, lasting[item.id]) for item in seen.objects]
        # A block that is hidden for one look keeps its place, so that it is recognised when it is seen again.
        self._known |= {item.id: item for item in objects}
        return Tracked(Arrangement(objects, seen.frame, seen.stamp), lasting, lost, tuple(found))


def renamed(item: PlanarObject, identity: int) -> PlanarObject:
    """The same block under another id."""
    return PlanarObject(identity, item.outline, item.height, item.point_count, item.confidence)


def _match(known: list[PlanarObject], seen: list[PlanarObject], limits: TrackingParameters) -> dict[int, int]:
    """Positions in ``seen`` -> positions in ``known``."""
    if not known or not seen:
        return {}
    cost = np.array([[_cost(old, new, limits) for old in known] for new in seen])
    rows, columns = linear_sum_assignment(cost)
    return {int(r): int(c) for r, c in zip(rows, columns, strict=True) if cost[r, c] < _FORBIDDEN}


def _cost(old: PlanarObject, new: PlanarObject, limits: TrackingParameters) -> float:
    ratio = max(old.area / new.area, new.area / old.area)
    distance = _length(old.centroid - new.centroid)
    if not (distance <= limits.reach and ratio - 1.0 <= limits.area_change):
        return _FORBIDDEN
    corners = abs(len(old.outline) - len(new.outline))
    return distance + limits.shape_weight * (float(np.log2(ratio)) + 0.05 * corners)


def _length(vector: FloatArray) -> float:
    return float(np.hypot(vector[0], vector[1]))
