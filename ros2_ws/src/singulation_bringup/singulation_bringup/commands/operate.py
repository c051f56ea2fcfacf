"""Goals and services of a running cell, for machines without the ``ros2`` command.

singulate: separates what lies on the table and shows every push. Ctrl-C stops the robot and ends the goal.
halt: stops the robot; no emergency stop.
trigger_frame: takes one cloud.
reset: the simulated cell without faults, motors on.
Exit code 0: done; 1: not, and why.
"""

import argparse
import sys
from collections.abc import Sequence
from typing import Any

from singulation_msgs.action import Singulate

from singulation_bringup.asking_node import accepted
from singulation_bringup.commands.command_node import CommandNode
from singulation_bringup.commands.status import outcome_text
from singulation_core import ResultCode, SingulationError, contact_mode, conversions
from singulation_node.main import plain_arguments
from singulation_planner import POLICIES

_SERVICES = ("halt", "trigger_frame", "reset")
_PER_PUSH = 120.0  # s, longest wait for the next push; the coordinator has its own, shorter ones
_ACCEPT = 5.0  # s, for a goal to be accepted that Ctrl-C overtook
_STOP = 30.0  # s, for the robot to stand after Ctrl-C


def singulate(command: CommandNode, goal: Any, timeout: float) -> Any:
    """Result of a goal; what happens meanwhile is printed.

    Raises:
        SingulationError: ``TIMEOUT`` if there is no coordinator or it falls silent, ``REJECTED`` if it does not want
            the goal, ``CANCELLED`` on Ctrl-C, once the goal has ended.
    """
    news: list[Any] = []
    sent = command.send_goal(Singulate, "singulate", goal, ready=timeout, feedback=news.append)
    try:
        command.wait(sent.done, timeout, "answer of singulate")
        ended, shown = accepted(sent, "singulate").get_result_async(), -1
        while not ended.done():
            command.wait(lambda: ended.done() or news, _PER_PUSH, "the next push")
            shown = _show(news, shown)
    except SingulationError:
        _withdraw(command, sent)
        raise
    return ended.result().result


def _withdraw(command: CommandNode, sent: Any) -> None:
    """Cancel the goal, even one that is only just being accepted, and give the coordinator time to stop the robot."""
    if command.settle(sent.done, _ACCEPT) and sent.result().accepted:
        ended = sent.result().get_result_async()
        sent.result().cancel_goal_async()
        command.settle(ended.done, _STOP)


def _show(news: list[Any], shown: int) -> int:
    """Print what came; the number of pushes after which something was printed last."""
    while news:
        feedback = news.pop(0)
        if feedback.pushes_done > shown:  # several for each push
            print(progress_text(feedback), flush=True)
            shown = feedback.pushes_done
    return shown


def progress_text(feedback: Any) -> str:
    """Feedback in a line."""
    gap = f"{1e3 * feedback.smallest_gap:.1f} mm"
    pushes = f"{feedback.pushes_done} push{'' if feedback.pushes_done == 1 else 'es'}"
    return f"{pushes}: s(A) {feedback.singulation_distance:.3f}, smallest gap {gap}"


def result_text(result: Any) -> str:
    """How a goal ended, with its pushes."""
    pushes = [f"  push {number}: {outcome_text(one)}" for number, one in enumerate(result.outcomes, 1)]
    return "\n".join((*pushes, f"{ResultCode(result.code).name}: {result.message or 'separated'}"))


def goal_of(options: argparse.Namespace) -> Any:
    """The goal that the command line describes."""
    return Singulate.Goal(
        max_pushes=options.max_pushes,
        min_gap=options.min_gap,
        policy=options.policy,
        contact_mode=conversions.contact_mode_to_msg(contact_mode(options.contact_mode)),
    )


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Options from the command line."""
    parser = argparse.ArgumentParser(
        prog="operate", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--timeout", type=float, default=20.0, help="longest wait for an answer [s] (default 20)")
    what = parser.add_subparsers(dest="what", required=True)
    goal = what.add_parser("singulate", help="separate the blocks")
    goal.add_argument("--max-pushes", type=int, default=30, help="at most (default 30)")
    goal.add_argument("--min-gap", type=float, default=0.0, help="[m] between any two blocks (default: the node's)")
    goal.add_argument("--policy", choices=sorted(POLICIES), default="", metavar="NAME", help="default: the node's")
    goal.add_argument("--contact-mode", default="single_point", help="single_point, edge or two_point")
    for name in _SERVICES:
        what.add_parser(name, help=f"the service {name}")
    return parser.parse_args(list(arguments))


def run(command: CommandNode, options: argparse.Namespace) -> int:
    """Do it; the exit code.

    Raises:
        SingulationError: why it did not work.
    """
    if options.what != "singulate":
        said = command.trigger(options.what, ready=options.timeout, answer=options.timeout)
        print(f"{options.what}: {said or 'done'}")
        return 0
    result = singulate(command, goal_of(options), options.timeout)
    print(result_text(result))
    return 0 if result.code == ResultCode.OK else 1


def main(args: Sequence[str] | None = None) -> int:
    """Entry point."""
    arguments = list(sys.argv if args is None else args)
    options = parse(plain_arguments(arguments))
    try:
        with CommandNode("operate", arguments) as command:
            return run(command, options)
    except SingulationError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
