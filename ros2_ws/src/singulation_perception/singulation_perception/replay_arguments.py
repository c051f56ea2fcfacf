"""Command line of replay_clouds."""

import argparse
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

ORIGINAL, NOW = "original", "now"


@dataclass(frozen=True, slots=True)
class ReplayOptions:
    """See ``replay_clouds --help``; times in seconds."""

    paths: list[Path]
    topic: str
    rate: float
    period: float
    loop: bool
    step: bool
    stamps: str
    clock: bool
    frame: str
    wait: float


def parse_replay(arguments: Sequence[str]) -> ReplayOptions:
    """Options from the command line; exits with code 2 and the usage if they are wrong."""
    parser = argparse.ArgumentParser(
        prog="replay_clouds",
        description="Publishes recorded point clouds on the topic points.",
        epilog="Exit codes: 0 all clouds published, or ended by Ctrl-C; 1 a file is missing, damaged or without "
        "clouds; 2 wrong arguments; 3 nobody subscribed in time.",
    )
    add = parser.add_argument
    add("paths", nargs="+", type=Path, metavar="PATH", help="one rosbag2 (folder, .mcap or .db3), or PCD and PLY files")
    add("--topic", default="", help="topic of the bag to read; needed if several carry clouds")
    add("--rate", type=_positive, default=1.0, metavar="FACTOR", help="speed, 2 is twice as fast (default 1)")
    add("--period", type=_positive, default=1.0, metavar="S", help="time between cloud files [s] (default 1)")
    add("--loop", action="store_true", help="begin again at the end, until Ctrl-C")
    add("--step", action="store_true", help="one cloud for each key (q ends) or call of ~/step (std_srvs/Trigger)")
    add(
        "--stamps",
        choices=(NOW, ORIGINAL),
        default=NOW,
        help="now: when published, in the time of --clock if that is given (default); original: as recorded",
    )
    add("--clock", action="store_true", help="publish /clock, the time of the recording")
    add(
        "--frame",
        default="",
        help="frame_id to give the clouds (default: the recorded one, for files phoxi_camera_sensor)",
    )
    add(
        "--wait",
        type=_not_negative,
        default=30.0,
        metavar="S",
        help="longest wait for a subscriber before the first cloud [s], 0 does not wait (default 30)",
    )
    return ReplayOptions(**vars(parser.parse_args(list(arguments))))


def _positive(text: str) -> float:
    value = _not_negative(text)
    if not (value > 0.0):
        raise argparse.ArgumentTypeError(f"{text}, need a number above 0")
    return value


def _not_negative(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not (0.0 <= value < math.inf):
        raise argparse.ArgumentTypeError(f"{text}, need a finite number of at least 0")
    return value
