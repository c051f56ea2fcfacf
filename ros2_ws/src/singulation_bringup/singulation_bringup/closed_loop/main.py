"""``closed_loop_benchmark``: the paper's Table III and pushes until separated, with the whole chain in the loop."""

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from singulation_bringup.closed_loop.diffusion_readings import compare_readings
from singulation_bringup.closed_loop.endurance import endure
from singulation_bringup.closed_loop.figure import picture_of_separation
from singulation_bringup.closed_loop.readings import run_readings
from singulation_bringup.closed_loop.runs import run_all
from singulation_bringup.closed_loop.sets import COUNTS, MODES, one_push_trials, separate_trials
from singulation_bringup.closed_loop.setting import CAMERAS, SAMPLED, CellSetting
from singulation_bringup.closed_loop.store import read
from singulation_bringup.closed_loop.table_cost import table_cost
from singulation_bringup.closed_loop.table_separated import separated, table_separated
from singulation_bringup.closed_loop.table_three import table_three
from singulation_bringup.closed_loop.trial import Record
from singulation_core import SingulationError
from singulation_planner import POLICIES

_MAX_PUSHES = 10
_OUT = Path("bench_results/closed_loop")
_EXAMPLES = """examples:
  closed_loop_benchmark table                        Table III with the paper's 40 sets
  closed_loop_benchmark table --sets 50              the same with 400 sets, for smaller standard errors
  closed_loop_benchmark separate --sets 20           every policy, 100 sets of 3 to 7 blocks, until separated
  closed_loop_benchmark endurance --cycles 200       memory, threads and file handles of a long run
  closed_loop_benchmark report                       tables again from what is there
A run that was stopped goes on where it was; the same --out, and other numbers of sets, may be used.
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry of the executable; 0, or 1 with a text on standard error."""
    options = _parser().parse_args(arguments)
    try:
        return int(options.command(options) or 0)
    except SingulationError as error:
        print(f"closed_loop_benchmark: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("closed_loop_benchmark: stopped; results so far are kept, run again to go on", file=sys.stderr)
        return 130


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="closed_loop_benchmark",
        description=__doc__,
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    three = commands.add_parser("table", help="Table III: one push of ClusterPush and Cluster Diffusion on each set")
    three.add_argument("--sets", type=_positive, default=5, help="of each configuration (default: %(default)s)")
    _add_common(three, _table)
    apart = commands.add_parser("separate", help="push until separated")
    apart.add_argument("--sets", type=_positive, default=8, help="of each number of blocks (default: %(default)s)")
    apart.add_argument("--policies", nargs="+", default=sorted(POLICIES), choices=sorted(POLICIES), metavar="NAME")
    apart.add_argument("--contact-modes", nargs="+", default=list(MODES[:1]), choices=MODES)
    apart.add_argument("--counts", type=int, nargs="+", default=list(COUNTS), help="numbers of blocks")
    _add_common(apart, _separate)
    other = commands.add_parser("readings", help="Table III under other readings of what the paper leaves open")
    other.add_argument("--sets", type=_positive, default=5, help="of each configuration (default: %(default)s)")
    other.add_argument("--out", type=Path, default=_OUT / "readings", help="folder of the results")
    other.add_argument("--workers", type=_positive, default=os.cpu_count() or 1, help="processes (default: all cores)")
    other.set_defaults(command=lambda options: print(run_readings(options.sets, options.out, options.workers)))
    alone = commands.add_parser("diffusion", help="ClusterPush against other readings of Cluster Diffusion")
    alone.add_argument("--sets", type=_positive, default=5, help="of each configuration (default: %(default)s)")
    alone.add_argument("--push-distance-factor", type=float, default=1.0, help="travel [bounding radii]")
    alone.add_argument("--out", type=Path, default=_OUT, help="folder of the results (default: %(default)s)")
    alone.set_defaults(
        command=lambda options: print(compare_readings(options.sets, options.push_distance_factor, options.out))
    )
    long = commands.add_parser("endurance", help="many cycles in a row: memory, threads, file handles")
    long.add_argument("--cycles", type=_positive, default=200, help="pushes (default: %(default)s)")
    long.add_argument("--out", type=Path, default=_OUT, help="folder of the results (default: %(default)s)")
    long.set_defaults(command=lambda options: print(endure(options.cycles, options.out)))
    report = commands.add_parser("report", help="tables and figure from what is there")
    report.add_argument("--out", type=Path, default=_OUT, help="folder of the results (default: %(default)s)")
    report.set_defaults(command=lambda options: _report(read(options.out), options.out))
    return parser


def _add_common(parser: argparse.ArgumentParser, command: object) -> None:
    default = CellSetting()
    add = parser.add_argument
    add("--push-distance-factor", type=float, default=default.push_distance_factor, help="travel [bounding radii]")
    add("--physics", default=SAMPLED, help="of the table: sampled for each set, or a preset (default: %(default)s)")
    add("--fits", choices=["contact_mode", "every_mode"], default=default.fits, help="jaws that must fit at the start")
    add("--retreat", type=float, default=default.retreat, help="way a blocked start may be moved back [m]")
    add("--camera", choices=list(CAMERAS), default=default.camera, help="image size (default: %(default)s)")
    add("--out", type=Path, default=_OUT, help="folder of the results (default: %(default)s)")
    add("--workers", type=_positive, default=os.cpu_count() or 1, help="processes (default: all cores)")
    parser.set_defaults(command=command)


def _setting(options: argparse.Namespace) -> CellSetting:
    return CellSetting(
        push_distance_factor=options.push_distance_factor,
        physics=options.physics,
        fits=options.fits,
        retreat=options.retreat,
        camera=options.camera,
    )


def _table(options: argparse.Namespace) -> None:
    trials = one_push_trials(options.sets)
    _report(run_all(trials, _setting(options), options.out, options.workers), options.out)


def _separate(options: argparse.Namespace) -> None:
    trials = separate_trials(
        options.sets, options.policies, options.contact_modes, options.counts, max_pushes=_MAX_PUSHES
    )
    _report(run_all(trials, _setting(options), options.out, options.workers), options.out)


def _report(records: Sequence[Record], out: Path) -> None:
    """Write and print the tables of these results."""
    for name, text in (
        ("table_three.md", table_three(records)),
        ("separated.md", table_separated(records)),
        ("cost.md", table_cost(records)),
    ):
        if text:
            (out / name).write_text(text)
            print(text)
    found = separated(records)
    if len(found):
        picture_of_separation(out / "separated.png", found, _MAX_PUSHES)


def _positive(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"{number}, need 1 or more")
    return number


if __name__ == "__main__":
    sys.exit(main())
