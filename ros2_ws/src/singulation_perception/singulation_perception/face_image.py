"""One face as a little image, and where a place on the table lies in it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.object_points import IntArray


class FaceImage(NamedTuple):
    """A face; a named tuple, because compiled code takes it.

    Args:
        corner: (2,) row and column in the cloud of the first pixel.
        point: (rows, columns) number of the point at each pixel, -1 where the face has none.
        xyz: (n, 3) all points in ``table`` [m].
        to_pixel: (2, 3) affine map from x, y, 1 to row and column; over one block a perspective view is affine to a
            fraction of a pixel.
    """

    corner: IntArray
    point: IntArray
    xyz: NDArray[np.float32]
    to_pixel: FloatArray

    def pixels(self, places: FloatArray) -> IntArray:
        """(m, 2) rows and columns in the cloud of (m, 2) places on the table."""
        inside = places @ self.to_pixel[:, :2].T + self.to_pixel[:, 2]
        return np.asarray(np.rint(inside).astype(np.int32) + self.corner)


def face_image(
    point: IntArray, corner: IntArray, xyz: NDArray[np.float32], ring: FloatArray, pixels: IntArray
) -> FaceImage:
    """The image of a face, with the affine map fitted to its rim.

    Args:
        point: (rows, columns) numbers of its points.
        corner: (2,) row and column in the cloud of its first pixel.
        xyz: (n, 3) all points [m].
        ring: (m, 2) rim [m].
        pixels: (m, 2) rows and columns of the rim in the cloud.
    """
    middle = ring.mean(axis=0)
    places, seen = ring - middle, (pixels - corner).astype(np.float64)
    (xx, xy), (_, yy) = (places.T @ places).tolist()
    determinant = xx * yy - xy * xy  # least squares by hand: LAPACK's set-up takes longer than all the rest
    turn = (places.T @ seen).T @ np.array(((yy, -xy), (-xy, xx))) / max(determinant, 1e-30)
    to_pixel = np.column_stack((turn, seen.mean(axis=0) - turn @ middle))
    return FaceImage(corner, point, xyz, to_pixel)


def to_table(image: FaceImage) -> FloatArray:
    """(2, 3) affine map from row, column, 1 back to x and y.

    Raises:
        numpy.linalg.LinAlgError: the rim lies on one line.
    """
    inverse = np.linalg.inv(image.to_pixel[:, :2])
    return np.column_stack((inverse, -inverse @ image.to_pixel[:, 2]))
