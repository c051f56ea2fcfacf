"""PCD files (Point Cloud Library, versions 0.6 and 0.7): ascii, binary, binary_compressed, image order kept.

Why not Open3D: its reader flattens organized clouds and reads float64 coordinates as zeros without a word (0.20).
"""

import struct
from collections.abc import Mapping
from dataclasses import dataclass
from io import BufferedReader
from pathlib import Path

import numpy as np

from singulation_core import InvalidInputError
from singulation_perception.clouds import RecordedCloud
from singulation_perception.lzf import decompress_lzf
from singulation_perception.point_records import (
    MOST_BYTES,
    Column,
    Records,
    bad_file,
    cloud_of_records,
    record_type,
    records_from_bytes,
    records_from_text,
)

_LONGEST_HEADER = 64 * 1024
_KINDS = {"I": "i", "U": "u", "F": "f"}


@dataclass(frozen=True, slots=True)
class _Header:
    columns: tuple[Column, ...]
    width: int
    height: int
    data: str


def read_pcd(path: Path) -> RecordedCloud:
    """The cloud of a PCD file with all its fields.

    Raises:
        SingulationError: ``BAD_FILE`` with what is wrong and where.
        OSError: the file cannot be opened.
    """
    with path.open("rb") as file:
        header = _read_header(file, path)
        body = file.read()
    record, count = record_type(header.columns), header.width * header.height
    if header.data == "ascii":
        records = records_from_text(body, record, count, path)
    elif header.data == "binary":
        records = records_from_bytes(body, record, count, path)
    else:
        records = _compressed(body, header.columns, count, path)
    return cloud_of_records(records, header.columns, header.height, header.width, path)


def _read_header(file: BufferedReader, path: Path) -> _Header:
    entries: dict[str, list[str]] = {}
    while "DATA" not in entries:
        line = file.readline(_LONGEST_HEADER)
        if not line or file.tell() > _LONGEST_HEADER:
            raise bad_file(path, "no DATA line: not a PCD file, or cut off within its header")
        words = line.decode("ascii", errors="replace").split()
        if words and not words[0].startswith("#"):
            entries[words[0]] = words[1:]
    try:
        return _header(entries)
    except KeyError as error:
        raise bad_file(path, f"header: no usable {error.args[0]!r}") from None
    except (ValueError, IndexError) as error:
        raise bad_file(path, f"header: {error}") from None


def _header(entries: Mapping[str, list[str]]) -> _Header:
    width, height = int(entries["WIDTH"][0]), int(entries["HEIGHT"][0])
    points = int(entries["POINTS"][0]) if "POINTS" in entries else width * height
    if not (width > 0 and height > 0 and points == width * height):
        raise ValueError(f"WIDTH {width}, HEIGHT {height} and POINTS {points} contradict each other")
    columns = _columns(entries)
    size = points * record_type(columns).itemsize
    if not (size <= MOST_BYTES):
        raise ValueError(f"{width} x {height} points would be {size} bytes; at most {MOST_BYTES} are read")
    data = entries["DATA"][0]
    if data not in ("ascii", "binary", "binary_compressed"):
        raise ValueError(f"DATA {data!r}, need ascii, binary or binary_compressed")
    return _Header(columns, width, height, data)


def _columns(entries: Mapping[str, list[str]]) -> tuple[Column, ...]:
    names, types, sizes = entries["FIELDS"], entries["TYPE"], entries["SIZE"]
    counts = [int(word) for word in entries.get("COUNT", ["1"] * len(names))]
    if not (len(names) == len(types) == len(sizes) == len(counts) > 0):
        raise ValueError(f"{len(names)} FIELDS, {len(sizes)} SIZE, {len(types)} TYPE, {len(counts)} COUNT do not match")
    columns = []
    for name, kind, size, count in zip(names, types, sizes, counts, strict=True):
        known = ("1", "2", "4", "8") if kind != "F" else ("4", "8")
        if kind not in _KINDS or size not in known or not (0 < count <= 65536):
            raise ValueError(f"field {name!r} with TYPE {kind}, SIZE {size}, COUNT {count} is not PCD")
        columns.append(Column(name, _KINDS[kind] + size, count))
    return tuple(columns)


def _compressed(body: bytes, columns: tuple[Column, ...], count: int, path: Path) -> Records:
    """Records from the column-wise LZF stream: two uint32 sizes, then the packed bytes."""
    record = record_type(columns)
    if len(body) < 8:
        raise bad_file(path, f"cut off: {len(body)} bytes after the header")
    packed_size, size = struct.unpack_from("<II", body)
    if size != count * record.itemsize:
        raise bad_file(path, f"holds {size} bytes uncompressed, but its header announces {count * record.itemsize}")
    if len(body) - 8 < packed_size:
        raise bad_file(path, f"cut off: {packed_size} compressed bytes were announced, {len(body) - 8} are there")
    try:
        values = decompress_lzf(np.frombuffer(body, np.uint8, packed_size, 8), size)
    except InvalidInputError as error:
        raise bad_file(path, error.message) from None
    records = np.empty(count, dtype=record)
    start = 0
    for place, column in enumerate(columns):
        end = start + count * column.count * int(column.kind[1])
        records[str(place)] = values[start:end].view("<" + column.kind).reshape(count, column.count)
        start = end
    return records
