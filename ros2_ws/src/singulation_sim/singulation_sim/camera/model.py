"""Pinhole model of the PhoXi's two image sizes."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class CameraModel:
    """Image size [px], focal length [px], principal point [px].

    Axes: x to the right, y down, z forward (``phoxi_camera_sensor``). The focal length is the one the lab's software
    uses for its PhoXi.
    """

    width: int
    height: int
    focal: float
    centre: tuple[float, float]


PHOXI_SMALL = CameraModel(1032, 772, 1122.0, (511.5, 386.0))
PHOXI_FULL = CameraModel(2064, 1544, 2244.0, (1023.0, 772.0))


@cache
def rays(model: CameraModel) -> NDArray[np.float32]:
    """(H, W, 3) unit vectors from the camera through the pixel centres."""
    x = (np.arange(model.width) - model.centre[0]) / model.focal
    y = (np.arange(model.height) - model.centre[1]) / model.focal
    length = np.sqrt(1.0 + x**2 + y[:, None] ** 2)
    result = np.empty((model.height, model.width, 3), dtype=np.float32)
    result[..., 0], result[..., 1], result[..., 2] = x / length, y[:, None] / length, 1.0 / length
    result.setflags(write=False)
    return result
