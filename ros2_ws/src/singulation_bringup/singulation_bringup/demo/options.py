"""Command line of ``scripts/demo``."""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from singulation_core import ContactMode, InvalidInputError
from singulation_planner import POLICIES

PARTS = ("all", "replay", "cell")


@dataclass(frozen=True, slots=True)
class DemoOptions:
    """What the user asked for; see ``parse`` for the meaning of each."""

    bag: Path | None
    clouds: tuple[Path, ...]
    topic: str
    part: str
    seed: int
    objects: int
    contact_mode: ContactMode
    policy: str
    max_pushes: int
    min_gap: float
    speed: float
    out: Path
    headless: bool


def parse(arguments: Sequence[str], root: Path) -> DemoOptions:
    """Options of a command line.

    Args:
        arguments: without the program name.
        root: of the project; results go below it unless ``--out`` says otherwise.

    Raises:
        InvalidInputError: a number out of its range.
    """
    given = _parser().parse_args(arguments)
    for name, low, high in (
        ("objects", 0, 15),
        ("max_pushes", 0, 1000),
        ("min_gap", 0.0, 0.1),
        ("speed", 0.1, 20.0),
        ("seed", 0, 2**31 - 1),
    ):
        value = getattr(given, name)
        if not (low <= value <= high):
            raise InvalidInputError(f"--{name.replace('_', '-')} {value}: need {low} to {high}")
    started = datetime.now().astimezone().strftime("%Y-%m-%d_%H-%M-%S")
    return DemoOptions(
        given.bag,
        tuple(given.clouds),
        given.topic,
        given.part,
        given.seed,
        given.objects,
        ContactMode[given.contact_mode.upper()],
        given.policy,
        given.max_pushes,
        given.min_gap,
        given.speed,
        (given.out or root / "results" / f"demo_{started}").absolute(),
        given.headless,
    )


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="scripts/demo",
        description="First replays recorded clouds and shows segments and planned push of each, then takes blocks "
        "apart in the simulated cell: look, plan, push, look again.",
        epilog="Exit code: 0 done, 1 something failed (the summary says what), 2 wrong usage or input, 130 Ctrl-C.",
    )
    source = parser.add_mutually_exclusive_group()
    source.add_argument(
        "--bag", type=Path, metavar="PATH", help="rosbag2 (sqlite3 or mcap) instead of our own small one"
    )
    source.add_argument("--clouds", type=Path, nargs="+", default=[], metavar="FILE", help="PCD or PLY files instead")
    parser.add_argument("--topic", default="", help="cloud topic of the bag, if it has several")
    parser.add_argument("--part", choices=PARTS, default="all", help="only one of the two parts (default: all)")
    parser.add_argument("--seed", type=int, default=1, help="of the scene and its noise (default: %(default)s)")
    parser.add_argument("--objects", type=int, default=5, help="blocks on the simulated table (default: %(default)s)")
    modes = [mode.label for mode in ContactMode]
    parser.add_argument("--contact-mode", choices=modes, default=modes[0], help="how to push (default: %(default)s)")
    parser.add_argument(
        "--policy",
        choices=sorted(POLICIES),
        metavar="NAME",
        default="cluster_push",
        help="push policy; rollout_push needs fewer pushes (default: %(default)s, the paper's)",
    )
    parser.add_argument("--max-pushes", type=int, default=12, help="at most so many (default: %(default)s)")
    parser.add_argument(
        "--min-gap",
        type=float,
        default=0.012,
        metavar="M",
        help="separated means gaps of this width [m] (default: %(default)s)",
    )
    parser.add_argument(
        "--speed", type=float, default=2.0, help="of simulated time (default: %(default)s times real time)"
    )
    parser.add_argument("--out", type=Path, metavar="FOLDER", help="result folder (default: results/demo_<time>)")
    parser.add_argument(
        "--headless",
        action=argparse.BooleanOptionalAction,
        default=True,
        help="open no window; --no-headless shows the page of the run at the end",
    )
    return parser
