"""All blocks on the table at one moment."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from singulation_core.errors import InvalidInputError
from singulation_core.planar_object import PlanarObject
from singulation_core.polygon import FloatArray


@dataclass(frozen=True, eq=False)
class Arrangement:
    """Objects in one frame at one time (the paper's A).

    Args:
        objects: with ids that differ.
        frame: coordinate frame, ``table`` unless said otherwise.
        stamp: time of the cloud behind it [s], 0 if it has none.

    Raises:
        InvalidInputError: two objects with one id.
    """

    objects: Sequence[PlanarObject]
    frame: str = "table"
    stamp: float = 0.0
    centroids: FloatArray = field(init=False, repr=False)  # (n, 2) [m]
    bounding_radii: FloatArray = field(init=False, repr=False)  # (n,) [m]

    def __post_init__(self) -> None:
        objects = tuple(self.objects)
        ids = [item.id for item in objects]
        if len(set(ids)) != len(ids):
            repeated = sorted({one for one in ids if ids.count(one) > 1})
            raise InvalidInputError(f"arrangement: object ids {repeated} are used more than once")
        centroids = np.array([item.centroid for item in objects]).reshape(-1, 2)
        radii = np.array([item.bounding_radius for item in objects], dtype=np.float64)
        centroids.setflags(write=False)
        radii.setflags(write=False)
        object.__setattr__(self, "objects", objects)
        object.__setattr__(self, "centroids", centroids)
        object.__setattr__(self, "bounding_radii", radii)

    def __len__(self) -> int:
        return len(self.objects)

    def index(self, object_id: int) -> int:
        """Position of the object with this id.

        Raises:
            InvalidInputError: listing the ids there are.
        """
        for position, item in enumerate(self.objects):
            if item.id == object_id:
                return position
        ids = [item.id for item in self.objects]
        raise InvalidInputError(f"arrangement: no object {object_id}; there are {ids}")
