"""Everything that is published about the planner: tables I and II, figure 6, the authors' simulator, planning times.

scripts/bench planner [--only PART ...] [--policies NAME ...] [--scenarios 1040] [--brute-force-scenarios 520]
                      [--dask ADDRESS] [--out FOLDER]

A run that was stopped goes on where it was.
"""

import argparse
import os
import sys
from collections.abc import Callable
from pathlib import Path

from singulation_core import SingulationError
from singulation_planner.benchmark.report import comparison_report, run_report, simulator_report, timing_report
from singulation_planner.benchmark.run import BRUTE_FORCE, Plan, run
from singulation_planner.benchmark.settings import find_setting
from singulation_planner.policies import POLICIES

_AUTHORS_FILE = Path("../shared/data/authors_simulator.jsonl.gz")


def table_one(setting: str) -> Callable[[argparse.Namespace, Path], str]:
    """Table I and figure 6 in a setting."""

    def make(options: argparse.Namespace, out: Path) -> str:
        plan = Plan(
            find_setting(setting),
            options.policies,
            scenarios=options.scenarios,
            brute_force_scenarios=options.brute_force_scenarios,
            first_seed=options.seed,
        )
        return run_report(run(plan, out, options.workers, options.dask), out)

    return make


def table_two(setting: str) -> Callable[[argparse.Namespace, Path], str]:
    """Table II in a setting."""

    def make(options: argparse.Namespace, out: Path) -> str:
        plan = Plan(
            find_setting(setting),
            [name for name in options.policies if name != BRUTE_FORCE],
            ("single_point", "edge", "two_point", "best"),
            ("contact_mode", "every_mode"),
            scenarios=options.scenarios,
            counts=range(10, 16),
            first_seed=options.seed,
        )
        run_report(run(plan, out, options.workers, options.dask), out)
        return (out / "table_2.md").read_text(encoding="utf-8")

    return make


def comparison(options: argparse.Namespace, out: Path) -> str:
    """The authors' simulator against ours."""
    if not options.authors_file.exists():
        return f"No file {options.authors_file}: comparison left out.\n"
    return comparison_report(options.authors_file, out)


def simulators(options: argparse.Namespace, out: Path) -> str:
    """Presets of the push physics against each other."""
    return simulator_report(options.simulator_scenes, out)


def timing(options: argparse.Namespace, out: Path) -> str:
    """Planning times."""
    return timing_report(options.policies, options.timing_scenes, out)


PARTS: dict[str, tuple[str, Callable[[argparse.Namespace, Path], str]]] = {
    "clutter": ("Table I in touching clutter", table_one("clutter")),
    "clutter_pymunk": ("Table I in touching clutter, all by pymunk", table_one("clutter_pymunk")),
    "authors": ("Table I in the authors' setting", table_one("authors")),
    "contact_modes_clutter": ("Table II in touching clutter", table_two("clutter")),
    "contact_modes_authors": ("Table II in the authors' setting", table_two("authors")),
    "comparison": ("The authors' simulator and ours, same pushes", comparison),
    "simulators": ("Simulators", simulators),
    "timing": ("Time", timing),
}


def main() -> int:
    """Run the parts and gather them in ``planner.md``."""
    options = _options()
    texts = [f"# Planner benchmark\n\nCommand: `scripts/bench planner {' '.join(sys.argv[1:])}`\n"]
    try:
        for name in options.only:
            title, part = PARTS[name]
            print(f"== {title}", file=sys.stderr)
            texts.append(f"## {title}\n\n{part(options, options.out / name)}")
    except SingulationError as error:
        print(f"planner benchmark: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("planner benchmark: stopped; results so far are kept, run again to go on", file=sys.stderr)
        return 130
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "planner.md").write_text("\n".join(texts), encoding="utf-8")
    print("\n".join(texts))
    return 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="scripts/bench planner", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("--scenarios", type=int, default=1040, help="scenes for each table (default: %(default)s)")
    add("--brute-force-scenarios", type=int, default=520, help="of them also by Brute Force (default: %(default)s)")
    add("--timing-scenes", type=int, default=40, help="scenes for each number of objects (default: %(default)s)")
    add("--simulator-scenes", type=int, default=48, help="60 random pushes on each (default: %(default)s)")
    add("--only", nargs="+", choices=list(PARTS), default=list(PARTS), metavar="PART", help=", ".join(PARTS))
    add(
        "--policies",
        nargs="+",
        choices=list(POLICIES),
        default=list(POLICIES),
        metavar="NAME",
        help=", ".join(POLICIES),
    )
    add("--authors-file", type=Path, default=_AUTHORS_FILE, help="made with the authors' code (default: %(default)s)")
    add("--seed", type=int, default=0, help="of the first scene")
    add("--workers", type=int, default=os.cpu_count() or 1, help="processes (default: all cores)")
    add("--dask", metavar="ADDRESS", help="Dask scheduler to use instead")
    add("--out", type=Path, default=Path("bench_results/planner"))
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
