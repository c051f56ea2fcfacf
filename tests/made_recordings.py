"""Recordings that tests make for themselves."""

from pathlib import Path

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore
from std_msgs.msg import Header, String

from singulation_core import conversions
from singulation_perception.bag_writing import BagRecorder

FRAME = "phoxi_camera_sensor"


def write_bag(path, clouds, topic="/points"):
    """An mcap bag with one message for each (H, W, 3) cloud."""
    with BagRecorder(Path(path)) as recorder:
        for number, cloud in enumerate(clouds, start=1):
            header = Header(stamp=conversions.stamp_of(1000.0 + number), frame_id=FRAME)
            recorder.write(topic, conversions.cloud_to_msg(cloud, header), (1000 + number) * 10**9)
    return Path(path)


def write_chatter_bag(path):
    """A bag without clouds."""
    with BagRecorder(Path(path)) as recorder:
        recorder.write("/chatter", String(data="hello"), 10**9)
    return Path(path)


def write_sqlite_bag(path, cloud, topic="/camera/cloud"):
    """The same cloud as a sqlite3 bag, on a topic of another name."""
    store = get_typestore(Stores.ROS2_JAZZY)
    types = store.types
    stamp = types["builtin_interfaces/msg/Time"](sec=5, nanosec=0)
    fields = [
        types["sensor_msgs/msg/PointField"](name=name, offset=4 * place, datatype=7, count=1)
        for place, name in enumerate("xyz")
    ]
    height, width, _ = cloud.shape
    message = types["sensor_msgs/msg/PointCloud2"](
        header=types["std_msgs/msg/Header"](stamp=stamp, frame_id=FRAME),
        height=height,
        width=width,
        fields=fields,
        is_bigendian=False,
        point_step=12,
        row_step=12 * width,
        data=np.ascontiguousarray(cloud, dtype="<f4").reshape(-1).view(np.uint8),
        is_dense=False,
    )
    with Writer(Path(path), version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
        connection = writer.add_connection(topic, message.__msgtype__, typestore=store)
        writer.write(connection, 5 * 10**9, store.serialize_cdr(message, message.__msgtype__))
    return Path(path)


def bare_table(height=96, width=129):
    """(H, W, 3) cloud of the empty table as the cell's camera sees it."""
    from singulation_core import Arrangement, CellGeometry
    from singulation_sim.camera import CameraModel, PhoxiCamera

    model = CameraModel(width, height, 140.0, (width / 2 - 0.5, height / 2 - 0.5))
    return PhoxiCamera(CellGeometry(), model, seed=3).capture(Arrangement([]))
