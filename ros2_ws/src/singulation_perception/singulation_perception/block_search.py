"""From surfaces to blocks: top faces, their rims, splits, outlines."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from singulation_core import PlanarObject
from singulation_core.polygon import FloatArray
from singulation_perception.boundaries import face_maps, rims
from singulation_perception.face_rings import FaceRings, face_rings
from singulation_perception.hidden import without_hidden
from singulation_perception.object_points import ObjectPoints
from singulation_perception.outlines import outline_of
from singulation_perception.parameters import SegmentationParameters
from singulation_perception.rings import Scale
from singulation_perception.splitting import split
from singulation_perception.surfaces import Faces, Surfaces, faces_of

_BAND_IN_NOISE, _LEAST_BAND = 4.0, 0.0008
_TOLERANCE_IN_PITCHES = 4.0


@dataclass(frozen=True, eq=False)
class View:
    """The cloud as the camera sees it.

    Args:
        camera: (3,) its place in ``table`` [m].
        plane: (4,) of the table in the camera frame.
        cloud: (H, W, 3), camera frame, to tell hidden from empty; None if the cloud has no image order.
    """

    camera: FloatArray
    plane: FloatArray
    cloud: NDArray[np.float32] | None


@dataclass(frozen=True, eq=False)
class Blocks:
    """What was found.

    Args:
        objects: the blocks.
        surface: surface that each block belongs to, by its id.
        surfaces: all of them.
        dropped: what was left out, by reason.
    """

    objects: list[PlanarObject]
    surface: list[int]
    surfaces: Surfaces
    dropped: dict[str, int]


def blocks_of(
    seen: ObjectPoints,
    surfaces: Surfaces,
    parameters: SegmentationParameters,
    noise: float,
    view: View,
) -> Blocks:
    """Finds the blocks among the surfaces.

    Args:
        seen: the object points.
        surfaces: of them.
        parameters: of the segmentation.
        noise: of the cloud [m].
        view: of the camera.
    """
    band = max(_BAND_IN_NOISE * noise, _LEAST_BAND)
    faces = faces_of(seen, surfaces, band, parameters.max_height, parameters.min_size)
    tall = surfaces.top > parameters.max_height
    small = (surfaces.count < parameters.min_size) & ~tall
    right_size = (faces.count >= parameters.min_size) & (faces.count <= parameters.max_size)
    dropped = {
        "small": int(surfaces.count[small].sum()),
        "large": int((faces.count > parameters.max_size).sum()),
        "tall": int((tall & (surfaces.count >= parameters.min_size)).sum()),
        "sliver": 0,
        "shapeless": 0,
    }
    chosen = np.flatnonzero(right_size).astype(np.int32)
    maps = face_maps(faces, chosen)
    rings = face_rings(seen.xyz, *rims(maps), faces.count[chosen], noise, view.camera)
    found = Blocks([], [], surfaces, dropped)
    for k, face in enumerate(chosen):
        _add(found, faces, int(face), rings, k, parameters, view)
    return found


def _add(
    found: Blocks,
    faces: Faces,
    face: int,
    rings: FaceRings,
    k: int,
    parameters: SegmentationParameters,
    view: View,
) -> None:
    """Adds the blocks of one face."""
    pitch = float(rings.pitch[k])
    scale = Scale(pitch, parameters.edge_growth * pitch, float(rings.roughness[k]))
    if rings.width[k] + 2.0 * scale.growth < parameters.min_width or rings.thickness[k] < 0.5 * parameters.min_width:
        found.dropped["sliver"] += 1
        return
    ring = rings.ring(k)
    concave = bool(rings.concave[k] > 0.0)
    if concave and view.cloud is not None:
        pixels = rings.pixels[rings.begin[k] : rings.begin[k + 1]]
        ring, _ = without_hidden(ring, pixels, scale.roughness, view.cloud, view.plane, float(faces.height[face]))
    pieces = split(ring, scale).pieces if concave and parameters.split_touching else (ring,)
    tolerance = parameters.outline_tolerance or max(_TOLERANCE_IN_PITCHES * pitch, scale.roughness)
    for piece in pieces:
        outline = outline_of(piece, tolerance, scale)
        if outline is None:
            found.dropped["shapeless"] += 1
            continue
        item = PlanarObject(len(found.objects), outline, float(faces.height[face]), int(faces.count[face]))
        found.objects.append(item)
        found.surface.append(int(faces.surface[face]))
