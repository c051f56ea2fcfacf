"""Recording messages into a rosbag2 (mcap) on machines with or without ROS's own recorder."""

import threading
import weakref
from pathlib import Path
from types import TracebackType
from typing import Any

from rclpy.serialization import serialize_message
from rosbags.interfaces import Connection
from rosbags.rosbag2 import StoragePlugin, Writer

from singulation_core import ResultCode, SingulationError
from singulation_perception.bag_types import register_type, typestore


class BagRecorder:
    """Writes messages of any installed type; for use in a ``with`` block, from several threads.

    However the block ends (error, Ctrl-C, end of the interpreter), what was written so far is a complete, indexed bag.

    Args:
        path: folder of the bag; must not exist yet.

    Raises:
        SingulationError: ``BAD_FILE``: the folder exists or cannot be made.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.count = 0
        self._lock = threading.Lock()
        self._connections: dict[str, tuple[str, Connection]] = {}
        self._writer = Writer(path, version=9, storage_plugin=StoragePlugin.MCAP) if not path.exists() else None
        if self._writer is None:
            raise SingulationError(ResultCode.BAD_FILE, f"{path}: exists already; a recording is never overwritten")
        try:
            self._writer.open()
        except OSError as error:
            raise SingulationError(ResultCode.BAD_FILE, f"{path}: cannot record there: {error}") from None
        # Also when nobody leaves the ``with`` block any more: a bag without its index is hard to read.
        self._finish = weakref.finalize(self, _close, self._writer)

    def write(self, topic: str, message: Any, stamp: int) -> None:
        """Append a message.

        Args:
            topic: name with its leading slash, as ROS resolves it.
            message: instance of a generated message class.
            stamp: time of recording [ns].

        Raises:
            SingulationError: ``INVALID_INPUT`` for another type than before on this topic or one that is not
                installed; ``BAD_FILE`` if the disk does not take it; ``REJECTED`` after ``close``.
        """
        raw = serialize_message(message)
        with self._lock:
            if not self._finish.alive or self._writer is None:
                raise SingulationError(ResultCode.REJECTED, f"{self.path}: the recording is closed")
            connection = self._connection(topic, type_name(message))
            try:
                self._writer.write(connection, stamp, raw)
            except OSError as error:
                raise SingulationError(ResultCode.BAD_FILE, f"{self.path}: cannot write: {error}") from None
            self.count += 1

    def close(self) -> None:
        """Complete the bag; further calls do nothing."""
        with self._lock:
            self._finish()

    def __enter__(self) -> "BagRecorder":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _connection(self, topic: str, kind: str) -> Connection:
        known = self._connections.get(topic)
        if known is None:
            register_type(kind)
            assert self._writer is not None
            known = (kind, self._writer.add_connection(topic, kind, typestore=typestore()))
            self._connections[topic] = known
        if known[0] != kind:
            raise SingulationError(
                ResultCode.INVALID_INPUT, f"topic {topic} carries {known[0]} in {self.path}, not {kind}"
            )
        return known[1]


def type_name(message: Any) -> str:
    """``package/msg/Type`` of a generated message."""
    package, kind = type(message).__module__.split(".")[:2]
    return f"{package}/{kind}/{type(message).__name__}"


def _close(writer: Writer) -> None:
    writer.close()
