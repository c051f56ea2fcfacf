"""From surfaces to blocks."""

from dataclasses import dataclass
from statistics import median

import numpy as np

from singulation_core import PlanarObject
from singulation_perception.boundaries import face_maps, rims
from singulation_perception.confidence import FEWEST_TO_COMPARE, FLUSH, UNUSUAL_LENGTH
from singulation_perception.face_blocks import FaceBlocks
from singulation_perception.face_rings import face_rings
from singulation_perception.found_block import FoundBlock
from singulation_perception.hidden import View
from singulation_perception.hidden_corners import with_hidden_corners
from singulation_perception.object_points import IntArray, ObjectPoints
from singulation_perception.parameters import SegmentationParameters
from singulation_perception.piles import settled
from singulation_perception.splitting import Suspects
from singulation_perception.surfaces import Faces, Surfaces, faces_of

_BAND_IN_NOISE, _LEAST_BAND = 4.0, 0.0008
_APART_IN_NOISE = 5.5
_GROOVE = 0.12  # missing points beyond the usual, in widths of a face, that may be a groove
_UNEVEN = 1.3  # scatter of heights, in noise, that may be a step


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
        noise: of the heights [m].
        view: of the camera.
    """
    band = max(_BAND_IN_NOISE * noise, _LEAST_BAND)
    faces = faces_of(seen, surfaces, band, _APART_IN_NOISE * noise, parameters.max_height, parameters.min_size)
    dropped = _dropped(faces, surfaces, parameters)
    right_size = (faces.count >= parameters.min_size) & (faces.count <= parameters.max_size)
    chosen = np.flatnonzero(right_size).astype(np.int32)
    maps = face_maps(faces, chosen)
    rings = face_rings(seen.xyz, *rims(maps), faces.count[chosen], noise, view.camera)
    every = FaceBlocks(seen, faces, maps, rings, view, parameters, noise)
    found = every.found(_suspects(faces, chosen, noise), dropped)
    found = with_hidden_corners(found, every, band)
    found, dropped["stacked"] = settled(_with_size_doubts(found, parameters.max_extent), band)
    objects = [one.planar_object(i) for i, one in enumerate(found)]
    return Blocks(objects, [one.surface for one in found], surfaces, dropped)


def _dropped(faces: Faces, surfaces: Surfaces, parameters: SegmentationParameters) -> dict[str, int]:
    tall = surfaces.top > parameters.max_height
    enough = surfaces.count >= parameters.min_size
    return {
        "small": int(surfaces.count[~enough & ~tall].sum()),
        "large": int(np.count_nonzero(faces.count > parameters.max_size)),
        "tall": int(np.count_nonzero(tall & enough)),
        "sliver": 0,
        "shapeless": 0,
    }


def _suspects(faces: Faces, chosen: IntArray, noise: float) -> dict[int, Suspects]:
    """Those of the chosen faces that miss more points, or scatter more, than the others."""
    if len(chosen) == 0:
        return {}
    count, holes = faces.count[chosen], faces.holes[chosen]
    usual = median((holes / np.maximum(count, 1)).tolist()) * count
    grooved = holes - usual - 3.0 * np.sqrt(usual) > _GROOVE * np.sqrt(count)
    uneven = faces.scatter[chosen] > _UNEVEN * noise
    return {k: Suspects(bool(grooved[k]), bool(uneven[k]), noise) for k in np.flatnonzero(grooved | uneven).tolist()}


def _with_size_doubts(blocks: list[FoundBlock], max_extent: float | None) -> list[FoundBlock]:
    """Doubts blocks that are so large that they may be several, flush along a whole edge."""
    if max_extent is not None:
        large = [2.0 * block.shape.radius > max_extent for block in blocks]
    elif len(blocks) >= FEWEST_TO_COMPARE:
        usual = median(block.shape.length for block in blocks)
        large = [block.shape.length > UNUSUAL_LENGTH * usual for block in blocks]
    else:
        return blocks
    return [block.doubted(FLUSH) if doubt else block for block, doubt in zip(blocks, large, strict=True)]
