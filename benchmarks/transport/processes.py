"""The receiving process: ``python -m benchmarks.transport.processes SETTINGS RECEIVER [ROS ARGUMENTS]``."""

import os
import sys
from typing import Any

from singulation_node.large_messages import HEAPS_VARIABLE, PROFILE, PROFILE_VARIABLE, prepare_for_large_messages

# isort: split
from rclpy.node import Node
from sensor_msgs.msg import PointCloud2
from singulation_msgs.msg import Arrangement
from std_msgs.msg import Header

from singulation_node.main import run_node
from singulation_node.qos import SENSOR_IN, STATE
from singulation_perception.perception_node import PerceptionNode

INSTALLED, PROFILE_ONLY, SHIPPED = "as installed", "transport profile", "profile and kept memory"
SETTINGS = (INSTALLED, PROFILE_ONLY, SHIPPED)
ECHO, RELIABLE_ECHO, PERCEPTION = "echo", "echo, reliable", "perception_node"


_USUAL_HEAPS = 8 * (os.cpu_count() or 1)  # what glibc allows by itself


def environment(settings: str) -> dict[str, str]:
    """Variables that a process with these settings needs from its start."""
    variables = {name: value for name, value in os.environ.items() if name != PROFILE_VARIABLE}
    if settings != SHIPPED:
        variables[HEAPS_VARIABLE] = str(_USUAL_HEAPS)
    if settings == PROFILE_ONLY:
        variables[PROFILE_VARIABLE] = str(PROFILE)
    return variables


def apply(settings: str) -> None:
    """Prepare this process; before rclpy.init."""
    if settings == SHIPPED and not prepare_for_large_messages():
        raise SystemExit("not enough shared memory for the measurement")


class Echo(Node):
    """Answers each cloud with an empty arrangement of its stamp: what is left without the segmentation."""

    def __init__(self, qos: Any) -> None:
        super().__init__("echo")
        self._objects = self.create_publisher(Arrangement, "objects", STATE)
        self.create_subscription(PointCloud2, "points", self._answer, qos)

    def _answer(self, cloud: Any) -> None:
        self._objects.publish(Arrangement(header=Header(stamp=cloud.header.stamp, frame_id="table")))


def main() -> int:
    """Run the receiver."""
    settings, receiver, *rest = sys.argv[1:]
    apply(settings)
    made = {ECHO: lambda: Echo(SENSOR_IN), RELIABLE_ECHO: lambda: Echo(1), PERCEPTION: PerceptionNode}
    return run_node(made[receiver], [sys.argv[0], "--autostart", *rest])


if __name__ == "__main__":
    sys.exit(main())
