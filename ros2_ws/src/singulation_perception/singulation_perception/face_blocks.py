"""From one face to the blocks in it: seams that are seen, hidden parts, cuts that the outline suggests, outlines."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.boundaries import FaceMaps
from singulation_perception.confidence import Evidence, supported_share
from singulation_perception.cutting import concave_cost
from singulation_perception.face_image import face_image
from singulation_perception.face_rings import FaceRings
from singulation_perception.found_block import FoundBlock, shares
from singulation_perception.hidden import View, without_hidden
from singulation_perception.object_points import IntArray, ObjectPoints
from singulation_perception.outlines import outline_of
from singulation_perception.parameters import SegmentationParameters
from singulation_perception.rings import Scale, hull_indices
from singulation_perception.splitting import CONVEX, Split, Suspects, split, split_seen
from singulation_perception.surfaces import Faces

_TOLERANCE_IN_PITCHES = 4.0
_BORDER = 2  # pixels and pitches
_BESIDE = 4.0  # pitches between a seam's middle and the rim of a piece beside it


@dataclass(frozen=True, eq=False)
class FaceBlocks:
    """Everything about the faces of a cloud that their blocks are made from.

    Args:
        seen: the object points.
        faces: all faces.
        maps: images of those of a right size.
        rings: rims of the same.
        view: of the camera.
        parameters: of the segmentation.
        noise: of the heights [m].
    """

    seen: ObjectPoints
    faces: Faces
    maps: FaceMaps
    rings: FaceRings
    view: View
    parameters: SegmentationParameters
    noise: float

    def scale(self, k: int) -> Scale:
        """Lengths that belong to face k."""
        pitch = float(self.rings.pitch[k])
        return Scale(pitch, self.parameters.edge_growth * pitch, float(self.rings.roughness[k]))

    def is_sliver(self, k: int) -> bool:
        """Whether face k is too narrow for a block: a wall seen from above, or what the crop left of something."""
        least = self.parameters.min_width
        wide = self.rings.width[k] + 2.0 * self.scale(k).growth >= least
        return not (wide and self.rings.thickness[k] >= 0.5 * least)

    def blocks(self, k: int, suspects: Suspects) -> list[FoundBlock]:
        """Blocks of face k; none if its rim gives no polygon."""
        scale = self.scale(k)
        tolerance = self.parameters.outline_tolerance or max(_TOLERANCE_IN_PITCHES * scale.pitch, scale.roughness)
        found = [
            (ring, lead, outline_of(ring, self._hull(k, ring), tolerance, scale))
            for ring, lead in self._rings(k, scale, suspects)
        ]
        good = [(ring, lead, outline) for ring, lead, outline in found if outline is not None]
        counts, heights = self._shares(k, [outline for _, _, outline in good])
        surface = int(self.faces.surface[self.maps.faces[k]])
        return [
            FoundBlock(
                outline, heights[i], counts[i], self._evidence(k, scale, ring, outline, lead).confidence, surface
            )
            for i, (ring, lead, outline) in enumerate(good)
        ]

    def _rings(self, k: int, scale: Scale, suspects: Suspects) -> Iterator[tuple[FloatArray, float]]:
        """Rims of the blocks of one face, and the lead of the most doubtful seam of each [m]."""
        ring = self.rings.ring(k)
        pixels = self.rings.pixels[self.rings.begin[k] : self.rings.begin[k + 1]]
        cutting = self.parameters.split_touching
        concave = bool(self.rings.concave[k] > 0.0)
        looking = cutting and (suspects.groove or suspects.step)
        if not (concave or looking):
            yield ring, np.inf
            return
        image = face_image(self.maps.image(k), self.maps.box[k, :2], self.seen.xyz, ring, pixels)
        height = float(self.faces.height[self.maps.faces[k]])
        for part in split_seen(ring, scale, image, suspects) if looking else (ring,):
            if part is ring and not concave:
                yield ring, np.inf
                continue
            whole = without_hidden(part, image.pixels(part), scale.roughness, self.view, height)
            result = split(whole, scale, image, self.noise) if cutting else Split(0.0, (whole,))
            yield from ((piece, _lead(piece, result, scale)) for piece in result.pieces)

    def _hull(self, k: int, ring: FloatArray) -> IntArray:
        """Corners of the hull of a ring; that of the face itself is known."""
        return self.rings.hull(k) if ring.base is self.rings.points else np.asarray(hull_indices(ring))

    def _shares(self, k: int, outlines: list[FloatArray]) -> tuple[list[int], list[float]]:
        face = self.maps.faces[k]
        if len(outlines) < 2:
            return [int(self.faces.count[face])], [max(0.0, float(self.faces.height[face]))]
        counts, heights = shares(self.maps.image(k), self.seen.xyz, outlines)
        return [int(count) for count in counts], [max(0.0, float(height)) for height in heights]

    def _evidence(self, k: int, scale: Scale, ring: FloatArray, outline: FloatArray, lead: float) -> Evidence:
        face = self.maps.faces[k]
        count, holes = float(self.faces.count[face]), float(self.faces.holes[face])
        concave = self.rings.concave[k] > 0.0 and concave_cost(ring, scale.roughness) >= CONVEX
        return Evidence(
            supported=float(supported_share(outline, ring, scale.roughness + scale.growth, scale.pitch)),
            filled=1.0 if self.rings.concave[k] > 0.0 else count / (count + holes),
            flat=bool(self.faces.flat[face]),
            concave=bool(concave),
            truncated=self._at_border(k, outline, scale.pitch),
            lead=lead,
        )

    def _at_border(self, k: int, outline: FloatArray, pitch: float) -> bool:
        limits = self.parameters.workspace
        if limits is not None:
            margin = _BORDER * pitch
            across, up = zip(*outline.tolist(), strict=True)
            inside = min(across) > limits[0] + margin and max(across) < limits[1] - margin
            if not (inside and min(up) > limits[2] + margin and max(up) < limits[3] - margin):
                return True
        if self.view.cloud is None:
            return False
        rows, columns = self.view.cloud.height, self.view.cloud.width
        top, bottom, left, right = self.faces.box[self.maps.faces[k]]
        return bool(min(top, left) < _BORDER or bottom > rows - _BORDER or right > columns - _BORDER)


def _lead(piece: FloatArray, result: Split, scale: Scale) -> float:
    """Least lead of the cuts beside a piece [m]; infinite if there are none."""
    least = np.inf
    for cut, rival in zip(result.cuts, result.rivals, strict=True):
        middle = cut.mean(axis=0)
        if float(np.hypot(*(piece - middle).T).min()) < _BESIDE * scale.pitch:
            least = min(least, rival)
    return float(least)
