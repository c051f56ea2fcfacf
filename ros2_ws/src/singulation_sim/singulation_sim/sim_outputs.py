"""What ``sim_cell`` publishes, and when."""

from typing import Any

from rclpy.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState, PointCloud2
from singulation_msgs.msg import Arrangement, DriverState
from std_msgs.msg import Header

from singulation_core.conversions import arrangement_to_msg, cloud_to_msg, stamp_of
from singulation_node.qos import STATE
from singulation_sim.border import joint_states_to_msg, status_to_msg
from singulation_sim.cell import SimulatedCell
from singulation_sim.driver import DriverStatus

# Reliable and one deep, as the official PhoXi driver offers its clouds.
_CLOUD_OUT = QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=1, reliability=ReliabilityPolicy.RELIABLE)
_SLOW_PERIOD = 0.1  # s between driver states, and between true arrangements


class SimOutputs:
    """Publishers of the node.

    Args:
        node: that publishes.
        own_time: whether it makes the time.
        camera_frame: of the clouds.
    """

    def __init__(self, node: Any, own_time: bool, camera_frame: str) -> None:
        self._points = node.create_publisher(PointCloud2, "points", _CLOUD_OUT)
        self._states = node.create_publisher(JointState, "joint_states", STATE)
        self._driver = node.create_publisher(DriverState, "driver_state", STATE)
        self._truth = node.create_publisher(Arrangement, "true_objects", STATE)
        self._clock = node.create_publisher(Clock, "/clock", STATE) if own_time else None
        self._frame = camera_frame
        self._status: DriverStatus | None = None
        self._status_due = self._truth_due = 0.0
        self._moved = False

    def publish(self, cell: SimulatedCell, moved: bool) -> None:
        """Clock, joint states, and what else is due; ``moved`` since the last call."""
        stamp = stamp_of(cell.now)
        if self._clock is not None:
            self._clock.publish(Clock(clock=stamp))
        states = cell.driver.joint_states()
        if states is not None:
            self._states.publish(joint_states_to_msg(states, stamp))
        self._publish_status(cell, stamp)
        self._publish_truth(cell, stamp, ended=self._moved and not moved)
        self._moved = moved

    def publish_cloud(self, points: Any, now: float) -> None:
        """An organized cloud, stamped ``now`` [s] as the camera's driver does: after the scan."""
        self._points.publish(cloud_to_msg(points, Header(stamp=stamp_of(now), frame_id=self._frame)))

    def _publish_status(self, cell: SimulatedCell, stamp: Any) -> None:
        status = cell.driver.status
        if status != self._status or cell.now >= self._status_due:
            self._status, self._status_due = status, cell.now + _SLOW_PERIOD
            self._driver.publish(status_to_msg(status, stamp))

    def _publish_truth(self, cell: SimulatedCell, stamp: Any, ended: bool) -> None:
        if ended or cell.now >= self._truth_due:
            self._truth_due = cell.now + _SLOW_PERIOD
            self._truth.publish(arrangement_to_msg(cell.arrangement(), stamp))
