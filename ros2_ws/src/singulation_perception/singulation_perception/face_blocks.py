"""From one face to the blocks in it: seams that are seen, hidden parts, cuts that the outline suggests, outlines."""

from dataclasses import dataclass
from functools import cached_property
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.boundaries import FaceMaps
from singulation_perception.confidence import Evidence
from singulation_perception.cutting import PER_AREA
from singulation_perception.face_image import FaceImage, face_image
from singulation_perception.face_rings import FaceRings
from singulation_perception.found_block import FoundBlock, shares
from singulation_perception.hidden import View, without_hidden
from singulation_perception.object_points import IntArray, ObjectPoints
from singulation_perception.outlines import Outlines, outlines_of
from singulation_perception.parameters import SegmentationParameters
from singulation_perception.rings import Scale
from singulation_perception.shapes import Shape
from singulation_perception.splitting import Split, Suspects, split, split_seen
from singulation_perception.surfaces import Faces

_TOLERANCE_IN_PITCHES = 4.0
_BORDER = 2  # pixels and pitches
_POCKET = 0.008  # [m] cost of a pocket from which on it is a doubt; the end of a shadow bites up to that much off a rim
_UNKNOWN = np.empty(0, dtype=np.int32)  # hull
_BESIDE = 4.0  # pitches between a seam's middle and the rim of a piece beside it


@dataclass(frozen=True, eq=False)
class _Piece:
    """Part of a face that may be a block: number of the face's image, (m, 2) rim [m], corners of its hull if it is
    convex, lead of the most doubtful seam beside it [m], whether one of its seams ends where nothing shows it.
    """

    face: int
    ring: FloatArray
    hull: IntArray
    lead: float = np.inf
    loose: bool = False


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

    def found(self, suspects: dict[int, Suspects], dropped: dict[str, int]) -> list[FoundBlock]:
        """Blocks of all faces; counts what is none in ``dropped``.

        Args:
            suspects: what to look for in some faces.
            dropped: by reason.
        """
        slivers = self._slivers()
        dropped["sliver"] += sum(slivers)
        pieces = [piece for k, sliver in enumerate(slivers) if not sliver for piece in self._pieces(k, suspects.get(k))]
        face = np.array([piece.face for piece in pieces], dtype=np.int32)
        rings, hulls = [piece.ring for piece in pieces], [piece.hull for piece in pieces]
        outlines = outlines_of(rings, hulls, self._measures()[face])
        confidence = self._evidence(face, pieces, outlines).confidence.tolist()
        found: list[FoundBlock] = []
        for k, members in groupby(zip(pieces, outlines.drawn(), confidence, strict=True), lambda one: one[0].face):
            blocks = self._blocks(k, [(*drawn, trust) for _, drawn, trust in members if drawn])
            dropped["shapeless"] += not blocks
            found += blocks
        return found

    def pitch(self, k: int) -> float:
        """Distance of neighbouring points on face k [m]."""
        return float(self.rings.pitch[k])

    def image(self, k: int) -> FaceImage:
        """Face k as an image, with the map from the table into it."""
        pixels = self.rings.pixels[self.rings.begin[k] : self.rings.begin[k + 1]]
        return face_image(self.maps.image(k), self.maps.box[k, :2], self.seen.xyz, self.rings.ring(k), pixels)

    def _slivers(self) -> list[bool]:
        """Which faces are too narrow for a block: a wall seen from above, or what the crop left of something."""
        least = self.parameters.min_width
        wide = self.rings.width + 2.0 * self.parameters.edge_growth * self.rings.pitch >= least
        return [not good for good in (wide & (self.rings.thickness >= 0.5 * least)).tolist()]

    def _scale(self, k: int) -> Scale:
        pitch = self.pitch(k)
        return Scale(pitch, self.parameters.edge_growth * pitch, float(self.rings.roughness[k]))

    def _measures(self) -> FloatArray:
        """(k, 4) tolerance of Douglas-Peucker and scale of each face [m]."""
        pitch, roughness = self.rings.pitch, self.rings.roughness
        measures = np.empty((len(pitch), 4))
        measures[:, 0] = self.parameters.outline_tolerance or np.maximum(_TOLERANCE_IN_PITCHES * pitch, roughness)
        measures[:, 1], measures[:, 2], measures[:, 3] = pitch, self.parameters.edge_growth * pitch, roughness
        return measures

    def _blocks(self, k: int, parts: list[tuple[FloatArray, Shape, float]]) -> list[FoundBlock]:
        """Blocks of face k, by outline, shape and confidence of its parts; none if its rim gives no polygon."""
        count, height, surface = self._whole[k]
        if len(parts) == 1:
            outline, shape, confidence = parts[0]
            return [FoundBlock(outline, shape, height, count, confidence, surface, k)]
        shared = self._shares(k, [outline for outline, _, _ in parts]) if parts else []
        return [
            FoundBlock(outline, shape, height, count, confidence, surface, k)
            for (outline, shape, confidence), (count, height) in zip(parts, shared, strict=True)
        ]

    @cached_property
    def _whole(self) -> list[tuple[int, float, int]]:
        """Points, height [m] and surface of each face."""
        faces = self.maps.faces
        heights = np.maximum(self.faces.height[faces], 0.0).tolist()
        return list(zip(self.faces.count[faces].tolist(), heights, self.faces.surface[faces].tolist(), strict=True))

    def _pieces(self, k: int, suspects: Suspects | None) -> list[_Piece]:
        """The parts of one face that may be blocks."""
        ring, cutting = self.rings.ring(k), self.parameters.split_touching
        concave = bool(self.rings.concave[k] > 0.0)
        looking = suspects if cutting else None
        if not concave and looking is None:
            return [_Piece(k, ring, self.rings.hull(k))]
        scale, image = self._scale(k), self.image(k)
        height = float(self.faces.height[self.maps.faces[k]])
        pieces: list[_Piece] = []
        for part in (ring,) if looking is None else split_seen(ring, scale, image, looking):
            if part is ring and not concave:
                pieces.append(_Piece(k, ring, self.rings.hull(k)))
                continue
            whole = without_hidden(part, image.pixels(part), scale.roughness, self.view, height)
            result = split(whole, scale, image, self.noise) if cutting else Split(0.0, (whole,))
            pieces += [_Piece(k, piece, _UNKNOWN, *_doubts(piece, result, scale)) for piece in result.pieces]
        return pieces

    def _shares(self, k: int, outlines: list[FloatArray]) -> list[tuple[int, float]]:
        """Points and height of each of several parts of face k."""
        counts, heights = shares(self.maps.image(k), self.seen.xyz, outlines)
        return list(zip(counts.tolist(), np.maximum(heights, 0.0).tolist(), strict=True))

    def _evidence(self, k: IntArray, pieces: list[_Piece], outlines: Outlines) -> Evidence:
        """For the outlines of all pieces, which are parts of faces ``k``."""
        face = self.maps.faces[k]
        count, holes = self.faces.count[face], self.faces.holes[face]
        whole = ~(self.rings.concave[k] > 0.0)
        return Evidence(
            supported=outlines.supported,
            filled=np.where(whole, count / np.maximum(count + holes, 1), 1.0),
            flat=self.faces.flat[face],
            concave=~whole & (outlines.concave * PER_AREA >= _POCKET),
            truncated=self._at_border(k, outlines.box),
            lead=np.array([piece.lead for piece in pieces]),
            loose=np.array([piece.loose for piece in pieces], dtype=bool),
        )

    def _at_border(self, k: IntArray, box: FloatArray) -> NDArray[np.bool_]:
        """Which outlines, by their boxes, end at the border of the workspace or of the image; they are of faces k."""
        at_border = np.zeros(len(k), dtype=bool)
        if self.parameters.workspace is not None:
            inwards = np.array((1.0, -1.0, 1.0, -1.0))
            inside = (box - self.parameters.workspace) * inwards > _BORDER * self.rings.pitch[k, np.newaxis]
            at_border |= ~inside.all(axis=1)
        if self.view.cloud is not None:
            top, bottom, left, right = self.faces.box[self.maps.faces[k]].T
            rows, columns = self.view.cloud.height, self.view.cloud.width
            at_border |= np.minimum(top, left) < _BORDER
            at_border |= (bottom > rows - _BORDER) | (right > columns - _BORDER)
        return at_border


def _doubts(piece: FloatArray, result: Split, scale: Scale) -> tuple[float, bool]:
    """Least lead of the cuts beside a piece [m], infinite if there are none, and whether one of them is loose."""
    least, any_loose = np.inf, False
    for cut, rival, loose in zip(result.cuts, result.rivals, result.loose, strict=True):
        middle = cut.mean(axis=0)
        if float(np.hypot(*(piece - middle).T).min()) < _BESIDE * scale.pitch:
            least, any_loose = min(least, rival), any_loose or loose
    return float(least), any_loose
