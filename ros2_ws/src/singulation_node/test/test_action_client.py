"""An answer that comes before its sender has noted that it waits for it."""

import threading

import pytest
from rclpy.action import ActionServer
from rclpy.node import Node
from singulation_msgs.action import Singulate

from singulation_node.action_client import PatientActionClient
from singulation_node.testing import spinning, wait_until


class Hasty:
    """The lower level of a client that returns from sending only once the answer is there, or was asked for."""

    def __init__(self, real, answered):
        self._real, self._answered = real, answered

    def __getattr__(self, name):
        return getattr(self._real, name)

    def send_goal_request(self, request):
        return self._sent(self._real.send_goal_request, request)

    def send_result_request(self, request):
        return self._sent(self._real.send_result_request, request)

    def _sent(self, send, request):
        self._answered.clear()
        number = send(request)
        assert self._answered.wait(5.0)
        return number


class Watched(PatientActionClient):
    """Says when an answer is about to be taken."""

    def __init__(self, *arguments):
        self.answered = threading.Event()
        super().__init__(*arguments)
        self._client_handle = Hasty(self._client_handle, self.answered)

    def take_data(self):
        self.answered.set()
        return super().take_data()


@pytest.fixture
def client(ros_context):
    node, other = Node("asking", context=ros_context), Node("answering", context=ros_context)

    def done(goal):
        goal.succeed()
        return Singulate.Result(message="done")

    server = ActionServer(other, Singulate, "singulate", done)
    made = Watched(node, Singulate, "singulate")
    with spinning(node, other, threads=4):
        wait_until(made.server_is_ready, what="singulate")
        yield made
        made.destroy()
        server.destroy()


def test_answers_that_come_at_once_are_not_lost(client):
    for _ in range(3):
        sent = client.send_goal_async(Singulate.Goal())
        wait_until(sent.done, what="answer")
        assert sent.result().accepted
        ended = sent.result().get_result_async()
        wait_until(ended.done, what="result")
        assert ended.result().result.message == "done"
