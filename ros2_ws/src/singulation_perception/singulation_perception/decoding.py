"""Points out of the bytes of a cloud, copied once at most.

Three conventions for a missing point exist among PhoXi drivers (NaN, zeros, left out); all pass through here
unchanged, whatever ``is_dense`` claims, and are dropped where the points are used.
"""

import sys

import numpy as np
from numpy.typing import NDArray

from singulation_core import ResultCode, SingulationError
from singulation_perception.clouds import CloudData, CloudField, CloudLayout, ScalarType

Float32Array = NDArray[np.float32]

_FLOATS = {ScalarType.FLOAT32: "f4", ScalarType.FLOAT64: "f8"}


def decode_points(data: CloudData, layout: CloudLayout) -> Float32Array:
    """Coordinates of all points, missing ones included as they were sent.

    A view of ``data`` where x, y, z are neighbouring native float32 (every PhoXi driver); anything else is converted
    into a fresh array once.

    Returns:
        (H, W, 3) float32 for an organized cloud (height > 1), else (N, 3); any strides, maybe read-only.

    Raises:
        SingulationError: ``NO_POINTS`` for an empty cloud, ``BAD_LAYOUT`` with the field or the two numbers that
            contradict each other.
    """
    size = memoryview(data).nbytes
    _require_sizes(layout, size)
    columns = [_float_field(layout, name) for name in "xyz"]
    points = _neighbouring_view(data, layout, columns)
    if points is None:
        points = _converted(data, layout, columns)
    return points if layout.height > 1 else points[0]


def _require_sizes(layout: CloudLayout, size: int) -> None:
    height, width = layout.height, layout.width
    if height == 0 and width == 0 and size == 0:
        raise SingulationError(ResultCode.NO_POINTS, "the cloud is empty: height 0, width 0, no data")
    if not (height > 0 and width > 0):
        raise _bad(f"height {height}, width {width} with {size} bytes of data; both must be positive")
    if not (layout.point_step > 0):
        raise _bad(f"point_step {layout.point_step}, need more than 0")
    if not (layout.row_step >= width * layout.point_step):
        needed = width * layout.point_step
        raise _bad(f"row_step {layout.row_step} is less than width x point_step = {needed}")
    if size != layout.row_step * height:
        raise _bad(f"{size} bytes of data, but row_step x height = {layout.row_step * height}")


def _float_field(layout: CloudLayout, name: str) -> CloudField:
    found = [field for field in layout.fields if field.name == name]
    if len(found) != 1:
        names = [field.name for field in layout.fields]
        raise _bad(f"{len(found)} fields named {name!r}, need exactly one; there are {names}")
    field = found[0]
    if field.datatype not in _FLOATS:
        raise _bad(f"field {name!r} has datatype {field.datatype}, need FLOAT32 (7) or FLOAT64 (8)")
    if field.count != 1:
        raise _bad(f"field {name!r} has count {field.count}, need 1")
    end = field.offset + np.dtype(_FLOATS[ScalarType(field.datatype)]).itemsize
    if not (field.offset >= 0 and end <= layout.point_step):
        raise _bad(f"field {name!r} at bytes {field.offset}..{end} does not fit point_step {layout.point_step}")
    return field


def _neighbouring_view(data: CloudData, layout: CloudLayout, columns: list[CloudField]) -> Float32Array | None:
    """(H, W, 3) view of the data, or None if that would not be an aligned native float32 array."""
    x = columns[0]
    if layout.is_bigendian != (sys.byteorder == "big"):
        return None
    if any(field.datatype != ScalarType.FLOAT32 or field.offset != x.offset + 4 * i for i, field in enumerate(columns)):
        return None
    view = _strided(data, layout, x, (3,), (4,))
    return view if view.flags.aligned else None


def _converted(data: CloudData, layout: CloudLayout, columns: list[CloudField]) -> Float32Array:
    points = np.empty((layout.height, layout.width, 3), dtype=np.float32)
    with np.errstate(over="ignore", invalid="ignore"):  # a double beyond float32 becomes infinite: no valid point
        for axis, field in enumerate(columns):
            points[..., axis] = _strided(data, layout, field)
    return points


def _strided(
    data: CloudData,
    layout: CloudLayout,
    field: CloudField,
    shape: tuple[int, ...] = (),
    strides: tuple[int, ...] = (),
) -> NDArray[np.float32]:
    order = ">" if layout.is_bigendian else "<"
    return np.ndarray(
        (layout.height, layout.width, *shape),
        dtype=np.dtype(order + _FLOATS[ScalarType(field.datatype)]),
        buffer=memoryview(data).cast("B"),
        offset=field.offset,
        strides=(layout.row_step, layout.point_step, *strides),
    )


def _bad(text: str) -> SingulationError:
    return SingulationError(ResultCode.BAD_LAYOUT, f"point cloud: {text}")
