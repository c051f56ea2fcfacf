"""A block on the table, seen from above."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from singulation_core.errors import InvalidInputError
from singulation_core.polygon import FloatArray, MeasuredOutline, measured_outline


@dataclass(frozen=True, eq=False)
class PlanarObject:
    """A convex polygon with its area centroid as centre of mass.

    Args:
        id: unique within its arrangement, 0 <= id < 2**32.
        outline: (k, 2) vertices, convex, counter-clockwise, metres, frame of the arrangement.
        height: of the top face above the table [m], 0 if unknown.
        point_count: points of the cloud behind it, 0 if it was not seen by a camera.
        confidence: 0..1.

    Raises:
        InvalidInputError: naming the object and what is wrong with it.
    """

    id: int
    outline: FloatArray
    height: float = 0.0
    point_count: int = 0
    confidence: float = 1.0
    centroid: FloatArray = field(init=False, repr=False)
    bounding_radius: float = field(init=False, repr=False)
    area: float = field(init=False, repr=False)

    def __post_init__(self) -> None:
        _require(self.id, self.height, self.confidence)
        measured = measured_outline(self.outline, f"object {self.id}")
        for attribute, value in zip(measured._fields, measured, strict=True):
            object.__setattr__(self, attribute, value)

    @classmethod
    def measured(
        cls, id: int, outline: MeasuredOutline, height: float = 0.0, point_count: int = 0, confidence: float = 1.0
    ) -> "PlanarObject":
        """An object with an outline that was checked and measured already, which takes most of the time of making one.

        Args:
            id: as for the class, and so are ``height``, ``point_count`` and ``confidence``.
            outline: as ``measured_outline`` gives it.

        Raises:
            InvalidInputError: naming the object and what is wrong with it.
        """
        _require(id, height, confidence)
        made = cls.__new__(cls)
        made.__dict__.update(  # a frozen object is filled once
            id=id,
            outline=outline.outline,
            height=height,
            point_count=point_count,
            confidence=confidence,
            centroid=outline.centroid,
            bounding_radius=outline.bounding_radius,
            area=outline.area,
        )
        return made

    def moved(self, translation: ArrayLike, rotation: float = 0.0) -> "PlanarObject":
        """The same block turned by ``rotation`` [rad] about its centroid, then shifted by (2,) [m]."""
        cosine, sine = np.cos(rotation), np.sin(rotation)
        turn = np.array(((cosine, sine), (-sine, cosine)))
        outline = (self.outline - self.centroid) @ turn + self.centroid
        return PlanarObject(
            self.id,
            outline + np.asarray(translation, dtype=np.float64),
            self.height,
            self.point_count,
            self.confidence,
        )


def _require(id: int, height: float, confidence: float) -> None:
    if not (0 <= id < 2**32):
        raise InvalidInputError(f"object {id}: id out of range, need 0 <= id < 2**32")
    if not (0.0 <= height < float("inf")):
        raise InvalidInputError(f"object {id}: height {height} m, need a finite one >= 0")
    if not (0.0 <= confidence <= 1.0):
        raise InvalidInputError(f"object {id}: confidence {confidence}, need 0..1")
