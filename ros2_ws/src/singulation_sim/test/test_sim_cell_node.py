"""The node ``sim_cell`` over DDS."""

import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from typing import Any

import numpy as np
import pytest
from rclpy.node import Node
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState, PointCloud2
from singulation_msgs.msg import Arrangement, DriverState
from singulation_msgs.srv import InjectFault
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from singulation_core import InvalidInputError, ResultCode, SingulationError
from singulation_core.conversions import arrangement_from_msg, seconds_of
from singulation_node.testing import Mailbox, call, ros_context, spinning, wait_until
from singulation_sim.sim_cell import SimCell

__all__ = ["ros_context"]

LEFT = [f"yumi_robl_joint_{number}" for number in range(1, 8)]
RELIABLE_ONE = 1


def parameters(**values: Any) -> list[Any]:
    return [Parameter(name, value=value) for name, value in values.items()]


class Desk:
    """What a test sees of a running cell, and what it can send."""

    def __init__(self, context: Any, **values: Any) -> None:
        self.cell = SimCell(context=context, parameter_overrides=parameters(**values))
        self.node = Node("desk", context=context)
        self.states = Mailbox(self.node, JointState, "joint_states")
        self.driver = Mailbox(self.node, DriverState, "driver_state")
        self.truth = Mailbox(self.node, Arrangement, "true_objects")
        self.clouds = Mailbox(self.node, PointCloud2, "points", RELIABLE_ONE)
        self.clock = Mailbox(self.node, Clock, "/clock")
        self._arm = self.node.create_publisher(JointTrajectory, "left_arm_controller/joint_trajectory", 10)
        self._hand = self.node.create_publisher(Float64MultiArray, "left_gripper_controller/commands", 10)

    def joint(self, name: str) -> float:
        """Newest position of a joint."""
        newest = self.states.wait()
        return float(newest.position[list(newest.name).index(name)])

    def send(self, change: float, seconds: float = 0.5, names: list[str] | None = None) -> float:
        """Order the second joint by ``change`` further; its target."""
        wait_until(lambda: self._arm.get_subscription_count() == 1, what="the cell's subscription")
        start = [self.joint(name) for name in LEFT]
        target = [value + (change if index == 1 else 0.0) for index, value in enumerate(start)]
        point = JointTrajectoryPoint(positions=target)
        point.time_from_start.sec, point.time_from_start.nanosec = int(seconds), int(seconds % 1.0 * 1e9)
        self._arm.publish(JointTrajectory(joint_names=names or LEFT, points=[point]))
        return target[1]

    def open_hand(self, *openings: float) -> None:
        """Order a jaw opening."""
        wait_until(lambda: self._hand.get_subscription_count() == 1, what="the cell's subscription")
        self._hand.publish(Float64MultiArray(data=list(openings)))

    def reaches(self, target: float, name: str = LEFT[1], tolerance: float = 1e-3) -> None:
        """Wait until a joint is somewhere."""
        wait_until(lambda: abs(self.joint(name) - target) < tolerance, what=f"{name} at {target}")

    def trigger(self) -> Any:
        """Call the camera's trigger."""
        return call(self.node, Trigger, "trigger_frame", Trigger.Request())

    def inject(self, fault: str, value: float = 0.0) -> Any:
        """Call inject_fault."""
        return call(self.node, InjectFault, "inject_fault", InjectFault.Request(fault=fault, value=value))

    def reset(self) -> Any:
        """Call reset."""
        return call(self.node, Trigger, "reset", Trigger.Request())


@pytest.fixture
def make_desk(ros_context: Any) -> Iterator[Callable[..., Desk]]:
    """Starts a cell with these parameters."""
    with ExitStack() as running:

        def make(**values: Any) -> Desk:
            desk = Desk(ros_context, **values)
            running.enter_context(spinning(desk.cell, desk.node))
            return desk

        yield make


def test_it_starts_by_itself_at_real_time(make_desk: Callable[..., Desk]) -> None:
    desk = make_desk(objects=4, seed=2)
    states, driver, truth = desk.states.wait(5), desk.driver.wait(), desk.truth.wait()
    assert len(states.name) == len(states.position) == len(states.velocity) == 16
    assert (driver.mode, driver.motion_enabled) == (DriverState.MOTORS_ON, True)
    assert driver.left_gripper_calibrated and driver.right_gripper_calibrated
    assert truth.header.frame_id == "table"
    assert len(arrangement_from_msg(truth)) == 4
    wall = desk.node.get_clock().now().nanoseconds * 1e-9
    assert abs(seconds_of(desk.states.messages[-1].header.stamp) - wall) < 2.0
    assert not desk.clock.messages


def test_own_time_passes_on_the_clock(make_desk: Callable[..., Desk]) -> None:
    desk = make_desk(speed=5.0)
    stamps = [seconds_of(message.clock) for message in (desk.clock.wait(), desk.clock.wait(100))]
    assert stamps[0] < 60.0
    assert stamps[1] - stamps[0] > 0.9
    times = [seconds_of(message.header.stamp) for message in desk.states.messages[:100]]
    # 100 Hz in cycles of 4 ms; a busy receiver may lose some in between.
    assert min(np.diff(times)) == pytest.approx(0.008)
    assert np.allclose(np.mod(np.array(times) + 1e-6, 0.004), 0.0, atol=1e-5)


def test_an_arm_goes_where_it_is_sent(make_desk: Callable[..., Desk]) -> None:
    desk = make_desk(speed=10.0)
    desk.reaches(desk.send(0.3))
    desk.open_hand(0.03)
    desk.reaches(0.015, "gripper_l_joint")
    assert desk.joint("gripper_r_joint") == pytest.approx(0.0)


def test_what_the_controller_refuses_changes_nothing(make_desk: Callable[..., Desk]) -> None:
    desk = make_desk(speed=10.0)
    before = desk.joint(LEFT[1])
    desk.send(0.2, names=LEFT[:-1] + ["elbow"])
    desk.open_hand(0.01, 0.02)
    desk.open_hand(float("nan"))
    wait_until(lambda: desk.cell._refused == 3, what="three refusals")
    assert desk.joint(LEFT[1]) == pytest.approx(before, abs=1e-3)
    desk.reaches(desk.send(0.2))


def test_a_trigger_returns_after_its_cloud(make_desk: Callable[..., Desk]) -> None:
    desk = make_desk(speed=10.0, objects=3, seed=1)
    desk.truth.wait()
    wait_until(lambda: desk.cell.count_subscribers("points") == 1, what="the camera's subscriber")
    answer = desk.trigger()
    assert answer.success, answer.message
    cloud = desk.clouds.wait()
    assert (cloud.height, cloud.width, cloud.point_step, cloud.is_dense) == (772, 1032, 12, False)
    assert cloud.header.frame_id == "phoxi_camera_sensor"
    assert [field.name for field in cloud.fields] == ["x", "y", "z"]
    points = np.frombuffer(cloud.data, dtype="<f4").reshape(772, 1032, 3)
    assert 0.75 < np.median(points[..., 2]) < 0.95
    assert 0.001 < (points == 0.0).all(axis=-1).mean() < 0.1
    stamp = seconds_of(cloud.header.stamp)
    assert desk.trigger().success
    assert seconds_of(desk.clouds.wait(2).header.stamp) >= stamp + 0.25


def test_a_camera_can_run_freely_and_give_nan(make_desk: Callable[..., Desk]) -> None:
    desk = make_desk(speed=10.0, frame_period=1.0, scan_time=0.0, invalid_points="nan")
    cloud = desk.clouds.wait(2)
    points = np.frombuffer(cloud.data, dtype="<f4")
    assert np.isnan(points).any()
    assert not (points == 0.0).all()


def test_a_frame_on_its_way_still_goes_out_when_the_node_ends(
    ros_context: Any, capfd: pytest.CaptureFixture[str]
) -> None:
    desk = Desk(ros_context, speed=10.0, frame_period=1.0, scan_time=0.0)
    render, rendering = desk.cell.cell.render, threading.Event()

    def render_late(view: Any) -> Any:
        rendering.set()
        wait_until(lambda: desk.cell._stepper.stopped, what="the end of the node")
        return render(view)

    desk.cell.cell.render = render_late  # type: ignore[method-assign]
    with spinning(desk.cell, desk.node):
        assert rendering.wait(20.0)
    assert "failed" not in capfd.readouterr().err


def test_a_scan_that_the_end_of_the_node_interrupts_is_no_failure(
    ros_context: Any, capfd: pytest.CaptureFixture[str]
) -> None:
    desk = Desk(ros_context, frame_period=0.1, scan_time=10.0)
    with spinning(desk.cell, desk.node):
        wait_until(desk.cell._camera_lock.locked, what="the scan")
    assert "failed" not in capfd.readouterr().err
    with pytest.raises(SingulationError, match="no frame: the node ends") as caught:
        desk.cell._scan()
    assert caught.value.code is ResultCode.TIMEOUT


def test_faults_and_reset(make_desk: Callable[..., Desk]) -> None:
    desk = make_desk(speed=10.0)
    target = desk.send(-0.5, seconds=200.0)  # 20 s of real time: a late stop comes in time
    wait_until(lambda: desk.joint(LEFT[1]) < target + 0.49, what="motion")
    assert desk.inject("emergency_stop").success
    wait_until(lambda: desk.driver.messages[-1].mode == DriverState.EMERGENCY_STOP, what="the stop on the topic")
    assert not desk.driver.messages[-1].motion_enabled
    desk.states.wait(len(desk.states.messages) + 20)
    stopped = desk.joint(LEFT[1])
    desk.states.wait(len(desk.states.messages) + 200)  # going on it would be 5 mrad further
    assert desk.joint(LEFT[1]) == pytest.approx(stopped, abs=1e-3)
    assert stopped > target + 0.05
    unknown = desk.inject("earthquake")
    assert not unknown.success
    assert "emergency_stop" in unknown.message
    assert desk.reset().success
    wait_until(lambda: desk.driver.messages[-1].mode == DriverState.MOTORS_ON, what="motors on")
    desk.reaches(desk.send(0.1))


def test_lost_states_stop_and_come_back(make_desk: Callable[..., Desk]) -> None:
    desk = make_desk(speed=10.0)
    desk.states.wait(20)
    assert desk.inject("drop_states").success
    count = len(desk.states.messages)
    driver = len(desk.driver.messages)
    desk.driver.wait(driver + 5)
    assert len(desk.states.messages) <= count + 10
    assert desk.reset().success
    desk.states.wait(count + 30)
    desk.reaches(desk.send(0.1))


def test_a_new_seed_puts_new_blocks_down(make_desk: Callable[..., Desk]) -> None:
    desk = make_desk(speed=10.0, objects=3, seed=1)
    first = arrangement_from_msg(desk.truth.wait())
    refused = desk.cell.set_parameters(parameters(objects=-2))
    assert not refused[0].successful
    assert desk.cell.set_parameters(parameters(seed=5, objects=6, scene="group_2"))[0].successful
    wait_until(lambda: len(desk.truth.messages[-1].objects) == 6, what="six blocks")
    again = arrangement_from_msg(desk.truth.messages[-1])
    assert again.centroids.shape != first.centroids.shape


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"speed": 0.0}, "speed"),
        ({"scene": "pile"}, "scene"),
        ({"workspace": [0.1, -0.1, -0.2, 0.2]}, "x_min"),
        ({"camera_quaternion": [0.0, 0.0, 0.0, 2.0]}, "quaternion"),
        ({"left_arm_joints": ["a", "b"]}, "7 names"),
        ({"right_finger_joint": "gripper_l_joint"}, "once"),
        ({"physics": "magic"}, "preset"),
    ],
)
def test_wrong_parameters_are_refused_at_the_start(ros_context: Any, values: dict[str, Any], words: str) -> None:
    with pytest.raises(InvalidInputError, match=words):
        SimCell(context=ros_context, parameter_overrides=parameters(**values))
