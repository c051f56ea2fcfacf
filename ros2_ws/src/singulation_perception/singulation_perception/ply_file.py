"""PLY files: ascii and binary of either byte order; the points of the element ``vertex``.

PLY has no image order. Sensor software that keeps it writes ``num_cols`` and ``num_rows`` as comments or obj_info;
they are believed when their product is the number of points.
"""

import re
from dataclasses import dataclass
from io import BufferedReader
from pathlib import Path

from singulation_perception.clouds import RecordedCloud
from singulation_perception.point_records import (
    MOST_BYTES,
    Column,
    bad_file,
    cloud_of_records,
    record_type,
    records_from_bytes,
    records_from_text,
)

_LONGEST_HEADER = 64 * 1024
_KINDS = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
_ORDERS = {"ascii": "=", "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass(frozen=True, slots=True)
class _Header:
    form: str
    columns: tuple[Column, ...]
    count: int
    height: int
    width: int


def read_ply(path: Path) -> RecordedCloud:
    """The vertices of a PLY file with all their scalar properties.

    Raises:
        SingulationError: ``BAD_FILE`` with what is wrong and where.
        OSError: the file cannot be opened.
    """
    with path.open("rb") as file:
        header = _read_header(file, path)
        body = file.read()
    record = record_type(header.columns, _ORDERS[header.form])
    if not (header.count * record.itemsize <= MOST_BYTES):
        raise bad_file(path, f"header: {header.count} vertices would be more than {MOST_BYTES} bytes")
    read = records_from_text if header.form == "ascii" else records_from_bytes
    return cloud_of_records(read(body, record, header.count, path), header.columns, header.height, header.width, path)


def _read_header(file: BufferedReader, path: Path) -> _Header:
    if file.readline(8).strip() != b"ply":
        raise bad_file(path, "does not begin with 'ply': not a PLY file")
    lines: list[str] = []
    while not lines or lines[-1] != "end_header":
        line = file.readline(_LONGEST_HEADER)
        if not line or file.tell() > _LONGEST_HEADER:
            raise bad_file(path, "no end_header: not a PLY file, or cut off within its header")
        lines.append(line.decode("ascii", errors="replace").strip())
    try:
        return _header(lines)
    except (ValueError, IndexError, KeyError) as error:
        raise bad_file(path, f"header: {error.args[0] if error.args else error!r}") from None


def _header(lines: list[str]) -> _Header:
    form = next((line.split()[1] for line in lines if line.startswith("format ")), "none")
    if form not in _ORDERS:
        raise ValueError(f"format {form!r}, need one of {sorted(_ORDERS)}")
    count = _vertex_count(lines)
    height, width = _image_size(lines, count)
    return _Header(form, _vertex_columns(lines), count, height, width)


def _vertex_count(lines: list[str]) -> int:
    elements = [line.split() for line in lines if line.startswith("element ")]
    names = [words[1] for words in elements]
    if not names or names[0] != "vertex":
        raise ValueError(f"the first element must be 'vertex'; the elements are {names}")
    count = int(elements[0][2])
    if not (count > 0):
        raise ValueError(f"{count} vertices, need at least 1")
    return count


def _vertex_columns(lines: list[str]) -> tuple[Column, ...]:
    start = next(place for place, line in enumerate(lines) if line.startswith("element vertex"))
    columns = []
    for line in lines[start + 1 :]:
        words = line.split()
        if words and words[0] in ("element", "end_header"):
            break
        if words and words[0] == "property":
            if words[1] not in _KINDS:
                raise ValueError(f"vertex property {' '.join(words[1:])!r} is not a number")
            columns.append(Column(words[2], _KINDS[words[1]]))
    if not columns:
        raise ValueError("the vertices have no properties")
    return tuple(columns)


def _image_size(lines: list[str], count: int) -> tuple[int, int]:
    """(height, width); (1, count) if the file does not state a size that fits."""
    text = "\n".join(line for line in lines if line.startswith(("comment", "obj_info")))
    columns = re.search(r"\b(?:num_cols|width)\s*[=:]?\s*(\d+)", text, re.IGNORECASE)
    rows = re.search(r"\b(?:num_rows|height)\s*[=:]?\s*(\d+)", text, re.IGNORECASE)
    if columns and rows and int(columns[1]) * int(rows[1]) == count:
        return int(rows[1]), int(columns[1])
    return 1, count
