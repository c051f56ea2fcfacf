"""Running an executor until told to stop; nothing but that ends it."""

import threading
import time
from collections.abc import Callable
from typing import Any

from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy

_BREATH = 5e-5  # s between two turns, long enough for a thread to begin
_WAKE = 0.2  # s; an event set by a signal handler is noticed within this time even while nothing happens


def spin_until(executor: Any, stop: threading.Event, failed: Callable[[Exception], None]) -> None:
    """Spin the executor until the event is set.

    Between two turns it takes a breath. rclpy hands a callback to its threads again and again until one has begun with
    it, and a loop in Python that never waits hardly lets another thread begin: where threads wake slowly (50
    microseconds instead of 10), a message there and back took 0.3 s and as much processor time; now 0.7 ms.

    Args:
        executor: of rclpy, with its nodes.
        stop: ends the spinning.
        failed: told of what a callback threw that nobody caught, such as one inside rclpy; the spinning goes on.
    """
    while not stop.is_set():
        try:
            executor.spin_once(timeout_sec=_WAKE)
            time.sleep(_BREATH)
        except (_rclpy.InvalidHandle, _rclpy.RCLError):
            # An entity was destroyed between being listed and being waited for; the next turn does not list it.
            continue
        except Exception as error:
            failed(error)
