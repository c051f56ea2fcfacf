"""Which block of this look is which block of the last one: perception numbers them anew every time."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from singulation_core import Arrangement, PlanarObject
from singulation_core.polygon import FloatArray, contains

_FORBIDDEN = 1e6


@dataclass(frozen=True, slots=True)
class TrackingParameters:
    """Limits of what may be the same block.

    Args:
        reach: farthest that a block moves between two looks [m]; a push is a few block sizes long.
        area_change: largest ratio of areas minus one; perception measures areas within a few per cent.
        shape_weight: metres of distance that a doubled area counts as.
        whole_again: as ``area_change``, for a block that was seen in two pieces once and is whole before and after.
    """

    reach: float = 0.15
    area_change: float = 0.5
    shape_weight: float = 0.2
    whole_again: float = 0.1


@dataclass(frozen=True, slots=True)
class Tracked:
    """A look with lasting identities.

    Args:
        arrangement: objects under lasting ids.
        lasting_ids: perception's id -> lasting id.
        lost: lasting ids of blocks that are known and not seen now.
        covered: of them, those that should lie where another block is seen: the two may be seen as one.
        found: lasting ids that are new.
        given_up: lasting ids of what is now seen as several blocks, or was a piece of a block that is whole again.
    """

    arrangement: Arrangement
    lasting_ids: dict[int, int]
    lost: tuple[int, ...]
    covered: tuple[int, ...]
    found: tuple[int, ...]
    given_up: tuple[int, ...]


class Tracker:
    """Hands out lasting ids, look after look."""

    def __init__(self, parameters: TrackingParameters | None = None) -> None:
        self._parameters = parameters or TrackingParameters()
        self._known: dict[int, PlanarObject] = {}
        self._next_id = 0
        self._areas_before: dict[int, dict[int, float]] = {}  # of what was found a look ago: who had which area then

    def update(self, seen: Arrangement, expected: Arrangement | None = None) -> Tracked:
        """Match a look to what is known, by pose and shape (least total cost, one to one).

        Args:
            seen: the look, under perception's ids.
            expected: where known blocks should be by now, under lasting ids, as a simulated push has them; the others
                are expected where they were seen last. In a row of equal blocks that were pushed along by one block's
                length, nothing else tells which is which.
        """
        self._known |= {item.id: item for item in (expected.objects if expected else ()) if item.id in self._known}
        known = list(self._known.items())
        pairs = _match([item for _, item in known], list(seen.objects), self._parameters)
        lasting: dict[int, int] = {}
        for position, item in enumerate(seen.objects):
            lasting[item.id] = known[pairs[position]][0] if position in pairs else self._new_id()
        objects = [renamed(item, lasting[item.id]) for item in seen.objects]
        found = [item for item in objects if item.id not in self._known]
        lost = {identity: item for identity, item in self._known.items() if identity not in lasting.values()}
        given_up = [identity for identity, item in lost.items() if _is_divided(item, found, self._parameters)]
        given_up += [identity for identity, item in lost.items() if self._was_a_piece(item, objects)]
        for identity in given_up:
            del self._known[identity], lost[identity]
        self._areas_before = {item.id: {one: known.area for one, known in self._known.items()} for item in found}
        # A block that is hidden for one look keeps its place, so that it is recognised when it is seen again.
        self._known |= {item.id: item for item in objects}
        covered = [identity for identity, item in lost.items() if _is_covered(item, objects)]
        return Tracked(
            Arrangement(objects, seen.frame, seen.stamp),
            lasting,
            tuple(lost),
            tuple(covered),
            tuple(item.id for item in found),
            tuple(given_up),
        )

    def _was_a_piece(self, item: PlanarObject, objects: Sequence[PlanarObject]) -> bool:
        """Whether what was found a look ago lies where a block is that was whole before, and is now again."""
        areas, limit = self._areas_before.get(item.id, {}), self._parameters.whole_again
        return any(
            _ratio(one.area, areas[one.id]) - 1.0 <= limit
            and _ratio(one.area, self._known[one.id].area + item.area) - 1.0 <= limit
            and contains(one.outline, item.centroid)[0]
            for one in objects
            if one.id in areas
        )

    def _new_id(self) -> int:
        self._next_id += 1
        return self._next_id - 1


def _is_divided(item: PlanarObject, found: Sequence[PlanarObject], limits: TrackingParameters) -> bool:
    """Whether several new blocks lie where one was, and are about as large together."""
    parts = [one for one in found if contains(item.outline, one.centroid)[0]]
    whole = sum(one.area for one in parts)
    return len(parts) > 1 and _ratio(item.area, whole) - 1.0 <= limits.area_change


def _ratio(area: float, other: float) -> float:
    return max(area / other, other / area)


def _is_covered(item: PlanarObject, objects: Sequence[PlanarObject]) -> bool:
    return any(contains(one.outline, item.centroid)[0] for one in objects)


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
    ratio = _ratio(old.area, new.area)
    distance = _length(old.centroid - new.centroid)
    if not (distance <= limits.reach and ratio - 1.0 <= limits.area_change):
        return _FORBIDDEN
    corners = abs(len(old.outline) - len(new.outline))
    return distance + limits.shape_weight * (float(np.log2(ratio)) + 0.05 * corners)


def _length(vector: FloatArray) -> float:
    return float(np.hypot(vector[0], vector[1]))
