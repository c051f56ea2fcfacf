"""Running what is not known yet, on all cores."""

from collections.abc import Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from singulation_bringup.closed_loop.setting import CellSetting
from singulation_bringup.closed_loop.store import RecordStore
from singulation_bringup.closed_loop.trial import Record, Trial, evaluate
from singulation_planner.benchmark.engines import on_cores
from singulation_planner.benchmark.progress import Progress


def run_all(trials: Sequence[Trial], setting: CellSetting, out: Path, workers: int) -> list[Record]:
    """Do what is missing; results of earlier runs in the folder are kept and counted.

    Args:
        trials: what is asked.
        setting: of the cell, the same for all results in the folder.
        out: folder of the results.
        workers: processes.

    Returns:
        Results of these trials; those in the folder that were not asked for are left out.

    Raises:
        SingulationError: as ``RecordStore`` and ``on_cores``.
    """
    with RecordStore(out, about(setting)) as store:
        known = {record.key for record in store.records}
        missing = [(trial, setting) for trial in trials if trial.key not in known]
        progress = Progress(len(missing))
        for record in on_cores(workers, evaluate, missing):
            store.add(record)
            progress.step()
        wanted = {trial.key for trial in trials}
        return [record for record in store.records if record.key in wanted]


def about(setting: CellSetting) -> dict[str, Any]:
    """What the results of a folder depend on, as JSON."""
    plain = partial(asdict, dict_factory=lambda pairs: {name: _plain(value) for name, value in pairs})
    return {"setting": plain(setting)}


def _plain(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else value
