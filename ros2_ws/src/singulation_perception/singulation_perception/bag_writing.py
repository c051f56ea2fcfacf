"""Recording messages into a rosbag2 (mcap, chunks compressed with zstd), with or without ROS's own recorder."""

import queue
import threading
import weakref
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Any

from rclpy.serialization import serialize_message
from rosbags.interfaces import Connection
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

from singulation_core import ResultCode, SingulationError
from singulation_perception.bag_types import register_type, typestore

_WAITING = 8  # messages; of the largest clouds these are 300 MB
_PATIENCE = 30.0  # s for the disk to take one of them
_CLOSING = 120.0  # s for the disk to take the rest


@dataclass(frozen=True, slots=True)
class _Entry:
    topic: str
    kind: str
    stamp: int
    raw: bytes


@dataclass(slots=True)
class _Tape:
    """What the writing thread works on; knows nothing of the recorder, so that a forgotten recorder still ends."""

    path: Path
    writer: Writer
    entries: "queue.Queue[_Entry | None]" = field(default_factory=lambda: queue.Queue(_WAITING))
    failure: SingulationError | None = None


class BagRecorder:
    """Writes messages of any installed type; for use in a ``with`` block, from several threads.

    However the block ends (error, Ctrl-C, end of the interpreter), what was written so far is a complete, indexed bag:
    a thread of its own writes, which no signal interrupts.

    Args:
        path: folder of the bag; must not exist yet.

    Raises:
        SingulationError: ``BAD_FILE``: the folder exists or cannot be made.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.count = 0
        self._kinds: dict[str, str] = {}
        self._lock = threading.Lock()
        self._tape = _Tape(path, _open(path))
        self._thread = threading.Thread(target=_record, args=(self._tape,), name="bag recorder", daemon=True)
        self._thread.start()
        self._finish = weakref.finalize(self, _end, self._tape, self._thread)

    def write(self, topic: str, message: Any, stamp: int) -> None:
        """Append a message.

        Args:
            topic: name with its leading slash, as ROS resolves it.
            message: instance of a generated message class.
            stamp: time of recording [ns].

        Raises:
            SingulationError: ``INVALID_INPUT`` for another type than before on this topic or one that is not
                installed; ``BAD_FILE`` if the disk does not take what came before; ``REJECTED`` after ``close``.
        """
        kind = type_name(message)
        raw = serialize_message(message)
        with self._lock:
            self._require_open()
            self._require_type(topic, kind)
            try:
                self._tape.entries.put(_Entry(topic, kind, stamp, raw), timeout=_PATIENCE)
            except queue.Full:
                raise SingulationError(
                    ResultCode.BAD_FILE, f"{self.path}: nothing could be written for {_PATIENCE:.0f} s"
                ) from None
            self.count += 1

    def close(self) -> None:
        """Complete the bag; further calls do nothing.

        Raises:
            SingulationError: ``BAD_FILE`` if the disk did not take all of it.
        """
        with self._lock:
            self._finish()
        if self._tape.failure is not None:
            raise self._tape.failure

    def __enter__(self) -> "BagRecorder":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _require_open(self) -> None:
        if self._tape.failure is not None:
            raise self._tape.failure
        if not self._finish.alive:
            raise SingulationError(ResultCode.REJECTED, f"{self.path}: the recording is closed")

    def _require_type(self, topic: str, kind: str) -> None:
        if topic not in self._kinds:
            register_type(kind)
            self._kinds[topic] = kind
        if self._kinds[topic] != kind:
            raise SingulationError(
                ResultCode.INVALID_INPUT, f"topic {topic} carries {self._kinds[topic]} in {self.path}, not {kind}"
            )


def type_name(message: Any) -> str:
    """``package/msg/Type`` of a generated message."""
    package, kind = type(message).__module__.split(".")[:2]
    return f"{package}/{kind}/{type(message).__name__}"


def _open(path: Path) -> Writer:
    if path.exists():
        raise SingulationError(ResultCode.BAD_FILE, f"{path}: exists already; a recording is never overwritten")
    writer = Writer(path, version=9, storage_plugin=StoragePlugin.MCAP)
    writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    try:
        writer.open()
    except OSError as error:
        raise SingulationError(ResultCode.BAD_FILE, f"{path}: cannot record there: {error}") from None
    return writer


def _record(tape: _Tape) -> None:
    """The writing thread: entries until None; after a failure they are only taken, so that nobody waits for room."""
    connections: dict[str, Connection] = {}
    while (entry := tape.entries.get()) is not None:  # unbounded on purpose: ended by _end
        if tape.failure is None:
            _guarded(tape, _write, tape.writer, connections, entry)
    _guarded(tape, tape.writer.close)


def _write(writer: Writer, connections: dict[str, Connection], entry: _Entry) -> None:
    if entry.topic not in connections:
        connections[entry.topic] = writer.add_connection(entry.topic, entry.kind, typestore=typestore())
    writer.write(connections[entry.topic], entry.stamp, entry.raw)


def _guarded(tape: _Tape, step: Any, *arguments: Any) -> None:
    try:
        step(*arguments)
    except Exception as error:
        text = f"{tape.path}: cannot write: {type(error).__name__}: {error}"
        tape.failure = tape.failure or SingulationError(ResultCode.BAD_FILE, text)


def _end(tape: _Tape, thread: threading.Thread) -> None:
    tape.entries.put(None, timeout=_CLOSING)
    thread.join(_CLOSING)
    if thread.is_alive() and tape.failure is None:
        tape.failure = SingulationError(ResultCode.BAD_FILE, f"{tape.path}: not complete after {_CLOSING:.0f} s")
