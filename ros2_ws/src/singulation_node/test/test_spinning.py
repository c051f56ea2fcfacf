"""Entities that go away and callbacks that throw do not end the spinning."""

import threading
import time

import pytest
from rclpy.executors import MultiThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from std_msgs.msg import Empty
from std_srvs.srv import Trigger

from singulation_node.spinning import spin_until
from singulation_node.testing import call, spinning, wait_until


@pytest.fixture
def node(ros_context):
    made = Node("spun", context=ros_context)
    yield made
    made.destroy_node()


@pytest.fixture
def spin(node):
    executor, stop, failures = MultiThreadedExecutor(2, context=node.context), threading.Event(), []
    executor.add_node(node)
    thread = threading.Thread(target=spin_until, args=(executor, stop, failures.append))

    def start():
        thread.start()
        return executor, failures

    yield start
    stop.set()
    thread.join(timeout=10.0)
    executor.shutdown(timeout_sec=2.0)


def answer(request, response):
    response.success = True
    return response


def require_service(node):
    client = Node("asking", context=node.context)
    with spinning(client):
        assert call(client, Trigger, "spun/ask", Trigger.Request()).success


def test_entities_that_come_and_go_do_not_end_it(node, spin):
    node.create_service(Trigger, "spun/ask", answer)
    _, failures = spin()
    for _ in range(60):
        subscription = node.create_subscription(Empty, "nothing", lambda _: None, 1)
        publisher = node.create_publisher(Empty, "nothing", 1)
        node.destroy_subscription(subscription)
        node.destroy_publisher(publisher)
    require_service(node)
    assert not failures


@pytest.mark.parametrize("error", [rclpy_implementation.InvalidHandle, rclpy_implementation.RCLError])
def test_an_entity_destroyed_while_it_is_listed_is_passed_over(node, spin, monkeypatch, error):
    node.create_service(Trigger, "spun/ask", answer)
    executor, failures = spin()
    real, raised = executor.spin_once, threading.Event()

    def spin_once(timeout_sec):
        if not raised.is_set():
            raised.set()
            raise error("destruction was requested")
        real(timeout_sec)

    monkeypatch.setattr(executor, "spin_once", spin_once)
    wait_until(raised.is_set)
    require_service(node)
    assert not failures


def test_what_a_callback_throws_is_told_and_the_next_one_is_called(node, spin):
    calls = []

    def tick():
        calls.append(len(calls))
        if len(calls) == 1:
            raise ValueError("the first time only")

    node.create_timer(0.01, tick)
    _, failures = spin()
    wait_until(lambda: len(calls) > 3)
    assert [str(failure) for failure in failures] == ["the first time only"]


class Hasty:
    """An executor that always finds something that was handed out already."""

    turns = 0

    def spin_once(self, timeout_sec):
        self.turns += 1


def test_other_threads_get_their_turn_while_there_is_nothing_new():
    executor, stop = Hasty(), threading.Event()
    began = time.monotonic()
    thread = threading.Thread(target=spin_until, args=(executor, stop, pytest.fail))
    thread.start()
    wait_until(lambda: executor.turns > 100, what="some turns")
    stop.set()
    thread.join(timeout=10.0)
    assert executor.turns <= 1 + (time.monotonic() - began) / 5e-5
