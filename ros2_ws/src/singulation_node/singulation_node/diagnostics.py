"""What a node says of itself on ``/diagnostics``, once a second (names as in REP 107: "node: component")."""

import threading
from dataclasses import dataclass, field
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

_PERIOD = 1.0  # s; REP 107 recommends 1 Hz


@dataclass(slots=True)
class _Component:
    level: bytes
    text: str
    values: dict[str, str] = field(default_factory=dict)


class Diagnostics:
    """Latest state of each component of a node, published by a timer."""

    def __init__(self, node: Any) -> None:
        self._node = node
        self._lock = threading.Lock()
        self._components: dict[str, _Component] = {}
        self._failures: dict[str, int] = {}
        self._publisher = node.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self._timer = node.create_timer(_PERIOD, self.publish)

    def report(self, name: str, ok: bool, text: str, /, **values: Any) -> None:
        """Replace what is said of a component; ``values`` are shown as key and value."""
        level = DiagnosticStatus.OK if ok else DiagnosticStatus.ERROR
        self._store(name, level, text, values)

    def warn(self, name: str, text: str, /, **values: Any) -> None:
        """As ``report``, for what works but deserves a look."""
        self._store(name, DiagnosticStatus.WARN, text, values)

    def count_failure(self, name: str, text: str) -> None:
        """A callback threw: an error until the node is restarted, with the number of times."""
        with self._lock:
            self._failures[name] = self._failures.get(name, 0) + 1
            count = self._failures[name]
        self._store(f"callback {name}", DiagnosticStatus.ERROR, text, {"failures": count})

    def publish(self) -> None:
        """Send the present state of all components."""
        message = DiagnosticArray()
        message.header.stamp = self._node.get_clock().now().to_msg()
        with self._lock:
            message.status = [self._status(name, part) for name, part in self._components.items()]
        self._publisher.publish(message)

    def _store(self, name: str, level: bytes, text: str, values: dict[str, Any]) -> None:
        shown = {key: f"{value:.6g}" if isinstance(value, float) else str(value) for key, value in values.items()}
        with self._lock:
            self._components[name] = _Component(level, text, shown)

    def _status(self, name: str, part: _Component) -> Any:
        pairs = [KeyValue(key=key, value=value) for key, value in part.values.items()]
        return DiagnosticStatus(
            level=part.level,
            name=f"{self._node.get_name()}: {name}",
            message=part.text,
            hardware_id="singulation",
            values=pairs,
        )
