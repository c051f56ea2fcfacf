"""Cloud published to arrangement received, across processes: before and after our transport settings.

scripts/bench transport [--repeats 40] [--points half full] [--out FOLDER]
"""

import argparse
import csv
import json
import signal
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import numpy as np
from benchmarks.perception.scenes import AREA, FULL, HALF, Scene, make_scene
from benchmarks.transport.processes import ECHO, PERCEPTION, RELIABLE_ECHO, SETTINGS, environment

from singulation_core.transforms import quaternion_of
from singulation_node.domain import reserved_domain

_LIMIT = 300.0  # s for one row
_SENSORS = {"half": HALF, "full": FULL}


@dataclass(frozen=True, slots=True)
class Row:
    """One line of the table; times in milliseconds."""

    points: int
    megabytes: float
    settings: str
    receiver: str
    sent: int
    answered: int
    objects: int
    median: float
    p95: float
    largest: float
    first: float
    fastest: float
    sender_processor: float
    receiver_processor: float


def main() -> int:
    """Measure and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=40, help="clouds for each row (default 40)")
    parser.add_argument(
        "--points", nargs="+", choices=list(_SENSORS), default=list(_SENSORS), help="resolutions (default: both)"
    )
    parser.add_argument("--out", type=Path, default=Path("bench_results/transport"), help="folder for the tables")
    options = parser.parse_args()
    rows = []
    for name in options.points:
        scene = make_scene(7, _SENSORS[name])
        for receiver in (RELIABLE_ECHO, ECHO, PERCEPTION):
            for settings in SETTINGS:
                rows.append(_row(scene, settings, receiver, options.repeats))
                print(_markdown(rows[-1:]).splitlines()[-1], flush=True)
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "transport.md").write_text(_markdown(rows))
    with (options.out / "transport.csv").open("w", newline="") as file:
        table = csv.DictWriter(file, [item.name for item in fields(Row)])
        table.writeheader()
        table.writerows(asdict(row) for row in rows)
    print(f"\n{_markdown(rows)}\nwritten to {options.out}")
    return 0


def _row(scene: Scene, settings: str, receiver: str, repeats: int) -> Row:
    with tempfile.TemporaryDirectory() as folder, reserved_domain() as domain:
        path = Path(folder) / "cloud.npy"
        np.save(path, scene.points)
        variables = {**environment(settings), "ROS_DOMAIN_ID": str(domain)}
        arguments = _parameters(scene) if receiver == PERCEPTION else []
        receiving = _start("processes", variables, settings, receiver, *arguments)
        try:
            words = (settings, str(path), str(repeats), str(receiving.pid))
            sending = _start("sender", variables, *words, output=subprocess.PIPE)
            seen = json.loads(sending.communicate(timeout=_LIMIT)[0])
        finally:
            _stop(receiving)
    times = np.array(seen["times"]) if seen["times"] else np.array([np.nan])
    later = times[1:] if len(times) > 1 else times
    return Row(
        scene.points.size // 3,
        scene.points.nbytes / 1e6,
        settings,
        receiver,
        repeats,
        len(seen["times"]),
        seen["objects"],
        float(np.median(later)),
        float(np.percentile(later, 95)),
        float(later.max()),
        float(times[0]),
        float(later.min()),
        seen["processor"],
        seen["receiver"],
    )


def _stop(process: "subprocess.Popen[bytes]") -> None:
    process.send_signal(signal.SIGINT)
    try:
        process.wait(timeout=30.0)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait(timeout=30.0)


def _start(
    module: str, variables: dict[str, str], *arguments: str, output: int | None = None
) -> "subprocess.Popen[bytes]":
    command = [sys.executable, "-m", f"benchmarks.transport.{module}", *arguments]
    return subprocess.Popen(command, env=variables, stdout=output, stderr=None if output else subprocess.DEVNULL)


def _parameters(scene: Scene) -> list[str]:
    pose = scene.table_from_camera
    values = {
        "camera_position": pose[:3, 3],
        "camera_quaternion": quaternion_of(pose),
        "workspace": AREA,
    }
    pairs = [f"{name}:=[{', '.join(f'{float(number):.9f}' for number in value)}]" for name, value in values.items()]
    return ["--ros-args", *(part for pair in pairs for part in ("-p", pair))]


def _markdown(rows: list[Row]) -> str:
    columns = ["points", "MB", "settings of both processes", "receiver", "answered", "objects", "median ms", "p95"]
    columns += ["largest", "first", "fastest", "sender processor ms", "receiver processor ms"]
    lines = ["| " + " | ".join(columns) + " |", "|---" * len(columns) + "|"]
    for row in rows:
        lines.append(
            f"| {row.points} | {row.megabytes:.1f} | {row.settings} | {row.receiver} | {row.answered} of {row.sent} "
            f"| {row.objects} | {row.median:.1f} | {row.p95:.1f} | {row.largest:.1f} | {row.first:.1f} "
            f"| {row.fastest:.1f} | {row.sender_processor:.1f} | {row.receiver_processor:.1f} |"
        )
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(main())
