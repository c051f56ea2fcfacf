"""Compiling everything before the first cloud arrives."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.face_image import FaceImage
from singulation_perception.flat_clouds import flat_cloud
from singulation_perception.hidden_corners import count_lower
from singulation_perception.object_points import ObjectPoints
from singulation_perception.outlines import outlines_of
from singulation_perception.parameters import SegmentationParameters
from singulation_perception.raster import raster_of
from singulation_perception.rings import Scale
from singulation_perception.segmentation import segment_cloud
from singulation_perception.shapes import shape_of
from singulation_perception.splitting import split

_PITCH = 0.001
_SCALE = Scale(_PITCH, 0.5 * _PITCH, 3.0 * _PITCH)


def warm_up() -> None:
    """Segments a small made-up cloud in every way there is, so that the first real one is as fast as the second.

    With empty caches this compiles for most of a minute; after that it takes about a second.
    """
    _see_image()
    _seldom()
    _see_points()


def _see_image() -> None:
    _ = segment_cloud(_every_kind_of_block()).labels


def _see_points() -> None:
    _ = segment_cloud(_every_kind_of_block().reshape(-1, 3)).labels


def _cut() -> None:
    image = FaceImage(
        np.zeros(2, dtype=np.int32),
        np.full((60, 60), -1, dtype=np.int32),
        np.zeros((1, 3), dtype=np.float32),
        np.array(((0.0, 1.0 / _PITCH, 0.0), (1.0 / _PITCH, 0.0, 0.0))),
    )
    split(_ring_of_an_l(), _SCALE, image, 0.1 * _PITCH)


def _seldom() -> None:
    cloud, plane = raster_of(np.ones((2, 2, 3), dtype=np.float32)), np.zeros(4, dtype=np.float32)
    place = np.zeros(2)
    shape_of(_ring_of_an_l())  # of outlines that are drawn again
    count_lower(cloud, plane, np.zeros((2, 3)), np.zeros(2, dtype=np.int32), place, place, place, np.float32(0.0))


def _outline() -> None:
    outlines_of([_ring_of_an_l()], [np.empty(0, dtype=np.int32)], np.array([(4.0 * _PITCH, *_SCALE)]))


def _cluster() -> None:
    x, y = np.meshgrid(np.arange(20) * _PITCH, np.arange(20) * _PITCH)
    xyz = np.stack((x, y, np.full(x.shape, 0.02)), axis=-1).reshape(-1, 3).astype(np.float32)
    runs = np.array(((0, 0, len(xyz), 0),), dtype=np.int32)
    flat_cloud(ObjectPoints(xyz, runs, np.zeros((1, 4)), 0), SegmentationParameters(), _PITCH)


# What helper processes begin with: the parts of the warm-up that take longest to compile and come last, each by itself,
# so that none waits for what another process is about to compile.
STEPS: tuple[Callable[[], None], ...] = (_see_image, _cut, _outline, _cluster, _seldom, _see_points)


def _ring_of_an_l() -> FloatArray:
    """(m, 2) rim of an L of two blocks, counter-clockwise [m]."""
    corners = np.array(((0.0, 0.0), (0.05, 0.0), (0.05, 0.02), (0.02, 0.02), (0.02, 0.05), (0.0, 0.05)))
    ends = np.roll(corners, -1, axis=0)
    counts = np.rint(np.abs(ends - corners).sum(axis=1) / _PITCH).astype(int)
    edges = [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(corners, ends, counts, strict=True)]
    return np.concatenate(edges)


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
