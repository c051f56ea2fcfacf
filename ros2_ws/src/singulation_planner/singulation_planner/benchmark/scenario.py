"""One scene of a benchmark, and files of them."""

import gzip
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from singulation_core import Arrangement, InvalidInputError, PlanarObject, ResultCode, SingulationError
from singulation_core.polygon import convex_hull


@dataclass(frozen=True, eq=False)
class Scenario:
    """A scene with what the tables sort it by.

    Args:
        key: unique name; results are stored under it.
        n: number of blocks.
        group: of eccentricity, 0..3.
        seed: it was made from.
        arrangement: the blocks [m].
        unit: length that counts as 1 in s [m]: the nominal bounding radius of a block.
    """

    key: str
    n: int
    group: int
    seed: int
    arrangement: Arrangement
    unit: float


def read_scenarios(path: Path, unit: float) -> Iterator[tuple[Scenario, dict[str, Any]]]:
    """Scenarios of a JSON-lines file (``.gz`` or plain), each with the whole record it came from.

    A line has ``n``, ``group``, ``seed`` and ``objects`` with ``position`` and ``vertices`` relative to it, in bounding
    radii; a block is the convex hull of its vertices.

    Args:
        path: of the file.
        unit: metres that one bounding radius stands for.

    Raises:
        SingulationError: ``BAD_FILE`` if it cannot be read; ``INVALID_INPUT`` for a malformed line, with its number.
    """
    try:
        text = gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes()
    except OSError as error:
        raise SingulationError(ResultCode.BAD_FILE, f"scenario file {path}: {error}") from error
    for number, line in enumerate(text.splitlines(), start=1):
        try:
            record = json.loads(line)
            yield _scenario(record, unit), record
        except (ValueError, KeyError, TypeError, InvalidInputError) as error:
            raise InvalidInputError(f"scenario file {path}, line {number}: {error}") from error


def _scenario(record: dict[str, Any], unit: float) -> Scenario:
    objects = [
        PlanarObject(k, (np.array(item["position"]) + convex_hull(item["vertices"])) * unit)
        for k, item in enumerate(record["objects"])
    ]
    n, group, seed = int(record["n"]), int(record["group"]), int(record["seed"])
    if n != len(objects):
        raise InvalidInputError(f"n is {n}, but there are {len(objects)} objects")
    return Scenario(f"file-n{n:02d}-g{group}-s{seed}", n, group, seed, Arrangement(objects), unit)
