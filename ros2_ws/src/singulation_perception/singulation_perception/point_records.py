"""Points as packed records: what PCD and PLY files have in common."""

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from singulation_core import ResultCode, SingulationError
from singulation_perception.clouds import CloudField, CloudLayout, RecordedCloud, ScalarType

Records = NDArray[np.void]

MOST_BYTES = 4 << 30  # a header that claims more points than this is damaged

_SCALAR_TYPES = {
    "i1": ScalarType.INT8,
    "u1": ScalarType.UINT8,
    "i2": ScalarType.INT16,
    "u2": ScalarType.UINT16,
    "i4": ScalarType.INT32,
    "u4": ScalarType.UINT32,
    "f4": ScalarType.FLOAT32,
    "f8": ScalarType.FLOAT64,
}


@dataclass(frozen=True, slots=True)
class Column:
    """A field of every point; ``kind`` as NumPy writes it: ``f4``, ``u1``."""

    name: str
    kind: str
    count: int = 1


def record_type(columns: Sequence[Column], order: str = "<") -> np.dtype[np.void]:
    """Packed record of the columns, named ``0``, ``1`` ...: names in files may repeat."""
    return np.dtype([(str(place), order + column.kind, (column.count,)) for place, column in enumerate(columns)])


def cloud_of_records(
    records: Records, columns: Sequence[Column], height: int, width: int, source: Path
) -> RecordedCloud:
    """The records (height * width,) as a cloud; what a PointField cannot express is left out of the fields."""
    fields = tuple(
        CloudField(column.name, int(records.dtype.fields[str(place)][1]), _SCALAR_TYPES[column.kind], column.count)
        for place, column in enumerate(columns)
        if column.kind in _SCALAR_TYPES and records.dtype.fields is not None
    )
    step = records.dtype.itemsize
    first = records.dtype.fields["0"][0] if records.dtype.fields else records.dtype
    layout = CloudLayout(height, width, step, step * width, fields, is_bigendian=first.base.str.startswith(">"))
    return RecordedCloud(layout, np.ascontiguousarray(records).view(np.uint8).reshape(-1), source=str(source))


def records_from_bytes(data: bytes, record: np.dtype[np.void], count: int, path: Path) -> Records:
    """``count`` records from the start of ``data``.

    Raises:
        SingulationError: ``BAD_FILE``, cut off.
    """
    needed = count * record.itemsize
    if len(data) < needed:
        raise bad_file(path, f"cut off: {count} points need {needed} bytes, only {len(data)} are there")
    return np.frombuffer(data, dtype=record, count=count)


def records_from_text(data: bytes, record: np.dtype[np.void], count: int, path: Path) -> Records:
    """``count`` records written as numbers with blanks between.

    Raises:
        SingulationError: ``BAD_FILE``, cut off or not numbers.
    """
    fields: Mapping[str, Any] = record.fields or {}
    widths = {name: int(np.prod(field[0].shape)) for name, field in fields.items()}
    columns = sum(widths.values())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # how NumPy reports text after the last number
        try:
            # Not with count: NumPy would fill up what is missing with whatever lies in memory.
            numbers = np.fromstring(data.decode("ascii", errors="replace"), sep=" ")
        except ValueError:
            numbers = np.empty(0)
    if len(numbers) < count * columns:
        raise bad_file(path, f"{count} points of {columns} numbers were announced, {len(numbers)} numbers can be read")
    table = numbers[: count * columns].reshape(count, columns)
    records = np.empty(count, dtype=record)
    column = 0
    for name, width in widths.items():
        with np.errstate(invalid="ignore", over="ignore"):
            records[name] = table[:, column : column + width]
        column += width
    return records


def bad_file(path: Path, text: str) -> SingulationError:
    """``BAD_FILE`` with the path in front."""
    return SingulationError(ResultCode.BAD_FILE, f"{path}: {text}")
