"""One face as a little image, and where a place on the table lies in it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.jit import compiled_maker
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
    return FaceImage(corner, point, xyz, _fitted_map(ring, pixels, corner))


@compiled_maker
def _fitted_map(ring: FloatArray, pixels: IntArray, corner: IntArray) -> FloatArray:
    """Least squares (2, 3): from places to rows and columns of the image."""
    count = max(len(ring), 1)
    x, y, row, column = 0.0, 0.0, 0.0, 0.0
    for i in range(len(ring)):
        x, y = x + ring[i, 0], y + ring[i, 1]
        row, column = row + pixels[i, 0] - corner[0], column + pixels[i, 1] - corner[1]
    x, y, row, column = x / count, y / count, row / count, column / count
    xx, xy, yy = 0.0, 0.0, 0.0
    xr, yr, xc, yc = 0.0, 0.0, 0.0, 0.0
    for i in range(len(ring)):
        dx, dy = ring[i, 0] - x, ring[i, 1] - y
        down, right = pixels[i, 0] - corner[0] - row, pixels[i, 1] - corner[1] - column
        xx, xy, yy = xx + dx * dx, xy + dx * dy, yy + dy * dy
        xr, yr, xc, yc = xr + dx * down, yr + dy * down, xc + dx * right, yc + dy * right
    determinant = max(xx * yy - xy * xy, 1e-30)
    to_pixel = np.empty((2, 3))
    to_pixel[0, 0], to_pixel[0, 1] = (xr * yy - yr * xy) / determinant, (yr * xx - xr * xy) / determinant
    to_pixel[1, 0], to_pixel[1, 1] = (xc * yy - yc * xy) / determinant, (yc * xx - xc * xy) / determinant
    to_pixel[0, 2] = row - to_pixel[0, 0] * x - to_pixel[0, 1] * y
    to_pixel[1, 2] = column - to_pixel[1, 0] * x - to_pixel[1, 1] * y
    return to_pixel


def to_table(image: FaceImage) -> FloatArray:
    """(2, 3) affine map from row, column, 1 back to x and y; without meaning if the rim lies on one line."""
    (a, b, row), (c, d, column) = image.to_pixel.tolist()
    determinant = a * d - b * c or np.inf  # by hand: LAPACK's set-up takes longer than all the rest
    inverse = np.array(((d, -b), (-c, a))) / determinant
    return np.column_stack((inverse, -inverse @ (row, column)))
