"""Compiling everything before the first cloud arrives."""

import numpy as np
from numpy.typing import NDArray

from singulation_perception.segmentation import segment_cloud

_PITCH = 0.002


def warm_up() -> None:
    """Segments a small made-up cloud in every way there is, so that the first real one is as fast as the second.

    With empty caches this compiles for some ten seconds; after that it takes a fraction of a second.
    """
    image = _two_touching_blocks()
    image.setflags(write=False)
    for cloud in (image, image.reshape(-1, 3)):
        _ = segment_cloud(cloud).labels


def _two_touching_blocks() -> NDArray[np.float32]:
    """(90, 120, 3): an L of two blocks on a table 0.5 m below the camera."""
    x, y = np.meshgrid(np.arange(120) * _PITCH - 0.12, np.arange(90) * _PITCH - 0.09)
    depth = np.full(x.shape, 0.5)
    depth[20:50, 20:50] = 0.47
    depth[30:70, 50:80] = 0.47
    depth += 1e-4 * np.sin(97.0 * np.arange(x.size).reshape(x.shape))
    return np.stack((x, y, depth), axis=-1).astype(np.float32)
