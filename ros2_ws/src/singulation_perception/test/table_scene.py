"""A made-up camera straight above the table that sees every block's top on a regular grid: for tests of the node."""

from array import array

import numpy as np
from builtin_interfaces.msg import Time
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Header

CAMERA_POSITION = (0.0, 0.0, 0.9)
CAMERA_QUATERNION = (1.0, 0.0, 0.0, 0.0)  # x as the table's, y and z turned round
BLOCKS = ((-0.08, -0.05), (0.0, 0.06), (0.07, -0.04))  # centres [m]
HEIGHT = 0.03  # m
_HALF, _PITCH = 0.02, 0.002


def scene(blocks=BLOCKS, noise=1e-4, offset=0.0):
    """(H, W, 3) float32 points in the camera frame; ``offset`` lifts table and blocks [m]."""
    x, y = np.meshgrid(np.arange(-0.15, 0.15, _PITCH), np.arange(-0.15, 0.15, _PITCH)[::-1])
    z = np.random.default_rng(0).normal(scale=noise, size=x.shape) + offset
    for block_x, block_y in blocks:
        z += HEIGHT * ((np.abs(x - block_x) < _HALF) & (np.abs(y - block_y) < _HALF))
    return np.stack((x, -y, CAMERA_POSITION[2] - z), axis=-1).astype(np.float32)


def message(points, stamp):
    """sensor_msgs/PointCloud2 of (H, W, 3) points, ``stamp`` in nanoseconds."""
    height, width, _ = points.shape
    fields = [PointField(name=name, offset=4 * place, datatype=7, count=1) for place, name in enumerate("xyz")]
    return PointCloud2(
        header=Header(stamp=Time(sec=stamp // 10**9, nanosec=stamp % 10**9), frame_id="camera"),
        height=height,
        width=width,
        fields=fields,
        point_step=12,
        row_step=12 * width,
        data=array("B", np.ascontiguousarray(points, "<f4").tobytes()),
        is_dense=True,  # as some drivers claim whatever they send
    )
