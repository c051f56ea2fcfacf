"""A straight push and the jaws that perform it."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from singulation_core.arrangement import Arrangement
from singulation_core.contact_mode import ContactMode
from singulation_core.errors import InvalidInputError
from singulation_core.polygon import FloatArray


@dataclass(frozen=True, eq=False)
class Push:
    """The contact, or the middle of the contact, moves straight from start to end.

    Args:
        start: P of the paper, (2,) metres in the frame of the arrangement. At P the pusher is still free.
        end: Q of the paper, (2,) metres.
        contact_mode: how the jaws touch.
        contact_width: edge length or jaw distance [m]; 0 for a single point.
        target_id: object to be pushed, None if none is meant.
        policy: name of the policy that planned it, "" if none did.
        expected_gain: (s' - s) / s if simulated, else NaN.
        expected: the arrangement after the push if its policy simulated it, else None.

    Raises:
        InvalidInputError: not finite, no length, or a width that does not fit the mode.
    """

    start: FloatArray
    end: FloatArray
    contact_mode: ContactMode
    contact_width: float = 0.0
    target_id: int | None = None
    policy: str = ""
    expected_gain: float = float("nan")
    expected: Arrangement | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "start", _point(self.start, "start"))
        object.__setattr__(self, "end", _point(self.end, "end"))
        object.__setattr__(self, "contact_mode", ContactMode(self.contact_mode))
        if not (self.length > 0.0):
            raise InvalidInputError("push: start and end coincide, it has no direction")
        if not (0.0 <= self.contact_width < float("inf")):
            raise InvalidInputError(f"push: contact width {self.contact_width} m, need a finite one >= 0")
        if (self.contact_width == 0.0) != (self.contact_mode is ContactMode.SINGLE_POINT):
            raise InvalidInputError(
                f"push: contact width {self.contact_width} m with {self.contact_mode.label}; "
                "it is 0 for single_point and positive for the others"
            )

    @property
    def length(self) -> float:
        """Distance from start to end [m]."""
        return math.hypot(*(self.end - self.start).tolist())

    @property
    def direction(self) -> FloatArray:
        """Unit vector from start to end, (2,)."""
        return np.asarray((self.end - self.start) / self.length)


def _point(value: ArrayLike, name: str) -> FloatArray:
    point = np.array(value, dtype=np.float64)
    if point.shape != (2,) or not all(map(math.isfinite, point.tolist())):
        raise InvalidInputError(f"push: {name} {point.tolist()}, need two finite numbers")
    point.setflags(write=False)
    return point


@dataclass(frozen=True, slots=True)
class PusherGeometry:
    """Footprint of the YuMi's jaws on the table [m].

    Defaults from measurements of the SmartGripper's fingers: a closed pair is 12.4 mm by 12 mm at the tip. A single
    point is the disc around it, so that a start that is free for the disc is free for the jaws at any yaw; the planar
    side is 12.4 mm wide and 12 mm thick.

    Args:
        tip_radius: of the disc of a single point.
        edge_width: of the jaws' planar side.
        edge_thickness: of the jaws behind that side.

    Raises:
        InvalidInputError: a length that is not finite and positive.
    """

    tip_radius: float = 0.0087
    edge_width: float = 0.0124
    edge_thickness: float = 0.012

    def __post_init__(self) -> None:
        for name in ("tip_radius", "edge_width", "edge_thickness"):
            value = getattr(self, name)
            if not (0.0 < value < float("inf")):
                raise InvalidInputError(f"pusher: {name} {value} m, need a finite positive length")
