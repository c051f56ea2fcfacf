"""Which of the touched blocks is which of the seen ones, and how the two drawings lie on each other."""

from dataclasses import dataclass
from itertools import permutations

import numpy as np

from singulation_core import InvalidInputError
from singulation_core.polygon import FloatArray

_REACH = 0.006  # m; touched by eye and seen by the camera, the middle of a block differs by less
_CLEARLY = 2.0  # another assignment has to be this many times worse, or the blocks lie too regularly


@dataclass(frozen=True, eq=False)
class PlanarMatch:
    """How seen points lie on touched ones.

    Args:
        touched_from_seen: 3x3, turns and shifts (x, y, 1).
        seen: index of the seen point of each touched one.
        residuals: (n,) distances that remain [m].
    """

    touched_from_seen: FloatArray
    seen: tuple[int, ...]
    residuals: FloatArray

    @property
    def rms(self) -> float:
        """Of the residuals [m]."""
        return float(np.sqrt((self.residuals**2).mean()))


def match_planar(touched: FloatArray, seen: FloatArray, reach: float = _REACH) -> PlanarMatch:
    """Rigid motion in the plane that brings every touched point to a seen one of its own.

    Args:
        touched: (n >= 3, 2) [m].
        seen: (m >= n, 2) [m], in another frame and order; may hold more than was touched.
        reach: largest residual of a match [m].

    Raises:
        InvalidInputError: too few points, no match, or two that fit alike.
    """
    if len(touched) < 3 or len(seen) < len(touched):
        raise InvalidInputError(
            f"blocks: {len(touched)} touched, {len(seen)} seen by the camera; need at least 3 touched, all of them seen"
        )
    found = sorted(_candidates(touched, seen, reach), key=lambda one: one.rms)
    if not found:
        raise InvalidInputError(
            f"blocks: no way to lay the {len(touched)} touched points on {len(seen)} seen blocks with less than "
            f"{1e3 * reach:.0f} mm between them; touch the middle of each top face"
        )
    best = found[0]
    rivals = [one for one in found[1:] if one.seen != best.seen]
    if rivals and not (rivals[0].rms >= _CLEARLY * max(best.rms, 0.0005)):
        raise InvalidInputError(
            f"blocks: two assignments fit alike ({1e3 * best.rms:.2f} and {1e3 * rivals[0].rms:.2f} mm); "
            "lay the blocks less regularly, with different distances"
        )
    return best


def _candidates(touched: FloatArray, seen: FloatArray, reach: float) -> list[PlanarMatch]:
    """Every assignment that starts from the two touched points farthest apart, fitted to all points."""
    distances = np.linalg.norm(touched[:, None] - touched[None], axis=2)
    first, second = np.unravel_index(int(distances.argmax()), distances.shape)
    found: dict[tuple[int, ...], PlanarMatch] = {}
    for one, other in permutations(range(len(seen)), 2):
        if abs(float(np.linalg.norm(seen[one] - seen[other])) - distances[first, second]) > 2.0 * reach:
            continue
        start = fit_planar(touched[[first, second]], seen[[one, other]])
        assigned = _nearest(touched, moved(start, seen), 3.0 * reach)
        if assigned is None or assigned in found:
            continue
        motion = fit_planar(touched, seen[list(assigned)])
        residuals = np.linalg.norm(moved(motion, seen[list(assigned)]) - touched, axis=1)
        if residuals.max() <= reach:
            found[assigned] = PlanarMatch(motion, assigned, residuals)
    return list(found.values())


def _nearest(touched: FloatArray, seen: FloatArray, reach: float) -> tuple[int, ...] | None:
    """The nearest seen point of each touched one, if they are within reach and all different."""
    distances = np.linalg.norm(touched[:, None] - seen[None], axis=2)
    nearest = distances.argmin(axis=1)
    if len(set(nearest.tolist())) < len(touched) or not (distances.min(axis=1).max() <= reach):
        return None
    return tuple(nearest.tolist())


def fit_planar(target: FloatArray, source: FloatArray) -> FloatArray:
    """3x3 rigid motion in the plane that brings (n, 2) ``source`` nearest to ``target`` (Kabsch)."""
    to, of = target.mean(axis=0), source.mean(axis=0)
    u, _, vt = np.linalg.svd((target - to).T @ (source - of))
    rotation = u @ np.diag((1.0, np.sign(np.linalg.det(u @ vt)))) @ vt
    motion = np.eye(3)
    motion[:2, :2], motion[:2, 2] = rotation, to - rotation @ of
    return motion


def moved(motion: FloatArray, points: FloatArray) -> FloatArray:
    """(n, 2) points moved by a 3x3 motion."""
    return np.asarray(points @ motion[:2, :2].T + motion[:2, 2])
