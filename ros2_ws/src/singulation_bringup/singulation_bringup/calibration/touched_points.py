"""Points touched with the tip of the closed jaws, as read from the robot."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml  # type: ignore[import-untyped]  # no types are published with it

from singulation_core import InvalidInputError
from singulation_core.polygon import FloatArray

UNITS = {"m": 1.0, "mm": 1e-3}  # the FlexPendant shows millimetres
_FARTHEST = 2.0  # m from the robot's base; a YuMi reaches about 0.6


@dataclass(frozen=True, eq=False)
class TouchedPoints:
    """Positions of the tool tip in ``yumi_body`` [m].

    Args:
        table: (k, 3), on the bare table.
        blocks: (n, 3), on the middle of the top face of a block each.
    """

    table: FloatArray
    blocks: FloatArray


def touched_points(table: Iterable[Sequence[float]], blocks: Iterable[Sequence[float]], unit: str) -> TouchedPoints:
    """Points given as numbers in ``unit``.

    Raises:
        InvalidInputError: naming the point.
    """
    return TouchedPoints(_points(table, "table", unit), _points(blocks, "blocks", unit))


def read_touched_points(path: Path, unit: str) -> TouchedPoints:
    """Points of a YAML file with the lists ``table`` and ``blocks`` of [x, y, z].

    Raises:
        InvalidInputError: the file cannot be read, or has other things in it.
    """
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise InvalidInputError(f"{path}: {error}") from None
    if not isinstance(content, dict) or not set(content) <= {"table", "blocks"}:
        raise InvalidInputError(f"{path}: need the lists table and blocks, each of [x, y, z]")
    try:
        return touched_points(content.get("table") or (), content.get("blocks") or (), unit)
    except InvalidInputError as error:
        raise InvalidInputError(f"{path}: {error.message}") from None


def point_of(text: str) -> tuple[float, ...]:
    """Three numbers from text such as ``0.39, -0.01, 0.04`` or ``0.39 -0.01 0.04``.

    Raises:
        InvalidInputError: not three numbers.
    """
    try:
        numbers = tuple(float(part) for part in text.replace(",", " ").split())
    except ValueError:
        numbers = ()
    if len(numbers) != 3:
        raise InvalidInputError(f"{text!r}: need x, y, z")
    return numbers


def _points(rows: Iterable[Any], name: str, unit: str) -> FloatArray:
    found = []
    for number, row in enumerate(rows, start=1):
        try:
            point = np.asarray(row, dtype=np.float64) * UNITS[unit]
        except (TypeError, ValueError):
            point = np.empty(0)
        if point.shape != (3,) or not np.isfinite(point).all():
            raise InvalidInputError(f"{name} point {number}: {row!r}, need three numbers x, y, z")
        if not (np.abs(point).max() <= _FARTHEST):
            raise InvalidInputError(f"{name} point {number}: {row!r} {unit} is out of reach; is it in millimetres?")
        found.append(point)
    return np.array(found).reshape(-1, 3)
