"""Clouds for a command: from the camera, or from a recording."""

from collections.abc import Sequence
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

from numpy.typing import NDArray
from sensor_msgs.msg import PointCloud2

from singulation_bringup.commands.command_node import CommandNode
from singulation_core import ResultCode
from singulation_node.large_messages import prepare_for_large_messages
from singulation_node.qos import SENSOR_IN
from singulation_perception.cloud_messages import points_from_msg
from singulation_perception.decoding import decode_points
from singulation_perception.playback import find_recording


def recorded_clouds(paths: list[Path], topic: str, count: int) -> list[NDArray[Any]]:
    """The first ``count`` clouds of a bag, or of PCD and PLY files, as points.

    Raises:
        SingulationError: ``BAD_FILE``, ``NO_POINTS``, ``BAD_LAYOUT``.
    """
    clouds = islice(find_recording(paths, topic, 1.0).open(), count)
    return [decode_points(cloud.data, cloud.layout).copy() for cloud in clouds]


def live_clouds(arguments: Sequence[str], trigger: str, count: int, timeout: float) -> list[NDArray[Any]]:
    """The next ``count`` clouds on ``points``.

    Args:
        arguments: command line with ROS arguments, for remapping.
        trigger: service that triggers the camera, empty if it runs freely.
        count: how many.
        timeout: for each [s].

    Raises:
        SingulationError: ``TIMEOUT``, ``NO_FRESH_VIEW``, or perception's codes for clouds that are none.
    """
    prepare_for_large_messages()
    messages: list[Any] = []
    with CommandNode("calibrate", arguments) as command:
        command.hear(PointCloud2, "points", messages.append, SENSOR_IN)
        while len(messages) < count:
            wanted = len(messages) + 1
            if trigger:
                command.trigger(trigger, ready=timeout, answer=timeout, refusal=ResultCode.NO_FRESH_VIEW)
            command.wait(partial(_has, messages, wanted), timeout, f"cloud {wanted} on points")
            print(f"cloud {wanted} of {count}", flush=True)
    return [points_from_msg(message).copy() for message in messages[:count]]


def _has(messages: list[Any], count: int) -> bool:
    return len(messages) >= count
