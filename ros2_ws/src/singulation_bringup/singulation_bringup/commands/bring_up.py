"""Configures and activates the nodes of a cell in order, each with a reason if it does not work.

First all are configured, then perception is activated and shown a cloud, then the others, the robot's last: nothing
that could move it is active while the camera does not see the table where the calibration says. Run it again after
mending what it complains about; nodes that are active already are left alone.
"""

import argparse
import sys
from collections.abc import Sequence
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from singulation_msgs.msg import Arrangement

from singulation_bringup.commands.command_node import CommandNode
from singulation_bringup.commands.lifecycle import Lifecycle
from singulation_core import ResultCode, SingulationError
from singulation_node.main import plain_arguments
from singulation_node.qos import STATE

DEFAULT_NODES = ("perception_node", "planner_node", "singulate_node", "executor_node")
_CLOUDS = "perception_node: clouds"


def bring_up(command: CommandNode, options: argparse.Namespace) -> None:
    """Bring the nodes up.

    Raises:
        SingulationError: why it did not work.
    """
    lifecycle = Lifecycle(command)
    for node in options.nodes:
        print(f"configuring {node}", flush=True)
        lifecycle.step(node, "configure", options.timeout)
    seen: list[Any] = []
    if options.check_camera:
        command.hear(Arrangement, "objects", seen.append, STATE)
    for node in options.nodes:
        lifecycle.step(node, "activate", options.timeout)
        print(f"active: {node}", flush=True)
        if options.check_camera and node == "perception_node":
            _check_camera(command, lifecycle, seen, options)


def _check_camera(command: CommandNode, lifecycle: Lifecycle, seen: list[Any], options: argparse.Namespace) -> None:
    """One cloud has to be accepted, or a wrong pose of camera or table goes unnoticed until the first push.

    Raises:
        SingulationError: ``NO_FRESH_VIEW`` with what perception says of the cloud.
    """
    if options.trigger:
        waits = {"ready": options.timeout, "answer": options.view_timeout}
        command.trigger(options.trigger, **waits, refusal=ResultCode.NO_FRESH_VIEW)
    command.wait(lambda: seen or _rejection(lifecycle), options.view_timeout, "a cloud on points")
    if not seen:
        raise SingulationError(
            ResultCode.NO_FRESH_VIEW, f"perception refuses the camera's cloud: {_rejection(lifecycle)}"
        )
    print(f"camera and table are where they should be; {len(seen[-1].objects)} objects in view", flush=True)


def _rejection(lifecycle: Lifecycle) -> str:
    level, text = lifecycle.said(_CLOUDS)
    return text if level == DiagnosticStatus.ERROR else ""


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Options from the command line."""
    parser = argparse.ArgumentParser(prog="bring_up", description=__doc__)
    parser.add_argument("--nodes", nargs="+", default=DEFAULT_NODES, metavar="NODE", help="in this order")
    parser.add_argument("--check-camera", action="store_true", help="one cloud has to be accepted before going on")
    parser.add_argument(
        "--trigger",
        default="trigger_frame",
        help='service that triggers the camera (std_srvs/Trigger), "" if it runs freely (default trigger_frame)',
    )
    parser.add_argument("--timeout", type=float, default=180.0, help="for each step [s]; the first start compiles")
    parser.add_argument("--view-timeout", type=float, default=30.0, help="for the cloud of --check-camera [s]")
    return parser.parse_args(list(arguments))


def main(args: Sequence[str] | None = None) -> int:
    """Entry point."""
    arguments = list(sys.argv if args is None else args)
    options = parse(plain_arguments(arguments))
    try:
        with CommandNode("bring_up", arguments) as command:
            bring_up(command, options)
    except SingulationError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    print("everything is active")
    return 0


if __name__ == "__main__":
    sys.exit(main())
