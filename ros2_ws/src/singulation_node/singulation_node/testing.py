"""What node tests need: a domain of their own, nodes that spin in the background, waiting for conditions."""

import contextlib
import gc
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import MultiThreadedExecutor

from singulation_node.domain import reserved_domain
from singulation_node.qos import STATE
from singulation_node.spinning import spin_until


@pytest.fixture
def ros_context() -> Iterator[Context]:
    """An initialised context in a domain of its own; nodes of the test are made with ``context=ros_context``."""
    context = Context()
    with reserved_domain() as domain:
        rclpy.init(context=context, domain_id=domain)
        try:
            yield context
        finally:
            context.try_shutdown()
            # Nodes are in reference cycles. Until those are collected, their DDS participant keeps its place in the
            # domain, and after some thirty of them other processes are no longer found.
            gc.collect()


@contextlib.contextmanager
def spinning(*nodes: Any, threads: int = 4) -> Iterator[None]:
    """The nodes (of one context) run in the background as long as the block runs; they are destroyed at its end."""
    executor = MultiThreadedExecutor(num_threads=threads, context=nodes[0].context)
    for node in nodes:
        executor.add_node(node)
    stop, failures = threading.Event(), list[Exception]()
    thread = threading.Thread(target=spin_until, args=(executor, stop, failures.append), daemon=True)
    thread.start()
    try:
        yield
        assert not failures, f"callbacks threw {failures}"
    finally:
        stop.set()
        executor.wake()
        thread.join(timeout=10.0)
        for node in nodes:
            executor.remove_node(node)
            node.destroy_node()
        executor.shutdown(timeout_sec=2.0)


def wait_until(condition: Callable[[], Any], timeout: float = 20.0, what: str = "the condition") -> Any:
    """The first true value of ``condition``; fails the test after ``timeout`` [s]."""
    deadline = time.monotonic() + timeout
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > deadline:
            pytest.fail(f"{what} did not come true within {timeout} s")
        time.sleep(0.005)


class Mailbox:
    """All messages of a topic, in order."""

    def __init__(self, node: Any, message_type: Any, topic: str, qos: Any = STATE) -> None:
        self.messages: list[Any] = []
        self._subscription = node.create_subscription(message_type, topic, self.messages.append, qos)

    def wait(self, count: int = 1, timeout: float = 20.0) -> Any:
        """The newest message once at least ``count`` have come."""
        name = self._subscription.topic_name
        wait_until(lambda: len(self.messages) >= count, timeout, f"message {count} on {name}")
        return self.messages[-1]


def call(node: Any, service_type: Any, name: str, request: Any, timeout: float = 20.0) -> Any:
    """The answer of a service; ``node`` must be spinning."""
    client = node.create_client(service_type, name)
    try:
        wait_until(client.service_is_ready, timeout, f"service {name}")
        future = client.call_async(request)
        wait_until(future.done, timeout, f"answer of {name}")
        return future.result()
    finally:
        node.destroy_client(client)
