"""The ears of a command: a node that asks and waits until Ctrl-C."""

import signal
import threading
import time
from collections.abc import Callable, Sequence
from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.signals import SignalHandlerOptions
from std_srvs.srv import Trigger

from singulation_bringup.asking_node import POLL, AskingNode
from singulation_core import ResultCode, SingulationError


class CommandNode(AskingNode):
    """For use in a ``with`` block.

    Args:
        name: of the node.
        arguments: command line with its ROS arguments; None if there are none.
        context: initialised by somebody else; None makes one and reacts to Ctrl-C.
    """

    def __init__(self, name: str, arguments: Sequence[str] | None = None, context: Context | None = None) -> None:
        self._owned = Context() if context is None else None
        self._interrupted = threading.Event()
        if self._owned:
            rclpy.init(args=list(arguments or []), context=self._owned, signal_handler_options=SignalHandlerOptions.NO)
            for number in (signal.SIGINT, signal.SIGTERM):
                signal.signal(number, lambda *_: self.interrupt())
        super().__init__(name, context or self._owned, threads=2, start_parameter_services=False)

    def __exit__(self, *_: object) -> None:
        super().__exit__()
        if self._owned:
            self._owned.try_shutdown()

    def interrupt(self) -> None:
        """What Ctrl-C does: whoever waits stops waiting."""
        self._interrupted.set()

    def pause(self, seconds: float) -> None:
        """Let time pass.

        Raises:
            SingulationError: ``CANCELLED`` on Ctrl-C.
        """
        if self._interrupted.wait(seconds):
            raise SingulationError(ResultCode.CANCELLED, "interrupted")

    def settle(self, condition: Callable[[], Any], timeout: float) -> bool:
        """Whether the condition comes true in time, whatever Ctrl-C says: for what has to end in order."""
        deadline = time.monotonic() + timeout
        while not condition():
            if time.monotonic() > deadline:
                return False
            self._stop.wait(POLL)
        return True

    def trigger(self, name: str, *, ready: float, answer: float, refusal: ResultCode = ResultCode.REJECTED) -> str:
        """What a service of std_srvs/Trigger answers.

        Args:
            name: of the service.
            ready: longest wait for the service [s].
            answer: longest wait for its answer [s].
            refusal: code of the error if it says that it did not work.

        Raises:
            SingulationError: ``TIMEOUT``, ``CANCELLED`` or ``refusal``.
        """
        response = self.call(Trigger, name, Trigger.Request(), ready=ready, answer=answer)
        if not response.success:
            raise SingulationError(refusal, f"{name}: {response.message}")
        return str(response.message)
