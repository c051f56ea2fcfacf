"""Lifecycle nodes from outside: their state, and transitions that say why they failed."""

from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from lifecycle_msgs.msg import State, Transition
from lifecycle_msgs.srv import ChangeState, GetState

from singulation_bringup.commands.command_node import CommandNode
from singulation_core import ResultCode, SingulationError
from singulation_node.qos import STATE

_ANSWER = 10.0  # s; get_state is answered at once by a node that lives
_REASON = 2.5  # s; diagnostics come once a second
_STEPS = {
    "configure": (Transition.TRANSITION_CONFIGURE, State.PRIMARY_STATE_UNCONFIGURED, State.PRIMARY_STATE_INACTIVE),
    "activate": (Transition.TRANSITION_ACTIVATE, State.PRIMARY_STATE_INACTIVE, State.PRIMARY_STATE_ACTIVE),
}


class Lifecycle:
    """Drives lifecycle nodes and remembers what they say of themselves.

    Args:
        command: node to ask through.
    """

    def __init__(self, command: CommandNode) -> None:
        self._command = command
        self._statuses: dict[str, tuple[bytes, str]] = {}
        command.hear(DiagnosticArray, "/diagnostics", self._on_diagnostics, STATE)

    def said(self, component: str) -> tuple[bytes, str]:
        """Level and text of a component such as ``planner_node: state``; empty before it has spoken."""
        return self._statuses.get(component, (b"", ""))

    def forget(self, component: str) -> None:
        """Wait for what is said from now on."""
        self._statuses.pop(component, None)

    def state(self, node: str, ready: float) -> Any:
        """``lifecycle_msgs/State`` of a node.

        Raises:
            SingulationError: ``TIMEOUT``: there is no such node.
        """
        answer = self._command.call(GetState, f"{node}/get_state", GetState.Request(), ready=ready, answer=_ANSWER)
        return answer.current_state

    def step(self, node: str, name: str, timeout: float) -> None:
        """``configure`` or ``activate``; nothing if the node is there already.

        Raises:
            SingulationError: ``TIMEOUT``; ``NOT_READY`` with the node's own reason.
        """
        transition, start, goal = _STEPS[name]
        now = self.state(node, timeout)
        if now.id in (State.PRIMARY_STATE_ACTIVE, goal):
            return
        if now.id != start:
            raise SingulationError(ResultCode.NOT_READY, f"{node} is {now.label}, cannot {name} it; restart it")
        self.forget(f"{node}: state")
        request = ChangeState.Request(transition=Transition(id=transition))
        answer = self._command.call(ChangeState, f"{node}/change_state", request, ready=_ANSWER, answer=timeout)
        if not answer.success:
            raise SingulationError(ResultCode.NOT_READY, f"{node} could not {name}: {self._reason(node)}")

    def _reason(self, node: str) -> str:
        def said() -> str:
            level, text = self.said(f"{node}: state")
            return text if level == DiagnosticStatus.ERROR else ""

        try:
            return self._command.wait(said, _REASON, "reason")
        except SingulationError:
            return "it gave no reason; see its log"

    def _on_diagnostics(self, message: Any) -> None:
        for status in message.status:
            self._statuses[status.name] = (status.level, status.message)
