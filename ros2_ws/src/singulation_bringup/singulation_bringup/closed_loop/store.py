"""Results on disk: a line of CSV is appended as soon as it is known, so that a run can stop and go on."""

import csv
import json
import os
from pathlib import Path
from typing import Any, get_type_hints

from singulation_bringup.closed_loop.trial import COLUMNS, Record
from singulation_core import InvalidInputError, ResultCode, SingulationError

RESULTS, ABOUT = "results.csv", "about.json"
_KINDS = get_type_hints(Record)


class RecordStore:
    """A folder with ``results.csv`` (grows) and ``about.json`` (the setting it belongs to); for use in ``with``.

    Args:
        folder: made if missing.
        about: setting of the results, as JSON; results of another one are refused.

    Raises:
        InvalidInputError: the folder holds results of another setting.
        SingulationError: ``BAD_FILE`` if it cannot be read or written.
    """

    def __init__(self, folder: Path, about: dict[str, Any]) -> None:
        try:
            folder.mkdir(parents=True, exist_ok=True)
            _claim(folder / ABOUT, json.dumps(about, indent=2, sort_keys=True) + "\n")
            self.records = read(folder)
            self._file = (folder / RESULTS).open("a", encoding="utf-8", newline="")
            self._writer = csv.DictWriter(self._file, COLUMNS, lineterminator="\n")
            if not self.records:
                self._file.truncate(0)
                self._writer.writeheader()
        except OSError as error:
            raise SingulationError(ResultCode.BAD_FILE, f"results folder {folder}: {error}") from error

    def __enter__(self) -> "RecordStore":
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    def add(self, record: Record) -> None:
        """Append a result and push it to the disk."""
        self.records.append(record)
        self._writer.writerow(record.as_row())
        self._file.flush()
        os.fsync(self._file.fileno())


def read(folder: Path) -> list[Record]:
    """All results in a folder, none if it has no file yet.

    A run that was killed may have left half a line: it is cut off, and its trial is done again.

    Raises:
        SingulationError: ``BAD_FILE``: a line that is none of ours.
    """
    path = folder / RESULTS
    if not path.exists():
        return []
    text = path.read_text(encoding="utf-8")
    whole = text[: text.rfind("\n") + 1]
    if whole != text:
        path.write_text(whole, encoding="utf-8")
    try:
        return [_record(row) for row in csv.DictReader(whole.splitlines())]
    except (KeyError, TypeError, ValueError) as error:
        raise SingulationError(ResultCode.BAD_FILE, f"{path}: not a result of this version: {error!r}") from None


def _record(row: dict[str, str]) -> Record:
    if tuple(row) != COLUMNS:
        raise KeyError(f"columns {sorted(set(row) ^ set(COLUMNS))}")
    return Record(**{name: _KINDS[name](value) for name, value in row.items()})


def _claim(path: Path, text: str) -> None:
    if path.exists() and path.read_text(encoding="utf-8") != text:
        raise InvalidInputError(
            f"results folder {path.parent}: holds another setting (see {path.name}); choose another --out"
        )
    path.write_text(text, encoding="utf-8")
