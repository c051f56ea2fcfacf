"""The dry run plans what the executor would do, shows it, and has nothing to order it with."""

import numpy as np
import pytest
from rclpy.node import Node
from sensor_msgs.msg import JointState
from singulation_msgs.msg import Arrangement as ArrangementMsg
from singulation_msgs.msg import PushTrajectory
from std_msgs.msg import Header
from visualization_msgs.msg import Marker, MarkerArray

from singulation_bringup.dry_run.dry_run import DryRun
from singulation_bringup.dry_run.motion_report import motion_report, report_text
from singulation_core import Arrangement, CellGeometry, ContactMode, PlanarObject, Push, conversions
from singulation_node.qos import LATCHED, STATE
from singulation_node.testing import Mailbox, spinning, wait_until
from yumi_push_executor import MotionParameters, plan_motion
from yumi_push_executor.executor_settings import ExecutorSettings
from yumi_push_executor.kinematics import CLEAR_VIEW

SQUARE = np.array(((-0.02, -0.02), (0.02, -0.02), (0.02, 0.02), (-0.02, 0.02)))
PUSH = Push((-0.03, 0.0), (0.02, 0.0), ContactMode.SINGLE_POINT, target_id=3, policy="test")


def phases(parameters):
    cell = CellGeometry()
    motion = plan_motion(PUSH, cell=cell, parameters=parameters)
    return motion, motion_report(motion, cell.body_from_table)


def test_the_first_push_is_slow_and_low_only_where_it_pushes():
    motion, found = phases(MotionParameters(approach_speed=0.05, vertical_speed=0.02, push_speed=0.01))
    by_name = {one.phase: one for one in found}
    assert by_name["PUSH"].fastest_tip == pytest.approx(0.010, rel=0.02)
    assert by_name["PUSH"].lowest_tip == pytest.approx(MotionParameters().tip_height, abs=0.0006)
    assert by_name["DESCEND"].fastest_tip <= 0.0205
    assert by_name["APPROACH"].fastest_tip <= 0.0505
    assert by_name["APPROACH"].lowest_tip > 0.05
    assert by_name["GRIPPER"].opening == 0.0
    assert max(one.joint_share for one in found) < 0.2
    path = by_name["PUSH"].path
    assert path[0, :2] == pytest.approx(PUSH.start, abs=0.0006)
    assert path[-1, :2] == pytest.approx(PUSH.end, abs=0.0006)
    text = report_text(motion, found)
    assert "10 mm/s" in text
    assert "object 3" in text


class Surroundings(Node):
    """Planner, perception and robot in one."""

    def __init__(self, context):
        super().__init__("surroundings", context=context)
        self.objects = self.create_publisher(ArrangementMsg, "objects", STATE)
        self.pushes = self.create_publisher(PushTrajectory, "push", STATE)
        self.joints = self.create_publisher(JointState, "joint_states", STATE)

    def look(self):
        """An arrangement and joint states of now; the stamp."""
        stamp = self.get_clock().now().to_msg()
        block = PlanarObject(3, SQUARE, height=0.03)
        self.objects.publish(conversions.arrangement_to_msg(Arrangement([block]), stamp))
        self.joints.publish(joint_states(stamp))
        return stamp

    def ask(self, push, stamp):
        self.pushes.publish(conversions.push_to_msg(push, Header(stamp=stamp, frame_id="table")))


def joint_states(stamp):
    settings = ExecutorSettings()
    names = [*settings.left_arm_joints, *settings.right_arm_joints]
    return JointState(header=Header(stamp=stamp), name=names, position=[*CLEAR_VIEW["left"], *CLEAR_VIEW["right"]])


def kinds(message):
    return [marker.type for marker in message.markers if marker.action == Marker.ADD]


def test_a_push_is_shown_and_one_that_cannot_be_done_is_not(ros_context):
    node, around = DryRun(context=ros_context), Surroundings(ros_context)
    reports = []
    node.diagnostics.report = lambda name, ok, text, /, **values: reports.append((name, ok, text))
    shown = Mailbox(around, MarkerArray, "dry_run/markers", LATCHED)
    with spinning(node, around):
        assert node.start()
        for one in (around.pushes, around.objects, around.joints):
            wait_until(one.get_subscription_count)
        stamp = around.look()
        wait_until(lambda: node.has_seen_all)
        around.ask(Push((-0.03, 0.0), (0.5, 0.0), ContactMode.SINGLE_POINT), stamp)
        assert kinds(shown.wait(1)) == []
        assert any("PUSH_OUTSIDE_WORKSPACE" in text for name, ok, text in reports if name == "motion" and not ok)
        around.ask(PUSH, stamp)
        assert kinds(shown.wait(2)) == [Marker.LINE_STRIP] * 5 + [Marker.TEXT_VIEW_FACING]
        assert reports[-1][:2] == ("motion", True)


def test_it_has_no_topic_to_move_a_robot_with(ros_context):
    node = DryRun(context=ros_context)
    with spinning(node):
        assert node.start()
        published = {name for name, _ in node.get_publisher_names_and_types_by_node("dry_run", "/")}
    assert not [name for name in published if "controller" in name or "command" in name]
    assert "/dry_run/markers" in published
