"""How the bytes of a point cloud are laid out: the content of a sensor_msgs/PointCloud2 without the message."""

from array import array
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

CloudData = bytes | bytearray | memoryview | array | NDArray[np.uint8]  # type: ignore[type-arg]


class ScalarType(IntEnum):
    """Values are those of ``sensor_msgs/msg/PointField``."""

    INT8 = 1
    UINT8 = 2
    INT16 = 3
    UINT16 = 4
    INT32 = 5
    UINT32 = 6
    FLOAT32 = 7
    FLOAT64 = 8


@dataclass(frozen=True, slots=True)
class CloudField:
    """One named number of every point; ``offset`` [bytes] from the start of the point."""

    name: str
    offset: int
    datatype: int = ScalarType.FLOAT32
    count: int = 1


@dataclass(frozen=True, slots=True)
class CloudLayout:
    """Where the numbers of a cloud stand in its bytes. Not checked here: ``decode_points`` does.

    Args:
        height: rows of the image, 1 for a cloud without image order.
        width: points in a row.
        point_step: bytes from a point to the next.
        row_step: bytes from a row to the next; more than ``width * point_step`` if rows are padded.
        fields: in any order, with gaps where the sender likes them.
        is_bigendian: byte order of the numbers.
    """

    height: int
    width: int
    point_step: int
    row_step: int
    fields: tuple[CloudField, ...]
    is_bigendian: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class RecordedCloud:
    """A cloud as it comes from a bag or a file.

    Args:
        layout: of ``data``.
        data: the bytes; may be a view of a larger buffer.
        frame: coordinate frame, empty if the source names none.
        stamp: of the measurement [ns], 0 if the source has none.
        recorded: when the bag received it [ns], 0 for a file.
        source: for texts: file, or bag and topic and number.
    """

    layout: CloudLayout
    data: CloudData
    frame: str = ""
    stamp: int = 0
    recorded: int = 0
    source: str = ""
