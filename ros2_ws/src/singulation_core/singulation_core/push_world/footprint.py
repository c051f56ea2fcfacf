"""Where jaws touch the table plane: discs and convex polygons that move as one."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from singulation_core.contact_mode import ContactMode
from singulation_core.errors import InvalidInputError
from singulation_core.polygon import FloatArray, validated_outline
from singulation_core.push import Push, PusherGeometry


@dataclass(frozen=True, slots=True)
class Disc:
    """A round fingertip: centre x, y in the pusher's frame and radius [m]."""

    x: float
    y: float
    radius: float

    def __post_init__(self) -> None:
        if not (np.isfinite((self.x, self.y)).all() and 0.0 < self.radius < float("inf")):
            raise InvalidInputError(
                f"disc: centre ({self.x}, {self.y}) m, radius {self.radius} m; need finite ones, radius > 0"
            )


@dataclass(frozen=True, eq=False)
class Footprint:
    """A rigid pusher in its own frame, in which +x is the direction of the push.

    Args:
        discs: round parts.
        polygons: (k, 2) convex counter-clockwise parts [m].

    Raises:
        InvalidInputError: no part at all, or a malformed one.
    """

    discs: tuple[Disc, ...] = ()
    polygons: tuple[FloatArray, ...] = ()

    def __post_init__(self) -> None:
        if not self.discs and not self.polygons:
            raise InvalidInputError("footprint: no part; leave the pusher out instead")
        checked = tuple(validated_outline(one, f"footprint: polygon {k}") for k, one in enumerate(self.polygons))
        object.__setattr__(self, "polygons", checked)

    @property
    def reach(self) -> float:
        """Largest distance of any of its points to its origin [m]."""
        discs = [float(np.hypot(one.x, one.y)) + one.radius for one in self.discs]
        return max(discs + [float(np.hypot(one[:, 0], one[:, 1]).max()) for one in self.polygons])

    @property
    def thickness(self) -> float:
        """Smallest thickness of its parts along the push [m]: what a step must stay well below."""
        return min([2.0 * one.radius for one in self.discs] + [float(np.ptp(one[:, 0])) for one in self.polygons])


def pusher_footprint(push: Push, pusher: PusherGeometry) -> Footprint:
    """The jaws of a push; the origin of the footprint moves from ``push.start`` to ``push.end``.

    Single point: a disc around the origin. Edge: a rectangle ``contact_width`` wide, the middle of its front edge at
    the origin. Two points: two discs, their centres ``contact_width`` apart, the origin in the middle.
    """
    return _jaws(push.contact_mode, push.contact_width, pusher)


@lru_cache(maxsize=256)
def _jaws(mode: ContactMode, width: float, pusher: PusherGeometry) -> Footprint:
    half = 0.5 * width
    if mode is ContactMode.SINGLE_POINT:
        return Footprint(discs=(Disc(0.0, 0.0, pusher.tip_radius),))
    if mode is ContactMode.TWO_POINT:
        return Footprint(discs=(Disc(0.0, -half, pusher.tip_radius), Disc(0.0, half, pusher.tip_radius)))
    back = -pusher.edge_thickness
    return Footprint(polygons=(np.array(((back, -half), (0.0, -half), (0.0, half), (back, half))),))
