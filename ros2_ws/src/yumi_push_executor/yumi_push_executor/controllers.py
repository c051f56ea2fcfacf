"""The four controllers of a YuMi: a trajectory controller and a gripper controller per arm."""

from typing import Any

from std_msgs.msg import Float64MultiArray
from trajectory_msgs.msg import JointTrajectory

from singulation_core import ResultCode, SingulationError
from singulation_node.qos import COMMAND
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.supervision import ArmOrder, Order
from yumi_push_executor.wire import JointNames
from yumi_push_executor.wire_messages import opening_to_msg, trajectory_to_msg


class Controllers:
    """Publishers of orders.

    Args:
        node: that owns them.
        names: of the joints.
    """

    def __init__(self, node: Any, names: JointNames) -> None:
        self._node = node
        self._names = names
        self._arms = {
            arm: node.create_publisher(JointTrajectory, f"{arm}_arm_controller/joint_trajectory", COMMAND)
            for arm in ARMS
        }
        self._jaws = {
            arm: node.create_publisher(Float64MultiArray, f"{arm}_gripper_controller/commands", COMMAND) for arm in ARMS
        }

    def send(self, order: Order) -> None:
        """Hand an order to its controller."""
        if isinstance(order, ArmOrder):
            self._arms[order.arm].publish(trajectory_to_msg(order.trajectory, self._names.arms[order.arm]))
        else:
            self._jaws[order.arm].publish(opening_to_msg(order.opening))

    def require(self, arm: str) -> None:
        """Somebody must listen, or an order is lost without a word.

        Raises:
            SingulationError: ``NOT_READY`` naming the topic.
        """
        for publisher in (self._arms[arm], self._jaws[arm]):
            if publisher.get_subscription_count() == 0:
                raise SingulationError(ResultCode.NOT_READY, f"no controller listens on {publisher.topic_name}")

    def problems(self) -> list[str]:
        """Topics without a controller, and topics on which somebody else gives orders, too."""
        found = []
        for publisher in (*self._arms.values(), *self._jaws.values()):
            name = publisher.topic_name
            if publisher.get_subscription_count() == 0:
                found.append(f"nobody listens on {name}")
            others = self._node.count_publishers(name) - 1
            if others > 0:
                found.append(f"{others} other publishers on {name}")
        return found
