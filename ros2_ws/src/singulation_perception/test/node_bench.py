"""A perception node with a camera and a listener, for the tests of the node."""

import time

import rclpy
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy
from ros2_ws.src.singulation_perception.test.table_scene import CAMERA_POSITION, CAMERA_QUATERNION, message, scene
from sensor_msgs.msg import PointCloud2
from singulation_msgs.msg import Arrangement

from singulation_node.testing import Mailbox, wait_until
from singulation_perception.perception_node import PerceptionNode

CAMERA = [
    Parameter("camera_position", value=list(CAMERA_POSITION)),
    Parameter("camera_quaternion", value=list(CAMERA_QUATERNION)),
]
SECOND = 10**9


class Bench:
    """A perception node, a camera that publishes to it, and what comes out."""

    def __init__(self, context, *parameters, reliability=ReliabilityPolicy.RELIABLE):
        self.node = PerceptionNode(context=context, parameter_overrides=[*CAMERA, *parameters])
        self.camera = rclpy.create_node("camera", context=context)
        self.points = self.camera.create_publisher(PointCloud2, "points", QoSProfile(depth=1, reliability=reliability))
        self.objects = Mailbox(self.camera, Arrangement, "objects")
        self.stamp = time.time_ns() - 1000 * SECOND

    def next_stamp(self):
        self.stamp += SECOND
        return self.stamp

    def start(self):
        assert self.node.start()
        wait_until(lambda: self.points.get_subscription_count() > 0)
        wait_until(lambda: self.node.count_subscribers("objects") > 0)

    def see(self, cloud=None):
        """Publish a cloud and wait until the node is through with it; its outcome as (published, rejected)."""
        before = self.ledger
        self.points.publish(message(scene(), self.next_stamp()) if cloud is None else cloud)
        wait_until(lambda: self.ledger.received > before.received and self.ledger.pending == 0, what="the outcome")
        after = self.ledger
        rejected = [name for name, count in after.rejected.items() if count > before.rejected.get(name, 0)]
        return after.published - before.published, rejected

    def good(self):
        """A good cloud gives its objects."""
        count = len(self.objects.messages)
        assert self.see() == (1, [])
        return self.objects.wait(count + 1)

    @property
    def ledger(self):
        return self.node.ledger.state(time.monotonic())
