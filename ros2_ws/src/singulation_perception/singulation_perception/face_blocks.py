"""From one face to the blocks in it: seams that are seen, hidden parts, cuts that the outline suggests, outlines."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.boundaries import FaceMaps
from singulation_perception.confidence import Evidence
from singulation_perception.cutting import PER_AREA
from singulation_perception.face_image import face_image
from singulation_perception.face_rings import FaceRings
from singulation_perception.found_block import FoundBlock, shares
from singulation_perception.hidden import View, without_hidden
from singulation_perception.object_points import ObjectPoints
from singulation_perception.outlines import Outlines, outlines_of
from singulation_perception.parameters import SegmentationParameters
from singulation_perception.rings import Scale
from singulation_perception.splitting import CONVEX, Split, Suspects, split, split_seen
from singulation_perception.surfaces import Faces

_TOLERANCE_IN_PITCHES = 4.0
_BORDER = 2  # pixels and pitches
_BESIDE = 4.0  # pitches between a seam's middle and the rim of a piece beside it


@dataclass(frozen=True, eq=False)
class _Piece:
    """Part of a face that may be a block: number of the face's image, (m, 2) rim [m], lead of the most doubtful seam
    beside it [m].
    """

    face: int
    ring: FloatArray
    lead: float


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

    def found(self, suspects: list[Suspects], dropped: dict[str, int]) -> list[FoundBlock]:
        """Blocks of all faces; counts what is none in ``dropped``.

        Args:
            suspects: what to look for in each face.
            dropped: by reason.
        """
        slivers = self._slivers()
        dropped["sliver"] += sum(slivers)
        scales = [self._scale(k) for k in range(len(slivers))]
        pieces = [
            _Piece(k, ring, lead)
            for k, sliver in enumerate(slivers)
            if not sliver
            for ring, lead in self._rings(k, scales[k], suspects[k])
        ]
        measures = [(self._tolerance(scales[piece.face]), *scales[piece.face]) for piece in pieces]
        outlines = outlines_of([piece.ring for piece in pieces], measures)
        found: list[FoundBlock] = []
        for k, members in groupby(range(len(pieces)), lambda i: pieces[i].face):
            blocks = self._blocks(k, scales[k], [(pieces[i], i) for i in members], outlines)
            dropped["shapeless"] += not blocks
            found += blocks
        return found

    def _slivers(self) -> list[bool]:
        """Which faces are too narrow for a block: a wall seen from above, or what the crop left of something."""
        least = self.parameters.min_width
        wide = self.rings.width + 2.0 * self.parameters.edge_growth * self.rings.pitch >= least
        return [not good for good in (wide & (self.rings.thickness >= 0.5 * least)).tolist()]

    def _scale(self, k: int) -> Scale:
        pitch = float(self.rings.pitch[k])
        return Scale(pitch, self.parameters.edge_growth * pitch, float(self.rings.roughness[k]))

    def _tolerance(self, scale: Scale) -> float:
        return self.parameters.outline_tolerance or max(_TOLERANCE_IN_PITCHES * scale.pitch, scale.roughness)

    def _blocks(self, k: int, scale: Scale, members: list[tuple[_Piece, int]], outlines: Outlines) -> list[FoundBlock]:
        """Blocks of face k; none if its rim gives no polygon."""
        drawn = [(piece, i, outlines.outline(i)) for piece, i in members]
        good = [(piece, i, outline) for piece, i, outline in drawn if outline is not None]
        if not good:
            return []
        counts, heights = self._shares(k, [outline for _, _, outline in good])
        face = int(self.maps.faces[k])
        surface = int(self.faces.surface[face])
        blocks = []
        for (piece, i, outline), count, height in zip(good, counts, heights, strict=True):
            concave = float(outlines.concave[i]) * PER_AREA
            evidence = self._evidence(k, scale, outline, float(outlines.supported[i]), concave, piece.lead)
            blocks.append(FoundBlock(outline, height, count, evidence.confidence, surface))
        return blocks

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

    def _shares(self, k: int, outlines: list[FloatArray]) -> tuple[list[int], list[float]]:
        face = self.maps.faces[k]
        if len(outlines) < 2:
            return [int(self.faces.count[face])], [max(0.0, float(self.faces.height[face]))]
        counts, heights = shares(self.maps.image(k), self.seen.xyz, outlines)
        return [int(count) for count in counts], [max(0.0, float(height)) for height in heights]

    def _evidence(
        self, k: int, scale: Scale, outline: FloatArray, supported: float, concave: float, lead: float
    ) -> Evidence:
        face = self.maps.faces[k]
        count, holes = float(self.faces.count[face]), float(self.faces.holes[face])
        whole = not self.rings.concave[k] > 0.0
        return Evidence(
            supported=supported,
            filled=count / (count + holes) if whole else 1.0,
            flat=bool(self.faces.flat[face]),
            concave=not whole and concave >= CONVEX,
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
