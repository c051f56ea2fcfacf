"""``benchmark``: compares policies over many scenes and writes the paper's tables."""

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from singulation_core import SingulationError
from singulation_planner.benchmark import report
from singulation_planner.benchmark.run import BRUTE_FORCE, Plan, run
from singulation_planner.benchmark.settings import SETTINGS, find_setting
from singulation_planner.benchmark.store import load
from singulation_planner.policies import POLICIES

_EXAMPLES = """examples:
  benchmark run --out results                                   Table I: every policy, 1040 scenes, all cores
  benchmark run --policies cluster_push min_overlap --scenarios 104 --out quick
  benchmark run --contact-modes single_point edge two_point --fits contact_mode every_mode --counts 10-15 --out two
  benchmark run --dask tcp://scheduler:8786 --out results       on a cluster; stop and run again to go on
  benchmark tables results                                      tables and figure again from what is there
  benchmark compare authors_simulator.jsonl.gz --out compare    our physics against the authors' simulator
  benchmark simulators --out simulators                         presets of the push physics against each other
  benchmark timing --out timing                                 planning time against the number of objects
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry of the executable; 0, or 1 with a text on standard error."""
    options = _parser().parse_args(arguments)
    try:
        options.command(options)
    except SingulationError as error:
        print(f"benchmark: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("benchmark: stopped; results so far are kept, run again to go on", file=sys.stderr)
        return 130
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="benchmark", description=__doc__, epilog=_EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    _add_run(commands.add_parser("run", help="plan and simulate pushes over many scenes, then write tables"))
    tables = commands.add_parser("tables", help="write the tables and the figure of a finished or stopped run")
    tables.add_argument("out", type=Path, help="folder given to 'run' as --out")
    tables.set_defaults(command=lambda options: print(report.run_report(load(options.out), options.out)))
    compare = commands.add_parser("compare", help="simulate the pushes of a file made with the authors' code")
    compare.add_argument("file", type=Path, help="JSON lines, plain or .gz")
    compare.add_argument("--out", type=Path, required=True, help="folder for the table")
    compare.set_defaults(command=lambda options: print(report.comparison_report(options.file, options.out)))
    simulators = commands.add_parser("simulators", help="time and error of a simulated push, for every preset")
    simulators.add_argument("--scenes", type=int, default=32, help="60 random pushes on each (default: %(default)s)")
    simulators.add_argument("--out", type=Path, required=True, help="folder for the table")
    simulators.set_defaults(command=lambda options: print(report.simulator_report(options.scenes, options.out)))
    timing = commands.add_parser("timing", help="planning time against the number of objects, on one core")
    _add_policies(timing)
    timing.add_argument("--scenes", type=int, default=40, help="for each number of objects (default: %(default)s)")
    timing.add_argument("--out", type=Path, required=True, help="folder for the table")
    timing.set_defaults(
        command=lambda options: print(report.timing_report(options.policies, options.scenes, options.out))
    )
    return parser


def _add_run(parser: argparse.ArgumentParser) -> None:
    _add_policies(parser)
    add = parser.add_argument
    add("--setting", default="clutter", choices=list(SETTINGS), help="conditions (default: %(default)s)")
    modes = ["single_point", "edge", "two_point", "best"]
    add("--contact-modes", nargs="+", default=modes[:1], choices=modes, help="'best': the planner tries all three")
    add(
        "--fits", nargs="+", default=["contact_mode"], choices=["contact_mode", "every_mode"], help="jaws that must fit"
    )
    add("--scenarios", type=int, default=1040, help="number of scenes (default: %(default)s)")
    add("--brute-force-scenarios", type=int, default=520, help="of them also by Brute Force (default: %(default)s)")
    add("--counts", type=_counts, default=range(3, 16), metavar="A-B", help="numbers of objects (default: 3-15)")
    add("--seed", type=int, default=0, help="of the first scene (default: %(default)s)")
    add("--file", type=Path, help="scenes from a JSON-lines file instead of the generator")
    add("--out", type=Path, required=True, help="folder for results; a run that was stopped goes on there")
    add("--workers", type=int, default=os.cpu_count() or 1, help="processes (default: all cores)")
    add("--dask", metavar="ADDRESS", help="use this Dask scheduler's workers instead")
    parser.set_defaults(command=_run)


def _add_policies(parser: argparse.ArgumentParser) -> None:
    ordered = sorted(POLICIES, key=lambda name: (name != BRUTE_FORCE, name))
    parser.add_argument(
        "--policies", nargs="+", default=ordered, choices=ordered, metavar="NAME", help=", ".join(ordered)
    )


def _run(options: argparse.Namespace) -> None:
    plan = Plan(
        find_setting(options.setting),
        options.policies,
        options.contact_modes,
        options.fits,
        options.scenarios,
        options.brute_force_scenarios,
        list(options.counts),
        options.seed,
        options.file,
    )
    records = run(plan, options.out, options.workers, options.dask)
    print(report.run_report(records, options.out))


def _counts(text: str) -> range:
    low, _, high = text.partition("-")
    try:
        return range(int(low), int(high or low) + 1)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: need A-B, for example 10-15") from None


if __name__ == "__main__":
    sys.exit(main())
