"""The camera's process: publishes one cloud again and again, waits for each answer, prints what it saw as JSON.

``python -m benchmarks.transport.sender SETTINGS CLOUD.npy REPEATS RECEIVER_PROCESS``
"""

import json
import sys
import time
from typing import Any

from benchmarks.transport.processes import apply  # before ROS: keeps memory

# isort: split
import numpy as np
import psutil
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import PointCloud2
from singulation_msgs.msg import Arrangement
from std_msgs.msg import Header

from singulation_core.conversions import cloud_to_msg
from singulation_node.qos import STATE

_START = 240.0  # s for the receiver to come up; the first time it compiles
_ANSWER = 2.0  # s, after which a cloud is lost
_PAUSE = 0.1  # s


class Sender(Node):
    """Publishes as a PhoXi driver does (reliable) and notes when the answer of each stamp comes."""

    def __init__(self) -> None:
        super().__init__("sender")
        self.points = self.create_publisher(PointCloud2, "points", QoSProfile(depth=1))
        self.create_subscription(Arrangement, "objects", self._answered, STATE)
        self.answers: dict[int, tuple[int, int]] = {}

    def _answered(self, message: Any) -> None:
        stamp = message.header.stamp.sec * 10**9 + message.header.stamp.nanosec
        self.answers[stamp] = (time.time_ns(), len(message.objects))

    def wait(self, condition: Any, timeout: float) -> bool:
        """Spin until the condition holds."""
        deadline = time.monotonic() + timeout
        while not condition():
            if time.monotonic() > deadline:
                return False
            rclpy.spin_once(self, timeout_sec=0.05)
        return True


def measure(node: Sender, cloud: Any, repeats: int, receiver: psutil.Process) -> dict[str, Any]:
    """Milliseconds from publishing to the answer, for each cloud that was answered; processor time for each cloud."""
    if not node.wait(lambda: node.points.get_subscription_count() > 0 and node.count_publishers("objects"), _START):
        raise SystemExit("no receiver")
    node.wait(lambda: False, 1.0)
    times: list[float] = []
    objects = 0
    began, received = time.process_time(), sum(receiver.cpu_times()[:2])
    for _ in range(repeats):
        stamp = time.time_ns()
        cloud.header.stamp.sec, cloud.header.stamp.nanosec = divmod(stamp, 10**9)
        node.points.publish(cloud)
        if node.wait(lambda stamp=stamp: stamp in node.answers, _ANSWER):  # type: ignore[misc]
            times.append((node.answers[stamp][0] - stamp) * 1e-6)
            objects = node.answers[stamp][1]
        node.wait(lambda: False, _PAUSE)
    return {
        "times": times,
        "objects": objects,
        "processor": (time.process_time() - began) / repeats * 1e3,
        "receiver": (sum(receiver.cpu_times()[:2]) - received) / repeats * 1e3,
    }


def main() -> int:
    """Run the sender."""
    settings, path, repeats, receiver = sys.argv[1:5]
    apply(settings)
    rclpy.init()
    node = Sender()
    cloud = cloud_to_msg(np.load(path), Header(frame_id="phoxi_camera_sensor"))
    print(json.dumps(measure(node, cloud, int(repeats), psutil.Process(int(receiver)))))
    node.destroy_node()
    rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
