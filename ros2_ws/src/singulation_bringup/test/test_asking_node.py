"""A program that hears and asks nodes over ROS, and what ends its waiting."""

import threading
import time

import pytest
from rclpy.action import ActionServer, GoalResponse
from rclpy.node import Node
from singulation_msgs.action import Singulate
from std_msgs.msg import String
from std_srvs.srv import Trigger

from singulation_bringup.asking_node import AskingNode, accepted
from singulation_core import ResultCode, SingulationError
from singulation_node.qos import STATE
from singulation_node.testing import spinning, wait_until


class Program(AskingNode):
    """Waits until told that it is in vain."""

    def __init__(self, context):
        super().__init__("program", context, threads=2)
        self.in_vain = threading.Event()

    def pause(self, seconds):
        if self.in_vain.wait(seconds):
            raise SingulationError(ResultCode.CANCELLED, "in vain")


class Cell(Node):
    """Answers, says something, and takes the goals that it ``wants``."""

    def __init__(self, context):
        super().__init__("cell", context=context)
        self.wants, self.answers = False, threading.Event()
        self.create_service(Trigger, "halt", self.halt)
        self.said = self.create_publisher(String, "said", STATE)
        choose = {"goal_callback": lambda _: GoalResponse.ACCEPT if self.wants else GoalResponse.REJECT}
        self.server = ActionServer(self, Singulate, "singulate", self.execute, **choose)

    def halt(self, request, response):
        self.answers.wait(20.0)
        response.success, response.message = True, "stands"
        return response

    def execute(self, handle):
        handle.publish_feedback(Singulate.Feedback(pushes_done=3))
        handle.succeed()
        return Singulate.Result(message="separated")


@pytest.fixture
def cell(ros_context):
    made = Cell(ros_context)
    with spinning(made):
        yield made


@pytest.fixture
def program(ros_context):
    with Program(ros_context) as made:
        yield made


def test_a_service_is_asked_and_one_that_is_missing_or_silent_is_named(cell, program):
    with pytest.raises(SingulationError, match=r"service stop: nothing within 0\.1 s") as caught:
        program.call(Trigger, "stop", Trigger.Request(), ready=0.1, answer=20.0)
    assert caught.value.code is ResultCode.TIMEOUT
    with pytest.raises(SingulationError, match=r"answer of halt: nothing within 0\.1 s") as caught:
        program.call(Trigger, "halt", Trigger.Request(), ready=20.0, answer=0.1)
    assert caught.value.code is ResultCode.TIMEOUT
    cell.answers.set()
    assert program.call(Trigger, "halt", Trigger.Request(), ready=20.0, answer=20.0).message == "stands"


def test_an_action_that_is_missing_is_named_and_another_found(cell, program):
    with pytest.raises(SingulationError, match=r"action separate: nothing within 0\.1 s") as caught:
        program.send_goal(Singulate, "separate", Singulate.Goal(), ready=0.1)
    assert caught.value.code is ResultCode.TIMEOUT
    sent = program.send_goal(Singulate, "singulate", Singulate.Goal(), ready=20.0)
    assert program.wait(sent.done, 20.0, "an answer")


def test_a_callback_that_throws_hears_the_next_message(cell, program):
    heard = []

    def hear(message):
        heard.append(message.data)
        if message.data == "nonsense":
            raise ValueError(message.data)

    program.hear(String, "said", hear, STATE)
    program.wait(lambda: cell.said.get_subscription_count() == 1, 20.0, "the subscription")
    for word in ("nonsense", "sense"):
        cell.said.publish(String(data=word))
    program.wait(lambda: len(heard) == 2, 20.0, "both words")
    assert heard == ["nonsense", "sense"]


def test_a_goal_is_rejected_and_the_next_one_done(cell, program):
    told = []

    def handle():
        sent = program.send_goal(Singulate, "singulate", Singulate.Goal(), ready=20.0, feedback=told.append)
        program.wait(sent.done, 20.0, "answer of singulate")
        return accepted(sent, "singulate")

    with pytest.raises(SingulationError, match="singulate rejected the goal") as caught:
        handle()
    assert caught.value.code is ResultCode.REJECTED
    cell.wants = True
    ended = handle().get_result_async()
    program.wait(ended.done, 20.0, "the end")
    assert ended.result().result.message == "separated"
    wait_until(lambda: [one.pushes_done for one in told] == [3], what="the feedback")


def test_waiting_ends_at_once_when_it_is_in_vain(program):
    program.in_vain.set()
    began = time.monotonic()
    with pytest.raises(SingulationError, match="in vain"):
        program.wait(lambda: False, 600.0, "nothing")
    assert time.monotonic() - began < 60.0
    program.in_vain.clear()
    assert program.wait(lambda: "something", 20.0, "something") == "something"
