"""The cell file: where table, camera and workspace are, as every node reads it."""

import math
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import yaml  # type: ignore[import-untyped]  # no types are published with it

from singulation_bringup.yaml_values import yaml_value
from singulation_core import CellGeometry, InvalidInputError
from singulation_core.polygon import FloatArray
from singulation_core.transforms import quaternion_of

_SIZES = {"table_position": 3, "table_quaternion": 4, "workspace": 4, "camera_position": 3, "camera_quaternion": 4}
_TEXTS = {
    "table_position": "Origin of the frame table in yumi_body, x, y, z [m]; z = 0 of table is the surface.",
    "table_quaternion": "Orientation of table in yumi_body, x, y, z, w.",
    "workspace": "Where blocks may lie and pushes may go, x_min, x_max, y_min, y_max in table [m].",
    "camera_position": "Camera (optical frame: x right, y down, z forward) in table, x, y, z [m].",
    "camera_quaternion": "Orientation of the camera in table, x, y, z, w.",
}


def read_cell_file(path: Path) -> CellGeometry:
    """The places of a cell file; what it does not say is as in the simulated cell.

    Raises:
        InvalidInputError: not a parameter file, or values that are no poses.
    """
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise InvalidInputError(f"{path}: {error}") from None
    given = _parameters(content, path)
    values = {name: _numbers(path, name, given[name]) for name in _SIZES if name in given}
    cell = CellGeometry(**values)  # type: ignore[arg-type]  # sizes are checked above
    x_min, x_max, y_min, y_max = cell.workspace
    if not (x_min < x_max and y_min < y_max):
        raise InvalidInputError(f"{path}: workspace {cell.workspace}, need x_min < x_max, y_min < y_max")
    for pose in (cell.body_from_table, cell.table_from_camera):
        assert pose.shape == (4, 4)  # building them has checked the quaternions
    return cell


def cell_with(cell: CellGeometry, body_from_table: FloatArray, table_from_camera: FloatArray) -> CellGeometry:
    """The cell with other poses; lengths to a micrometre, which is more than anybody can measure."""
    return CellGeometry(
        _rounded(body_from_table[:3, 3], 6),
        _rounded(quaternion_of(body_from_table), 9),
        cell.workspace,
        _rounded(table_from_camera[:3, 3], 6),
        _rounded(quaternion_of(table_from_camera), 9),
    )


def cell_file_text(cell: CellGeometry, remarks: list[str]) -> str:
    """A cell file with remarks at its head."""
    lines = [f"# {line}".rstrip() for remark in remarks for line in remark.splitlines()]
    lines += ["/**:", "  ros__parameters:"]
    for item in fields(cell):
        lines += [f"    # {_TEXTS[item.name]}", f"    {item.name}: {yaml_value(getattr(cell, item.name))}"]
    return "\n".join(lines) + "\n"


def _parameters(content: Any, path: Path) -> dict[str, Any]:
    try:
        found = content["/**"]["ros__parameters"]
    except (TypeError, KeyError):
        found = None
    if not isinstance(found, dict):
        raise InvalidInputError(f"{path}: need the entries /**: and ros__parameters:, as in cells/simulated.yaml")
    return found


def _numbers(path: Path, name: str, value: Any) -> tuple[float, ...]:
    size = _SIZES[name]
    if not (
        isinstance(value, list)
        and len(value) == size
        and all(isinstance(one, int | float) and math.isfinite(one) for one in value)
    ):
        raise InvalidInputError(f"{path}: {name} is {value!r}, need {size} numbers")
    return tuple(float(one) for one in value)


def _rounded(values: FloatArray, digits: int) -> Any:
    return tuple(float(value) + 0.0 for value in np.round(values, digits))
