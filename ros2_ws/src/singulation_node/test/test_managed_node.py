from dataclasses import dataclass

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from lifecycle_msgs.msg import State, Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.parameter import Parameter
from std_msgs.msg import String
from std_srvs.srv import Trigger

from singulation_core import InvalidInputError
from singulation_node.guard import guarded, guarded_service
from singulation_node.managed_node import ManagedNode
from singulation_node.parameters import parameter
from singulation_node.testing import Mailbox, call, spinning, wait_until


@dataclass(frozen=True)
class Settings:
    broken: bool = parameter(False, "whether configure fails")
    crash: bool = parameter(False, "whether activate throws something unexpected")


class Echo(ManagedNode[Settings]):
    """Repeats what it hears; throws on "throw"."""

    def __init__(self, **options):
        super().__init__("echo", Settings, **options)

    def configure(self):
        if self.settings.broken:
            raise InvalidInputError("broken is true, need false")
        self._out = self.create_publisher(String, "out", 10)

    def activate(self):
        if self.settings.crash:
            raise ZeroDivisionError("unexpected")
        self.create_subscription(String, "in", self._repeat, 10)
        self.create_service(Trigger, "throw", self._throw)

    @guarded
    def _repeat(self, message):
        if message.data == "throw":
            raise ValueError("asked to")
        self._out.publish(message)

    @guarded_service
    def _throw(self, request, response):
        raise InvalidInputError("never right")


@pytest.fixture
def node(ros_context):
    made = Echo(context=ros_context)
    with spinning(made):
        yield made


def change(node, transition):
    return call(
        node, ChangeState, "echo/change_state", ChangeState.Request(transition=Transition(id=transition))
    ).success


def state(node):
    return call(node, GetState, "echo/get_state", GetState.Request()).current_state.id


def said(mailbox, name):
    statuses = [status for message in mailbox.messages for status in message.status if status.name == f"echo: {name}"]
    return statuses[-1] if statuses else None


def test_it_hears_only_while_active(node):
    replies = Mailbox(node, String, "out")
    sender = node.create_publisher(String, "in", 10)
    assert change(node, Transition.TRANSITION_CONFIGURE)
    assert sender.get_subscription_count() == 0
    for _ in range(3):
        assert change(node, Transition.TRANSITION_ACTIVATE)
        wait_until(lambda: sender.get_subscription_count() == 1, what="subscription")
        count = len(replies.messages)
        sender.publish(String(data="hello"))
        replies.wait(count + 1)
        assert change(node, Transition.TRANSITION_DEACTIVATE)
        wait_until(lambda: sender.get_subscription_count() == 0, what="no subscription")
    assert change(node, Transition.TRANSITION_CLEANUP)
    assert state(node) == State.PRIMARY_STATE_UNCONFIGURED


def test_a_throwing_callback_is_reported_and_the_next_message_is_served(node):
    replies, diagnostics = Mailbox(node, String, "out"), Mailbox(node, DiagnosticArray, "/diagnostics")
    sender = node.create_publisher(String, "in", 10)
    assert node.start()
    wait_until(lambda: sender.get_subscription_count() == 1)
    sender.publish(String(data="throw"))
    failure = wait_until(lambda: said(diagnostics, "callback _repeat"), what="diagnostics")
    assert failure.level == DiagnosticStatus.ERROR
    assert "asked to" in failure.message
    sender.publish(String(data="good"))
    assert replies.wait().data == "good"


def test_a_throwing_service_answers_with_its_reason(node):
    assert node.start()
    answer = call(node, Trigger, "throw", Trigger.Request())
    assert not answer.success
    assert answer.message == "never right"
    assert node.is_active


@pytest.mark.parametrize(
    ("flag", "reason", "reached"),
    [
        ("broken", "broken is true, need false", State.PRIMARY_STATE_UNCONFIGURED),
        ("crash", "unexpected", State.PRIMARY_STATE_INACTIVE),
    ],
)
def test_a_failed_transition_says_why_and_works_once_mended(node, flag, reason, reached):
    diagnostics = Mailbox(node, DiagnosticArray, "/diagnostics")
    node.set_parameters([Parameter(flag, value=True)])
    assert not node.start()
    wait_until(lambda: (found := said(diagnostics, "state")) and reason in found.message, what="reason")
    assert state(node) == reached
    node.set_parameters([Parameter(flag, value=False)])
    if reached == State.PRIMARY_STATE_UNCONFIGURED:
        assert change(node, Transition.TRANSITION_CONFIGURE)
    assert change(node, Transition.TRANSITION_ACTIVATE)
    assert node.is_active


def test_shutdown_from_active_releases_everything(node):
    assert node.start()
    assert change(node, Transition.TRANSITION_ACTIVE_SHUTDOWN)
    assert not node.is_active
    assert not [item for item in node.subscriptions if item.topic_name == "/in"]
