"""Compiling everything before the first cloud arrives."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.creases import groove_line
from singulation_perception.face_image import FaceImage, face_image
from singulation_perception.face_rings import face_rings
from singulation_perception.flat_clouds import flat_cloud
from singulation_perception.found_block import shares
from singulation_perception.hidden import View, without_hidden
from singulation_perception.hidden_corners import count_lower, shadowed_edge
from singulation_perception.object_points import ObjectPoints
from singulation_perception.outlines import outlines_of
from singulation_perception.parameters import SegmentationParameters
from singulation_perception.raster import raster_of
from singulation_perception.rings import Scale
from singulation_perception.segmentation import segment_cloud
from singulation_perception.shapes import meeting_pairs, shape_of, shared_area
from singulation_perception.splitting import split

_PITCH = 0.001
_SCALE = Scale(_PITCH, 0.5 * _PITCH, 3.0 * _PITCH)


def warm_up() -> None:
    """Segments a small made-up cloud in every way there is, so that the first real one is as fast as the second.

    With empty caches this compiles for half a minute; after that it takes about a second.
    """
    _cluster()  # first what no helper begins with on two cores: meanwhile it compiles the rest
    _seldom()
    _see_image()
    _see_points()


def _see_image() -> None:
    _ = segment_cloud(_every_kind_of_block()).labels


def _see_points() -> None:
    _ = segment_cloud(_every_kind_of_block().reshape(-1, 3)).labels


def _cut() -> None:
    ring = _ring_of_an_l()
    rim = np.column_stack((np.arange(len(ring)), ring / _PITCH)).astype(np.int32)
    xyz = np.column_stack((ring, np.full(len(ring), 0.02))).astype(np.float32)
    begin, count = np.array((0, len(ring)), dtype=np.int32), np.array((len(ring) ** 2 // 20,), dtype=np.int32)
    rings = face_rings(xyz, rim, begin, count, 0.1 * _PITCH, np.zeros(3))
    view = View(np.zeros(3), np.zeros(4), raster_of(np.ones((60, 60, 3), dtype=np.float32)))
    without_hidden(rings.ring(0), rings.pixels, _SCALE.roughness, view, 0.02)
    split(ring, _SCALE, _empty_image(), 0.1 * _PITCH)


def _outline() -> None:
    outlines_of([_ring_of_an_l()], [np.empty(0, dtype=np.int32)], np.array([(4.0 * _PITCH, *_SCALE)]))


def _cluster() -> None:
    x, y = np.meshgrid(np.arange(20) * _PITCH, np.arange(20) * _PITCH)
    xyz = np.stack((x, y, np.full(x.shape, 0.02)), axis=-1).reshape(-1, 3).astype(np.float32)
    runs = np.array(((0, 0, len(xyz), 0),), dtype=np.int32)
    flat_cloud(ObjectPoints(xyz, runs, np.zeros((1, 4)), 0), SegmentationParameters(), _PITCH)


def _seldom() -> None:
    """What not every cloud needs, or only at its end."""
    cloud, plane = raster_of(np.ones((2, 2, 3), dtype=np.float32)), np.zeros(4, dtype=np.float32)
    place, square = np.zeros(2), np.array(((0.0, 0.0), (0.02, 0.0), (0.02, 0.02), (0.0, 0.02)))
    image = _empty_image()
    count_lower(cloud, plane, image.to_pixel, image.corner, place, place, place, np.float32(0.0))
    shadowed_edge(square, square, _PITCH, _PITCH, 0)
    shape_of(square)
    shared_area(square, square)
    meeting_pairs(np.zeros((1, 5)), np.zeros(1), _PITCH)
    shares(image.point, image.xyz, [square, square])
    ring = _ring_of_an_l()
    face_image(image.point, image.corner, image.xyz, ring, (ring / _PITCH).astype(np.int32))
    image.point[10:50:39, 10:50] = image.point[10:50, 10:50:39] = 0
    groove_line(image, _PITCH)


# What helper processes begin with, each with another one: what comes last in the warm-up and takes longest to compile.
# Most functions, and the parts they are made of, belong to one step, so that hardly any process waits for another or
# compiles a part twice.
STEPS: tuple[Callable[[], None], ...] = (_cluster, _cut, _outline, _seldom, _see_image, _see_points)


def _empty_image() -> FaceImage:
    """A face without points."""
    return FaceImage(
        np.zeros(2, dtype=np.int32),
        np.full((60, 60), -1, dtype=np.int32),
        np.zeros((1, 3), dtype=np.float32),
        np.array(((0.0, 1.0 / _PITCH, 0.0), (1.0 / _PITCH, 0.0, 0.0))),
    )


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
