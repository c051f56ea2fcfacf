"""One screen about a running cell: nodes and their states, rates, the robot, the last outcomes.

Exit code 0 if the cell could push now, 1 if something is in the way; the screen says what.
"""

import argparse
import sys
import time
from collections.abc import Callable, Sequence
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import JointState
from singulation_msgs.msg import Arrangement, DriverState, PushOutcome, PushTrajectory

from singulation_bringup.commands.command_node import CommandNode
from singulation_bringup.commands.overview import Component, Overview, Traffic, screen
from singulation_core import ResultCode, SingulationError
from singulation_node.main import plain_arguments
from singulation_node.qos import LATCHED, STATE

WANTED = ("perception_node", "planner_node", "executor_node", "singulate_node")
_CLEAR = "\033[2J\033[H"
_MODES = {
    getattr(DriverState, name): name
    for name in ("MOTORS_OFF", "MOTORS_ON", "GUARD_STOP", "EMERGENCY_STOP", "COLLISION_STOP", "SYSTEM_FAILURE")
}


def listen(command: CommandNode, overview: Overview) -> None:
    """Hear what the cell says from now on."""
    command.hear(DiagnosticArray, "/diagnostics", lambda message: _note_diagnostics(overview, message), STATE)
    topics: tuple[tuple[str, Any, Callable[[Any], str], Any], ...] = (
        ("joint_states", JointState, lambda message: f"{len(message.name)} joints", STATE),
        ("driver_state", DriverState, driver_text, STATE),
        ("objects", Arrangement, lambda message: f"{len(message.objects)} objects", STATE),
        ("push", PushTrajectory, push_text, STATE),
        ("last_outcome", PushOutcome, outcome_text, LATCHED),
        ("outcomes", PushOutcome, outcome_text, LATCHED),
    )
    for name, kind, text, qos in topics:
        traffic = overview.topics.setdefault(name, Traffic())

        def note(message: Any, traffic: Traffic = traffic, text: Callable[[Any], str] = text) -> None:
            traffic.note(time.monotonic(), text(message))

        command.hear(kind, name, note, qos)


def driver_text(message: Any) -> str:
    """A driver state in a line."""
    hands = [
        side
        for side, good in (("left", message.left_gripper_calibrated), ("right", message.right_gripper_calibrated))
        if not good
    ]
    parts = [_MODES.get(message.mode, f"mode {message.mode}")]
    parts.append("takes motions" if message.motion_enabled else "takes no motions")
    parts += [f"{' and '.join(hands)} gripper not calibrated"] if hands else []
    return ", ".join(parts) + (f": {message.message}" if message.message else "")


def push_text(message: Any) -> str:
    """A planned push in a line."""
    shift = (message.end.x - message.start.x, message.end.y - message.start.y)
    return f"object {message.target_id} by {1e3 * (shift[0] ** 2 + shift[1] ** 2) ** 0.5:.0f} mm, {message.policy}"


def outcome_text(message: Any) -> str:
    """An outcome in a line."""
    known = message.code in ResultCode._value2member_map_
    name = ResultCode(message.code).name if known else f"code {message.code}"
    return f"{name}, object {message.push.target_id}" + (f": {message.message}" if message.message else "")


def _note_diagnostics(overview: Overview, message: Any) -> None:
    now = time.monotonic()
    for status in message.status:
        values = {pair.key: pair.value for pair in status.values}
        overview.hear(status.name, Component(status.level[0], status.message, values, now))


def show(command: CommandNode, overview: Overview, options: argparse.Namespace) -> int:
    """Print the screen; the exit code."""
    overview.present = set(command.node.get_node_names())
    now = time.monotonic()
    title = f"singulation cell, {time.strftime('%Y-%m-%d %H:%M:%S')}, the last {options.seconds:g} s"
    text = screen(overview, now, options.seconds, title, options.all)
    print(f"{_CLEAR}{text}" if options.watch else text, flush=True)
    return 1 if overview.problems(now, options.seconds) else 0


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Options from the command line."""
    parser = argparse.ArgumentParser(prog="status", description=__doc__)
    parser.add_argument("--seconds", type=_seconds, default=4.0, help="how long to listen (default 4)")
    parser.add_argument("--watch", action="store_true", help="again and again until Ctrl-C")
    parser.add_argument("--all", action="store_true", help="every part of every node with its values")
    parser.add_argument("--nodes", nargs="+", default=WANTED, metavar="NODE", help="nodes that have to be active")
    return parser.parse_args(list(arguments))


def _seconds(text: str) -> float:
    value = float(text)
    if not (2.0 <= value <= 3600.0):  # diagnostics come once a second
        raise argparse.ArgumentTypeError(f"{text}, need 2 to 3600")
    return value


def main(args: Sequence[str] | None = None) -> int:
    """Entry point."""
    arguments = list(sys.argv if args is None else args)
    options = parse(plain_arguments(arguments))
    overview, code = Overview(tuple(options.nodes)), 1
    try:
        with CommandNode("status", arguments) as command:
            listen(command, overview)
            command.pause(options.seconds)
            code = show(command, overview, options)
            while options.watch:
                command.pause(1.0)
                code = show(command, overview, options)
    except SingulationError as error:
        if error.code is not ResultCode.CANCELLED:
            print(f"error: {error}", file=sys.stderr)
            return 1
    return code


if __name__ == "__main__":
    sys.exit(main())
