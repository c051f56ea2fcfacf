"""Memory of replay_clouds on bags of different size, and on one larger than the memory it may have."""

import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from benchmarks.perception.tables import Table
from rclpy.serialization import serialize_message
from rosbags.rosbag2 import StoragePlugin, Writer
from std_msgs.msg import Header

from singulation_core.conversions import cloud_to_msg
from singulation_perception.bag_reading import CLOUD_TYPE
from singulation_perception.bag_types import typestore

_SHAPE = (1544, 2064)  # 38 MB a cloud
_FORMATS = (StoragePlugin.MCAP, StoragePlugin.SQLITE3)
_LIMIT = 600.0  # s for one bag
_POLL = 0.02  # s


def run_replay_memory(gigabytes: int) -> list[Table]:
    """Peak of the resident memory while bags of a quarter and all of ``gigabytes`` are played as fast as it goes.

    While it plays the larger one, the process may have half as much memory as the bag has bytes.
    """
    table = Table(
        "replay_memory",
        "Memory of replay_clouds",
        ["format", "bag GB", "clouds", "memory limit GB", "peak resident MB", "seconds", "exit code"],
        notes=["Clouds of 3.2 million random points, 38 MB each; no subscriber. The limit is RLIMIT_DATA."],
    )
    for plugin in _FORMATS:
        for size, limit in ((gigabytes / 4, 0), (float(gigabytes), gigabytes << 29)):
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / "bag"
                clouds = _write(path, plugin, size)
                actual = sum(file.stat().st_size for file in path.iterdir()) / 1e9
                row = [plugin.name.lower(), actual, clouds, limit / 2**30 if limit else "none", *_play(path, limit)]
            table.rows.append(row)
            print(table.markdown().splitlines()[-1], flush=True)
    return [table]


def _write(path: Path, plugin: StoragePlugin, gigabytes: float) -> int:
    """How many clouds were written; one a second."""
    random = np.random.default_rng(0)
    cloud = cloud_to_msg(random.normal(size=(*_SHAPE, 3)).astype(np.float32), Header(frame_id="phoxi_camera_sensor"))
    raw = serialize_message(cloud)
    count = max(1, int(gigabytes * 1e9 / (12 * _SHAPE[0] * _SHAPE[1])))
    with Writer(path, version=9, storage_plugin=plugin) as writer:
        connection = writer.add_connection("/points", CLOUD_TYPE, typestore=typestore())
        for number in range(1, count + 1):
            writer.write(connection, number * 10**9, raw)
    return count


def _play(path: Path, limit: int) -> tuple[float, float, int]:
    """Peak resident megabytes, seconds, exit code."""
    command = [sys.executable, "-m", "singulation_perception.replay_clouds", str(path), "--rate", "1000", "--wait", "0"]
    began = time.monotonic()
    process = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    if limit:
        resource.prlimit(process.pid, resource.RLIMIT_DATA, (limit, limit))
    peak = 0.0
    while process.poll() is None:
        peak = max(peak, _peak(process.pid))
        if time.monotonic() - began > _LIMIT:
            process.send_signal(signal.SIGINT)
        time.sleep(_POLL)
    return peak, time.monotonic() - began, process.returncode


def _peak(process: int) -> float:
    """Highest resident memory so far [MB], 0 if the process has just ended."""
    try:
        lines = Path(f"/proc/{process}/status").read_text(encoding="ascii").splitlines()
    except OSError:
        return 0.0
    return next((int(line.split()[1]) * 1024 / 1e6 for line in lines if line.startswith("VmHWM")), 0.0)
