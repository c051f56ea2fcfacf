"""Small recordings for the tests, written by rosbags from its own message classes: not by the code under test."""

from pathlib import Path

import numpy as np
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

STORE = get_typestore(Stores.ROS2_JAZZY)
SECOND = 10**9


def header(stamp, frame):
    time = STORE.types["builtin_interfaces/msg/Time"](sec=stamp // SECOND, nanosec=stamp % SECOND)
    return STORE.types["std_msgs/msg/Header"](stamp=time, frame_id=frame)


def cloud(points, stamp=SECOND, frame="phoxi_camera_sensor"):
    """sensor_msgs/PointCloud2 of (H, W, 3) points."""
    height, width, _ = points.shape
    kind = STORE.types["sensor_msgs/msg/PointField"]
    return STORE.types["sensor_msgs/msg/PointCloud2"](
        header=header(stamp, frame),
        height=height,
        width=width,
        fields=[kind(name=name, offset=4 * place, datatype=7, count=1) for place, name in enumerate("xyz")],
        is_bigendian=False,
        point_step=12,
        row_step=12 * width,
        data=np.ascontiguousarray(points, "<f4").reshape(-1).view(np.uint8),
        is_dense=False,
    )


def text(words="hello"):
    return STORE.types["std_msgs/msg/String"](data=words)


def write_bag(folder, messages, storage="mcap", compression=None):
    """A rosbag2 of (topic, message, time [ns])."""
    writer = Writer(Path(folder), version=9, storage_plugin=StoragePlugin[storage.upper()])
    if compression:
        writer.set_compression(CompressionMode[compression], CompressionFormat.ZSTD)
    connections = {}
    with writer:
        for topic, message, time in messages:
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, message.__msgtype__, typestore=STORE)
            writer.write(connections[topic], time, STORE.serialize_cdr(message, message.__msgtype__))
    return Path(folder)


def cloud_bag(folder, count=3, shape=(4, 5), topic="/points", storage="mcap", compression=None):
    """A bag of random clouds, one a second from 100 s on (stamps 20 ms earlier), and the points of each."""
    points = np.random.default_rng(3).normal(size=(count, *shape, 3)).astype(np.float32)
    messages = []
    for number in range(count):
        time = (100 + number) * SECOND
        messages.append((topic, cloud(points[number], time - SECOND // 50), time))
    return write_bag(folder, messages, storage, compression), points
