"""From results to files: tables, figure, CSV and Parquet."""

import json
from collections.abc import Sequence
from pathlib import Path

from singulation_core import ContactMode
from singulation_planner.benchmark.compare import compare, comparison_table
from singulation_planner.benchmark.figure import figure_six
from singulation_planner.benchmark.record import Record
from singulation_planner.benchmark.rematch import rematch, rematch_table
from singulation_planner.benchmark.settings import SETTINGS
from singulation_planner.benchmark.simulators import simulator_table
from singulation_planner.benchmark.store import export
from singulation_planner.benchmark.tables import authors_table, judged_table, table_one, table_two, write
from singulation_planner.benchmark.timing import measure, measure_pushes, timing_table

_COUNTS = (3, 5, 8, 10, 15, 30, 60, 120)
_PUSH_COUNTS = _COUNTS[:5]


def run_report(records: Sequence[Record], out: Path) -> str:
    """Write everything that a run's results allow; returns the tables.

    Files: ``results.csv``, ``results.parquet``, ``table_1.md``, ``figure_6.png``, and ``table_2.md`` if other contact
    modes than the single point were used.
    """
    results = export(records, out)
    about = json.loads((out / "about.json").read_text(encoding="utf-8"))["setting"]
    texts = []
    if (results["contact_mode"] == "single_point").any():
        texts.append(table_one(results, about["text"]))
        if about["name"] == "authors":
            texts[-1] += "\n" + authors_table(results)
        if about["judge"]:
            texts[-1] += "\n" + judged_table(results)
        write(out, "table_1", texts[-1])
        figure_six(results, out / "figure_6.png")
    if (results["contact_mode"] != "single_point").any():
        texts.append(table_two(results, about["text"]))
        write(out, "table_2", texts[-1])
    return "\n".join(texts)


def comparison_report(file: Path, out: Path) -> str:
    """Write ``compare.csv``, ``rematch.csv`` and ``compare.md``; returns the tables."""
    out.mkdir(parents=True, exist_ok=True)
    rows = compare(file)
    rows.to_csv(out / "compare.csv", index=False)
    matches = rematch(file)
    matches.to_csv(out / "rematch.csv", index=False)
    text = comparison_table(rows) + "\n" + rematch_table(matches)
    write(out, "compare", text)
    return text


def simulator_report(scenes: int, out: Path) -> str:
    """Write ``simulators.md``; returns the tables."""
    out.mkdir(parents=True, exist_ok=True)
    text = "Errors in bounding radii, of the worst block of a push; times are processor time of one core.\n\n"
    text += "\n".join(simulator_table(SETTINGS["clutter"], scenes, mode) for mode in ContactMode)
    write(out, "simulators", text)
    return text


def timing_report(policies: Sequence[str], scenes: int, out: Path) -> str:
    """Write ``timing.md``; returns the tables."""
    out.mkdir(parents=True, exist_ok=True)
    setting = SETTINGS["clutter"]
    text = "Processor time of one core [ms], median over scenes.\n\n"
    text += timing_table(measure(setting, policies, _COUNTS, scenes), "planning, single point")
    presets = ("quasi_static", "fast", "fine", "authors")
    text += "\n" + timing_table(measure_pushes(setting, presets, _PUSH_COUNTS, 100), "one simulated push")
    write(out, "timing", text)
    return text
