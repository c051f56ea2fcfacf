"""Faults in the middle of a push: code, time to notice, time to standstill, and whether the next push works.

scripts/bench supervision [--pushes 100] [--seed 0] [--out DIR]

With --pushes, random pushes are also executed one after the other under supervision, and what the tips really did is
measured.
"""

import argparse
import csv
from pathlib import Path

from benchmarks.supervision.faults import Reaction, measure
from benchmarks.supervision.pushes import execute_pushes, pushes_table
from benchmarks.supervision.robot import BenchRobot
from benchmarks.supervision.scenarios import scenarios


def main() -> None:
    """Run everything, write Markdown and CSV."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--pushes", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=Path("bench_results/supervision"))
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    reactions = [measure(scenario, BenchRobot(seed=options.seed)) for scenario in scenarios()]
    lines = ["# Supervision", "", "Simulated driver, joint states at 250 Hz, orders 4 ms on their way.", ""]
    lines += _table(reactions)
    _write(options.out / "faults.csv", [_row(one) for one in reactions])
    if options.pushes:
        executed = execute_pushes(options.pushes, options.seed)
        _write(options.out / "pushes.csv", [one.row() for one in executed])
        lines += ["", *pushes_table(executed)]
    (options.out / "supervision.md").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


def _row(one: Reaction) -> dict[str, object]:
    scenario = one.scenario
    return {
        "case": scenario.case,
        "fault": scenario.name,
        "phase": scenario.phase.name,
        "code": one.code.name,
        "noticed [s]": f"{one.noticed:.3f}",
        "then to standstill [s]": f"{one.standstill:.3f}",
        "way of the tips [mm]": f"{1e3 * one.way:.1f}",
        "standstill seen": "yes" if one.standing else "no",
        "next push": one.next_code.name,
        "test": scenario.test,
        "text": one.text,
    }


def _table(reactions: list[Reaction]) -> list[str]:
    rows = [{key: value for key, value in _row(one).items() if key != "text"} for one in reactions]
    names = list(rows[0])
    lines = ["| " + " | ".join(names) + " |", "|" + "---|" * len(names)]
    return lines + ["| " + " | ".join(str(row[name]) for name in names) + " |" for row in rows]


def _write(path: Path, rows: list[dict[str, object]]) -> None:
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main()
