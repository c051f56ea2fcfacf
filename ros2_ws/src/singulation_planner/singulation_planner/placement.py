"""Options of reachability (paper, section III-A)."""

import math
from dataclasses import dataclass, replace
from typing import Literal

from singulation_core import InvalidInputError, PusherGeometry


@dataclass(frozen=True, slots=True)
class Placement:
    """How a start point is chosen and what counts as reachable.

    Attributes:
        start: ``outline``: the pusher starts where it would touch the object, less the clearance; all of the travel
            then moves the object, and in clutter it is free more often. ``bounding_circle``: it starts at the
            object's bounding circle, as the authors' code does.
        clearance: gap to every object at the start [m]; None: a sixth of the tip radius (1.5 mm for the YuMi).
        retreat: how far a blocked start may be moved back on its line [m]. 0, the default, takes the next candidate
            instead: in the project's measurements moving back cost half of the gain.
        retreat_step: in steps of this length [m]; None: the tip radius.
        fits: which pushers must be free at the start: that of the ``contact_mode`` of the push, or those of
            ``every_mode``, which makes the modes comparable on equal pushes (as the paper's Table II counts).
        two_point_ratio: distance of two points in bounding radii of the push object (paper, section VI-B).
        widest_jaw: limit of that distance [m]; the YuMi's jaws open by 50 mm.
    """

    start: Literal["outline", "bounding_circle"] = "outline"
    clearance: float | None = None
    retreat: float = 0.0
    retreat_step: float | None = None
    fits: Literal["contact_mode", "every_mode"] = "contact_mode"
    two_point_ratio: float = 0.6
    widest_jaw: float = 0.05

    def __post_init__(self) -> None:
        if self.start not in ("outline", "bounding_circle"):
            raise InvalidInputError(f"placement: start {self.start!r}, need 'outline' or 'bounding_circle'")
        if self.fits not in ("contact_mode", "every_mode"):
            raise InvalidInputError(f"placement: fits {self.fits!r}, need 'contact_mode' or 'every_mode'")
        if not (0.0 <= self.retreat < math.inf):
            raise InvalidInputError(f"placement: retreat {self.retreat} m, need a finite length >= 0")
        for name in ("clearance", "retreat_step", "two_point_ratio", "widest_jaw"):
            value = getattr(self, name)
            if value is not None and not (0.0 < value < math.inf):
                raise InvalidInputError(f"placement: {name} {value}, need a finite positive number")


def clearance_of(placement: Placement, geometry: PusherGeometry) -> float:
    """Gap between pusher and objects at the start [m]."""
    return geometry.tip_radius / 6.0 if placement.clearance is None else placement.clearance


def with_room(placement: Placement, geometry: PusherGeometry, room: float) -> Placement:
    """The placement with a clearance of at least ``room`` [m]."""
    return placement if room <= clearance_of(placement, geometry) else replace(placement, clearance=room)
