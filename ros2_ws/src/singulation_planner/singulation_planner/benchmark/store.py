"""Results on disk: a line is appended as soon as it is known, so that a run can stop and go on."""

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from singulation_core import InvalidInputError, ResultCode, SingulationError
from singulation_planner.benchmark.record import COLUMNS, Record

_LINES, _ABOUT = "results.jsonl", "about.json"


class ResultStore:
    """A folder of results: ``results.jsonl`` (grows), ``about.json`` (what it belongs to), and exports.

    Args:
        folder: made if missing.
        about: what the results depend on, as JSON; results of something else in the folder are refused.

    Raises:
        InvalidInputError: the folder holds results of another setting.
        SingulationError: ``BAD_FILE`` if it cannot be read or written.
    """

    def __init__(self, folder: Path, about: dict[str, Any]) -> None:
        self._lines = folder / _LINES
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._claim(folder / _ABOUT, about)
            self.records = _read(self._lines)
            self._file = self._lines.open("a", encoding="utf-8")
        except OSError as error:
            raise SingulationError(ResultCode.BAD_FILE, f"results folder {folder}: {error}") from error

    def __enter__(self) -> "ResultStore":
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    def _claim(self, path: Path, about: dict[str, Any]) -> None:
        text = json.dumps(about, indent=2, sort_keys=True)
        if path.exists() and path.read_text(encoding="utf-8") != text:
            raise InvalidInputError(
                f"results folder {path.parent}: holds another setting (see {path.name}); choose another --out"
            )
        path.write_text(text, encoding="utf-8")

    def add(self, records: Iterable[Record]) -> None:
        """Append results and push them to the disk."""
        for record in records:
            self.records.append(record)
            self._file.write(json.dumps(record.as_row()) + "\n")
        self._file.flush()


def load(folder: Path) -> list[Record]:
    """All results in a folder.

    Raises:
        SingulationError: ``BAD_FILE`` if there are none.
    """
    path = folder / _LINES
    if not path.exists():
        raise SingulationError(ResultCode.BAD_FILE, f"{folder}: no {_LINES}; give the --out folder of a run")
    return _read(path)


def export(records: Sequence[Record], folder: Path) -> pd.DataFrame:
    """Write ``results.csv`` and ``results.parquet``; returns the table, sorted by scene, policy and mode."""
    table = pd.DataFrame([record.as_row() for record in records], columns=list(COLUMNS))
    table = table.sort_values(["scenario", "policy", "contact_mode", "fits"], ignore_index=True)
    table.to_csv(folder / "results.csv", index=False)
    table.to_parquet(folder / "results.parquet", index=False)
    return table


def _read(path: Path) -> list[Record]:
    """Complete lines only: a run that was killed may have left half a line, whose job is then done again."""
    if not path.exists():
        return []
    text = path.read_text(encoding="utf-8")
    whole, _, rest = text.rpartition("\n")
    if rest:
        path.write_text(f"{whole}\n" if whole else "", encoding="utf-8")
    return [Record(**json.loads(line)) for line in whole.splitlines()]
