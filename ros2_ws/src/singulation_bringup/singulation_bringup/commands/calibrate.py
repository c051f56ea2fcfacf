"""Finds or checks where table and camera stand, prints what remains in millimetres, writes the cell file.

1. Close the jaws. Touch the bare table with their tip in its corners and its middle (at least 3 points, better 5) and
   note x, y, z of the tool tip in the robot's base each time (FlexPendant, Jogging, base coordinates; millimetres).
2. Lay at least 3 blocks (better 5) on the table, with different distances between them.
3. Take the arms out of the camera's view and let the command take its clouds, or record them.
4. Touch the middle of the top face of each block.
The points go into a file (--touched), onto the command line (--table-point, --block-point), or are asked for (--ask).
Exit code 0: written, or checked and within --limit; 1: not.
"""

import argparse
import datetime
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from singulation_bringup.calibration.cell_file import cell_file_text, read_cell_file
from singulation_bringup.calibration.check import check
from singulation_bringup.calibration.report import calibration_text, check_text
from singulation_bringup.calibration.seen_table import SeenTable, see_table
from singulation_bringup.calibration.solve import calibrate
from singulation_bringup.calibration.touched_points import (
    UNITS,
    TouchedPoints,
    point_of,
    read_touched_points,
    touched_points,
)
from singulation_bringup.commands.cloud_source import live_clouds, recorded_clouds
from singulation_core import CellGeometry, InvalidInputError, SingulationError
from singulation_node.main import plain_arguments


def run(options: argparse.Namespace, arguments: Sequence[str], ask: Callable[[str], str] = input) -> int:
    """Calibrate or check.

    Raises:
        SingulationError: what is wrong with files, points or clouds.
    """
    before = read_cell_file(options.cell) if options.cell else CellGeometry()
    touched = _touched(options, ask)
    views = [_view(cloud, before if options.check else None) for cloud in _clouds(options, arguments)]
    if options.check:
        report = check(touched, views, before)
        print(check_text(report))
        return _verdict(report.worst, options.limit)
    found = calibrate(touched, views, before)
    text = calibration_text(found)
    print(text)
    if _verdict(found.worst, options.limit):
        print("nothing was written; touch the points again, or allow more with --limit", file=sys.stderr)
        return 1
    made = f"Made by calibrate on {datetime.datetime.now().astimezone():%Y-%m-%d %H:%M}."
    options.out.write_text(cell_file_text(found.cell, [made, text]), encoding="utf-8")
    print(f"written: {options.out}; measure the workspace on your table, it is that of {options.cell or 'the example'}")
    return 0


def _verdict(worst: float, limit: float) -> int:
    if worst <= limit * 1e-3:
        print(f"good: within {limit:g} mm")
        return 0
    print(f"not good: {1e3 * worst:.2f} mm, limit {limit:g} mm")
    return 1


def _view(points: NDArray[Any], cell: CellGeometry | None) -> SeenTable:
    return see_table(points, cell)


def _clouds(options: argparse.Namespace, arguments: Sequence[str]) -> list[NDArray[Any]]:
    if options.clouds:
        return recorded_clouds(options.clouds, options.topic, options.count)
    return live_clouds(arguments, options.trigger, options.count, options.timeout)


def _touched(options: argparse.Namespace, ask: Callable[[str], str]) -> TouchedPoints:
    if options.touched:
        return read_touched_points(options.touched, options.unit)
    table, blocks = options.table_point, options.block_point
    if options.ask:
        table = [*table, *_asked("tip on the bare table", ask, options.unit)]
        blocks = [*blocks, *_asked("tip on the middle of a block's top face", ask, options.unit)]
    return touched_points(table, blocks, options.unit)


def _asked(what: str, ask: Callable[[str], str], unit: str) -> list[tuple[float, ...]]:
    """Points typed in, until an empty line."""
    print(f"{what}: x y z in yumi_body [{unit}], an empty line when done")
    points: list[tuple[float, ...]] = []
    while text := ask(f"  point {len(points) + 1}: ").strip():
        try:
            points.append(point_of(text))
        except InvalidInputError as error:
            print(f"  {error.message}")
    return points


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Options from the command line."""
    parser = argparse.ArgumentParser(
        prog="calibrate", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("--cell", type=Path, help="cell file so far: its frame table and its workspace are kept (default: the example)")
    add("--out", type=Path, default=Path("cell.yaml"), help="cell file to write (default cell.yaml)")
    add("--check", action="store_true", help="write nothing, only compare --cell with what is measured")
    add("--limit", type=float, default=3.0, help="largest residual that is accepted [mm] (default 3)")
    add("--touched", type=Path, help="YAML file with the lists table and blocks of [x, y, z]")
    add("--table-point", type=point_of, action="append", default=[], metavar="X,Y,Z", help="again for each point")
    add("--block-point", type=point_of, action="append", default=[], metavar="X,Y,Z", help="again for each block")
    add("--ask", action="store_true", help="ask for the points, one by one")
    add("--unit", choices=tuple(UNITS), default="mm", help="of the points (default mm, as on the FlexPendant)")
    add("--clouds", type=Path, nargs="+", default=[], help="a rosbag2, or PCD and PLY files, instead of the camera")
    add("--topic", default="", help="topic of the bag, if several carry clouds")
    add("--count", type=int, default=3, help="clouds to take (default 3)")
    add("--trigger", default="trigger_frame", help='service that triggers the camera, "" if it runs freely')
    add("--timeout", type=float, default=30.0, help="longest wait for a cloud [s]")
    options = parser.parse_args(list(arguments))
    if options.check and not options.cell:
        parser.error("--check needs the cell file to check: --cell FILE")
    if options.count < 1:
        parser.error(f"--count {options.count}, need at least 1")
    return options


def main(args: Sequence[str] | None = None) -> int:
    """Entry point."""
    arguments = list(sys.argv if args is None else args)
    try:
        return run(parse(plain_arguments(arguments)), arguments)
    except SingulationError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
