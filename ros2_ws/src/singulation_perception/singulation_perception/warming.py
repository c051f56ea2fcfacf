"""Compiling everything before the first cloud arrives."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from singulation_perception.compiled_caches import are_empty
from singulation_perception.segmentation import segment_cloud
from singulation_perception.surfaces import connected_runs

_PITCH = 0.001


def warm_up() -> None:
    """Segments a small made-up cloud in every way there is, so that the first real one is as fast as the second.

    With empty caches this compiles for most of a minute; after that it takes about a second.
    """
    image = _every_kind_of_block()
    for cloud in (image, image.reshape(-1, 3)):
        _ = segment_cloud(cloud).labels


def must_compile() -> bool:
    """Whether the next warm-up compiles, because nothing compiled is kept yet."""
    return are_empty(Path(connected_runs.stats.cache_path))


def _every_kind_of_block() -> NDArray[np.float32]:
    """(120, 160, 3): on a table 0.5 m below the camera an L of two blocks, two flush ones with a groove between them,
    two flush ones of nearly the same height, and a low one beside them.
    """
    x, y = np.meshgrid(np.arange(160) * _PITCH - 0.08, np.arange(120) * _PITCH - 0.06)
    depth = np.full(x.shape, 0.5)
    depth[10:40, 10:40] = depth[20:60, 40:70] = 0.47
    depth[10:50, 85:115] = 0.47
    depth[10:50:2, 100] = depth[11:50:4, 100] = np.nan
    depth[70:90, 20:80], depth[90:110, 20:80] = 0.47, 0.4695
    depth[75:105, 82:110] = 0.485
    depth += 1e-4 * np.sin(97.0 * np.arange(x.size).reshape(x.shape))
    return np.stack((x, y, depth), axis=-1).astype(np.float32)
