"""How long plan_push takes over ROS: a planner_node in a process of its own, a client in this one.

scripts/bench planner_node [--requests 300] [--policies cluster_push ...] [--out FOLDER]
"""

import argparse
import contextlib
import csv
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import rclpy
from rclpy.executors import SingleThreadedExecutor
from singulation_msgs.srv import PlanPush

from singulation_core import ResultCode
from singulation_core.conversions import arrangement_to_msg
from singulation_node.domain import reserved_domain
from singulation_planner.testing import clutter

_START_TIMEOUT = 60.0  # s; the kernels may have to be compiled
_ANSWER_TIMEOUT = 10.0  # s
_SIZE = 0.6  # blocks of 12 mm bounding radius: fifteen of them fit well into the workspace
_COUNTS = (3, 7, 15)
_HEADER = (
    "policy",
    "n",
    "requests",
    "median [ms]",
    "10 % [ms]",
    "95 % [ms]",
    "planning in it, median [ms]",
    "processor time of node and client [ms]",  # what is left of the rest is waiting for a core
)


def main() -> int:
    """Measure and write the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--requests", type=int, default=300, help="for each number of objects (default 300)")
    parser.add_argument("--policies", nargs="+", default=["cluster_push", "min_overlap", "cluster_diffusion"])
    parser.add_argument("--out", type=Path, default=Path("bench_results/planner_node"), help="folder for the table")
    options = parser.parse_args()
    with reserved_domain() as domain, _planner(domain) as pid, _client(domain) as executor:
        node = executor.get_nodes()[0]
        client = node.create_client(PlanPush, "plan_push")
        if not client.wait_for_service(timeout_sec=_START_TIMEOUT):
            print(f"planner_node did not come up within {_START_TIMEOUT} s", file=sys.stderr)
            return 1
        cells = [(policy, count) for policy in options.policies for count in _COUNTS]
        rows = [_row(executor, client, policy, count, options.requests, pid) for policy, count in cells]
    table = [_HEADER, ("---",) * len(_HEADER), *rows]
    text = "\n".join(f"| {' | '.join(row)} |" for row in table) + "\n"
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "planner_node.md").write_text(text)
    with (options.out / "planner_node.csv").open("w", newline="") as file:
        csv.writer(file).writerows([_HEADER, *rows])
    print(text)
    return 0


@contextlib.contextmanager
def _planner(domain: int) -> Iterator[int]:
    """A planner_node; its process id."""
    command = [sys.executable, "-m", "singulation_planner.planner_node", "--autostart"]
    process = subprocess.Popen(command, env={**os.environ, "ROS_DOMAIN_ID": str(domain)})
    try:
        yield process.pid
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(timeout=20.0)


@contextlib.contextmanager
def _client(domain: int) -> Iterator[Any]:
    """An executor with a node."""
    rclpy.init(domain_id=domain)
    node, executor = rclpy.create_node("planner_client"), SingleThreadedExecutor()
    executor.add_node(node)
    try:
        yield executor
    finally:
        executor.shutdown(timeout_sec=2.0)
        node.destroy_node()
        rclpy.try_shutdown()


def _processor_time(pid: int) -> float:
    """Of a process so far [s], all threads."""
    fields = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _row(executor: Any, client: Any, policy: str, count: int, requests: int, pid: int) -> tuple[str, ...]:
    messages = [arrangement_to_msg(clutter(count, seed, _SIZE)) for seed in range(20)]
    round_trips, planning, used = [], [], 0.0
    for number in range(requests + 10):
        if number == 10:  # the first ones find the way
            used = _processor_time(pid) + time.process_time()
        request = PlanPush.Request(arrangement=messages[number % len(messages)], policy=policy)
        request.arrangement.header.stamp = executor.get_nodes()[0].get_clock().now().to_msg()
        started = time.perf_counter()
        future = client.call_async(request)
        # spin_until_future_complete makes a new timer for every future, which takes longer with each of them.
        while not future.done():
            executor.spin_once(timeout_sec=_ANSWER_TIMEOUT)
            if time.perf_counter() > started + _ANSWER_TIMEOUT:
                raise TimeoutError(f"{policy}, {count} objects: no answer within {_ANSWER_TIMEOUT} s")
        answer = future.result()
        if answer.code != ResultCode.OK:
            raise RuntimeError(f"{policy}, {count} objects: {answer.message}")
        round_trips.append(1e3 * (time.perf_counter() - started))
        planning.append(1e3 * answer.planning_time)
    used = 1e3 * (_processor_time(pid) + time.process_time() - used) / requests
    times = np.array(round_trips[10:])
    figures = (*np.quantile(times, (0.5, 0.1, 0.95)), np.median(planning[10:]), used)
    return policy, str(count), str(requests), *(f"{figure:.2f}" for figure in figures)


if __name__ == "__main__":
    sys.exit(main())
