"""Point clouds from rosbag2 recordings, sqlite3 or mcap, one at a time: memory does not grow with the bag."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rosbags.rosbag2 import Reader

from singulation_core import SingulationError
from singulation_perception.bag_types import typestore
from singulation_perception.clouds import CloudField, CloudLayout, RecordedCloud
from singulation_perception.point_records import bad_file

CLOUD_TYPE = "sensor_msgs/msg/PointCloud2"
_STORAGE = (".mcap", ".db3")


@dataclass(frozen=True, slots=True)
class BagTopic:
    """A topic of a recording: name, ``package/msg/Type``, number of messages."""

    name: str
    type: str
    count: int

    def __str__(self) -> str:
        return f"{self.name} ({self.type}, {self.count} messages)"


def is_bag(path: Path) -> bool:
    """Whether the path is a folder or a storage file of a rosbag2, by its looks; its content is not read."""
    return path.is_dir() or path.suffix in _STORAGE


def bag_topics(path: Path) -> list[BagTopic]:
    """All topics of a recording.

    Raises:
        SingulationError: ``BAD_FILE``: missing, cut off, damaged, or no recording.
    """
    topics: dict[tuple[str, str], int] = {}
    for storage in _storages(path):
        with _opened(storage) as reader:
            for connection in reader.connections:
                key = (connection.topic, connection.msgtype)
                topics[key] = topics.get(key, 0) + connection.msgcount
    return [BagTopic(name, kind, count) for (name, kind), count in sorted(topics.items())]


def cloud_topic(path: Path, wanted: str = "") -> BagTopic:
    """The topic to read clouds from: ``wanted``, or the only one with clouds.

    Raises:
        SingulationError: ``BAD_FILE`` listing the topics: no clouds at all, none under that name, or several to
            choose from.
    """
    topics = bag_topics(path)
    clouds = [topic for topic in topics if topic.type == CLOUD_TYPE and topic.count > 0]
    listed = "; ".join(str(topic) for topic in topics) or "no topics at all"
    if wanted:
        clouds = [topic for topic in clouds if topic.name.strip("/") == wanted.strip("/")]
        if not clouds:
            raise bad_file(path, f"no clouds ({CLOUD_TYPE}) on topic {wanted!r}; the bag has: {listed}")
    if not clouds:
        raise bad_file(path, f"no topic with clouds ({CLOUD_TYPE}); the bag has: {listed}")
    if len(clouds) > 1:
        raise bad_file(path, f"several topics have clouds, choose one: {', '.join(topic.name for topic in clouds)}")
    return clouds[0]


def read_bag_clouds(path: Path, topic: str = "") -> Iterator[RecordedCloud]:
    """The clouds of one topic in the order they were recorded.

    Args:
        path: rosbag2 folder, or one of its ``.mcap`` or ``.db3`` files.
        topic: needed only if several topics carry clouds.

    Raises:
        SingulationError: as ``cloud_topic``; and ``BAD_FILE`` where the recording turns out to be damaged, with the
            number of clouds that could be read before.
    """
    chosen = cloud_topic(path, topic)
    number = 0
    for storage in _storages(path):
        with _opened(storage, f"after {number} clouds") as reader:
            connections = [one for one in reader.connections if (one.topic, one.msgtype) == (chosen.name, CLOUD_TYPE)]
            messages = reader.messages(connections) if connections else iter(())
            while (entry := _next(messages, storage, number)) is not None:
                number += 1
                yield _cloud(entry[1], entry[0], f"{path} {chosen.name} #{number}")


def _storages(path: Path) -> Sequence[Path]:
    """What to open: the folder if its metadata is there, else its storage files, the traces of an interruption."""
    if not path.exists():
        raise bad_file(path, "no such file or folder")
    if not path.is_dir():
        if path.suffix not in _STORAGE:
            raise bad_file(path, f"ending {path.suffix!r}, need a rosbag2 folder or one of {_STORAGE}")
        return [path]
    if (path / "metadata.yaml").is_file():
        return [path]
    content = sorted(path.iterdir())
    storages = [item for item in content if item.suffix in _STORAGE]
    if not storages:
        names = ", ".join(item.name for item in content[:20]) or "nothing"
        raise bad_file(path, f"not a rosbag2: neither metadata.yaml nor {' nor '.join(_STORAGE)} files; it has {names}")
    return storages


@contextmanager
def _opened(path: Path, progress: str = "") -> Iterator[Reader]:
    """An open reader; whatever a damaged recording makes it throw becomes ``BAD_FILE``."""
    try:
        reader = Reader(path)
        reader.open()
    except Exception as error:
        raise bad_file(path, f"cannot be read {progress}: {_reason(error)}; {_inventory(path)}") from None
    try:
        yield reader
    finally:
        reader.close()


def _next(messages: Iterator[Any], path: Path, number: int) -> tuple[int, bytes] | None:
    try:
        entry = next(messages, None)
    except Exception as error:
        raise bad_file(path, f"damaged after {number} clouds: {_reason(error)}; {_inventory(path)}") from None
    return None if entry is None else (entry[1], entry[2])


def _cloud(raw: bytes, recorded: int, source: str) -> RecordedCloud:
    try:
        message: Any = typestore().deserialize_cdr(raw, CLOUD_TYPE)
    except Exception as error:
        raise bad_file(Path(source), f"the message is damaged: {_reason(error)}") from None
    fields = tuple(CloudField(one.name, one.offset, one.datatype, one.count) for one in message.fields)
    layout = CloudLayout(
        message.height, message.width, message.point_step, message.row_step, fields, message.is_bigendian
    )
    stamp = message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec
    return RecordedCloud(layout, message.data, message.header.frame_id, stamp, recorded, source)


def _reason(error: Exception) -> str:
    if isinstance(error, SingulationError):
        return error.message
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__


def _inventory(path: Path) -> str:
    """What lies there, so that one sees at a glance which part is missing or too short."""
    files = sorted(path.iterdir()) if path.is_dir() else [path]
    return "there are " + ", ".join(f"{file.name} ({file.stat().st_size} bytes)" for file in files[:20])
