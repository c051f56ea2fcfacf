"""operate over ROS, with a small coordinator in the place of the real one."""

import threading
import time

import pytest
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from singulation_msgs.action import Singulate
from singulation_msgs.msg import PushOutcome, PushTrajectory
from std_srvs.srv import Trigger

from singulation_bringup.commands import operate
from singulation_bringup.commands.command_node import CommandNode
from singulation_core import ResultCode, SingulationError
from singulation_node.testing import spinning, wait_until


class Cell(Node):
    """Two pushes, then separated; or what ``ends_with`` says. Waits for a cancellation if ``endless``."""

    def __init__(self, context, ends_with=ResultCode.OK, endless=False, accepts=True):
        super().__init__("cell", context=context)
        self.ends_with, self.endless, self.accepts = ends_with, endless, accepts
        self.goals, self.cancelled, self.halts = [], threading.Event(), True
        self.group = ReentrantCallbackGroup()
        self.create_service(Trigger, "halt", self.halt, callback_group=self.group)
        self.server = ActionServer(
            self,
            Singulate,
            "singulate",
            self.execute,
            goal_callback=lambda _: GoalResponse.ACCEPT if self.accepts else GoalResponse.REJECT,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
            callback_group=self.group,
        )

    def halt(self, request, response):
        response.success, response.message = self.halts, "" if self.halts else "the link is down"
        return response

    def execute(self, handle):
        self.goals.append(handle.request)
        for done in range(3):
            handle.publish_feedback(
                Singulate.Feedback(pushes_done=done, singulation_distance=1.0 + 0.1 * done, smallest_gap=0.004 * done)
            )
        if self.endless:
            wait_until(lambda: handle.is_cancel_requested)
            self.cancelled.set()
            handle.canceled()
            return Singulate.Result(code=int(ResultCode.CANCELLED))
        handle.succeed()
        outcome = PushOutcome(code=0, push=PushTrajectory(target_id=4))
        return Singulate.Result(code=int(self.ends_with), message="scripted", outcomes=[outcome])


def options(*arguments):
    return operate.parse(["--timeout", "20", *arguments])


def test_a_goal_is_given_and_its_pushes_are_shown(ros_context, capsys):
    cell = Cell(ros_context)
    with spinning(cell), CommandNode("operate", context=ros_context) as command:
        wanted = ("--max-pushes", "7", "--min-gap", "0.02", "--policy", "cluster_push", "--contact-mode", "edge")
        assert operate.run(command, options("singulate", *wanted)) == 0
    said = capsys.readouterr().out
    assert "2 pushes: s(A) 1.200, smallest gap 8.0 mm" in said
    assert "push 1: OK, object 4" in said
    assert said.rstrip().endswith("OK: scripted")
    (goal,) = cell.goals
    assert (goal.max_pushes, goal.min_gap, goal.policy, goal.contact_mode.value) == (7, 0.02, "cluster_push", 1)


def test_a_goal_that_fails_says_why_and_the_next_one_works(ros_context, capsys):
    cell = Cell(ros_context, ends_with=ResultCode.NO_FRESH_VIEW)
    with spinning(cell), CommandNode("operate", context=ros_context) as command:
        assert operate.run(command, options("singulate")) == 1
        assert "NO_FRESH_VIEW: scripted" in capsys.readouterr().out
        cell.ends_with = ResultCode.OK
        assert operate.run(command, options("singulate")) == 0


def test_a_goal_that_is_not_wanted_is_told_so(ros_context):
    cell = Cell(ros_context, accepts=False)
    with spinning(cell), CommandNode("operate", context=ros_context) as command:
        with pytest.raises(SingulationError, match="rejected the goal") as caught:
            operate.run(command, options("singulate"))
        assert caught.value.code is ResultCode.REJECTED
        with pytest.raises(SingulationError, match="contact mode"):
            operate.run(command, options("singulate", "--contact-mode", "sideways"))
        cell.accepts = True
        assert operate.run(command, options("singulate")) == 0
    assert len(cell.goals) == 1


def test_ctrl_c_cancels_the_goal_before_the_command_ends(ros_context):
    cell = Cell(ros_context, endless=True)
    with spinning(cell), CommandNode("operate", context=ros_context) as command:
        pressed = threading.Thread(target=lambda: wait_until(lambda: cell.goals) and command.interrupt())
        pressed.start()
        with pytest.raises(SingulationError) as caught:
            operate.run(command, options("singulate"))
        assert caught.value.code is ResultCode.CANCELLED
        assert cell.cancelled.is_set()
        pressed.join(timeout=10.0)


def test_a_coordinator_that_falls_silent_is_told_to_stop(ros_context, monkeypatch):
    monkeypatch.setattr(operate, "_PER_PUSH", 0.3)
    cell = Cell(ros_context, endless=True)
    with spinning(cell), CommandNode("operate", context=ros_context) as command:
        with pytest.raises(SingulationError, match="the next push: nothing within") as caught:
            operate.run(command, options("singulate"))
        assert caught.value.code is ResultCode.TIMEOUT
        assert cell.cancelled.is_set()
        cell.endless = False
        monkeypatch.undo()
        assert operate.run(command, options("singulate")) == 0


def test_what_has_to_end_in_order_is_waited_for_in_spite_of_ctrl_c_but_not_for_ever(ros_context):
    with CommandNode("operate", context=ros_context) as command:
        command.interrupt()
        answers = iter((False, True))
        assert command.settle(lambda: next(answers), 20.0)
        assert not command.settle(lambda: False, 0.1)


def test_services_are_asked_by_their_names(ros_context, capsys):
    cell = Cell(ros_context)
    with spinning(cell), CommandNode("operate", context=ros_context) as command:
        cell.halts = False
        with pytest.raises(SingulationError, match="halt: the link is down") as caught:
            operate.run(command, options("halt"))
        assert caught.value.code is ResultCode.REJECTED
        cell.halts = True
        assert operate.run(command, options("halt")) == 0
    assert "halt: done" in capsys.readouterr().out


@pytest.mark.parametrize("what", ["singulate", "halt", "trigger_frame", "reset"])
def test_nobody_there_is_an_error_in_time(ros_context, what):
    with CommandNode("operate", context=ros_context) as command:
        began = time.monotonic()
        with pytest.raises(SingulationError, match=what) as caught:
            operate.run(command, operate.parse(["--timeout", "0.3", what]))
        assert caught.value.code is ResultCode.TIMEOUT
        assert time.monotonic() - began < 10.0


@pytest.mark.parametrize(
    "arguments", [(), ("dance",), ("--timeout", "soon", "halt"), ("singulate", "--policy", "wish")]
)
def test_a_command_line_that_makes_no_sense(arguments, capsys):
    with pytest.raises(SystemExit):
        operate.parse(arguments)
    assert "usage: operate" in capsys.readouterr().err
