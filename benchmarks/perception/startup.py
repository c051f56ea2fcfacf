"""How long perception_node takes from the start of its process until it takes clouds: cold and warm."""

import gc
import os
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import rclpy
from benchmarks.perception.tables import Table
from rclpy.context import Context
from sensor_msgs.msg import PointCloud2

from singulation_node.domain import reserved_domain
from singulation_node.large_messages import prepare_for_large_messages

_LIMIT = 300.0  # s for a start
_STOP_LIMIT = 30.0  # s
_POLL = 0.01  # s


@dataclass(frozen=True)
class Start:
    """Seconds on the clock and of processor time until ready, and what the node said about its warm-up."""

    wall: float
    processor: float
    said: str


def run_startup(repeats: int) -> list[Table]:
    """One start with an empty compile cache, then several with the cache that it left."""
    table = Table(
        "startup",
        "Start of perception_node",
        ["start", "seconds until it takes clouds", "processor s", "it said"],
        notes=[
            "From the start of the process until another process sees its subscription; warm: median of "
            f"{repeats} starts. Everything is in it: Python, imports, middleware, discovery, warm-up. The other "
            "process uses our transport profile, as a camera driver should. The processor time is that of all "
            "processes of the start, and ends with them a moment later."
        ],
    )
    prepare_for_large_messages()
    with tempfile.TemporaryDirectory() as folder:
        cold = _start(Path(folder))
        warm = [_start(Path(folder)) for _ in range(repeats)]
    table.rows.append(["empty compile cache", cold.wall, cold.processor, cold.said])
    middle = warm[int(np.argsort([one.wall for one in warm])[len(warm) // 2])]
    table.rows.append(["warm", middle.wall, middle.processor, middle.said])
    return [table]


def _start(cache: Path) -> Start:
    context = Context()
    with reserved_domain() as domain:
        rclpy.init(context=context, domain_id=domain)
        camera = rclpy.create_node("camera", context=context)
        points = camera.create_publisher(PointCloud2, "points", 1)
        environment = {**os.environ, "ROS_DOMAIN_ID": str(domain), "NUMBA_CACHE_DIR": str(cache)}
        began = time.monotonic()
        command = [sys.executable, "-m", "singulation_perception.perception_node", "--autostart"]
        process = subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True)
        try:
            while points.get_subscription_count() == 0:
                if process.poll() is not None or time.monotonic() - began > _LIMIT:
                    raise SystemExit(f"perception_node did not start within {_LIMIT} s")
                time.sleep(_POLL)
            return _ended(process, time.monotonic() - began)
        finally:
            process.kill()
            process.wait(timeout=_STOP_LIMIT)
            camera.destroy_node()
            context.try_shutdown()
            gc.collect()  # until then the camera keeps its place in the domain


def _ended(process: "subprocess.Popen[str]", wall: float) -> Start:
    before = os.times()
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=_STOP_LIMIT)[1]
    after = os.times()  # a child's processor time counts when it has ended
    processor = after.children_user + after.children_system - before.children_user - before.children_system
    lines = [line.split("]: ", 1)[-1] for line in said.splitlines() if "warm" in line]
    return Start(wall, processor, "; ".join(lines))
