"""The adapters' rules without the drivers; with the drivers' messages installed, the nodes as well."""

import importlib.util
import itertools

import pytest
from rclpy.node import Node
from rclpy.parameter import Parameter
from singulation_msgs.msg import DriverState
from std_msgs.msg import Float64MultiArray

from singulation_bringup.adapters.camera_trigger import CameraTrigger
from singulation_bringup.adapters.cell_frames import CellFrames
from singulation_bringup.adapters.controller_state import ControllerState, DriverMode, egm_runs, verdict
from singulation_bringup.adapters.driver_state_adapter import DriverStateAdapter
from singulation_bringup.adapters.hand_orders import HandOrder, HandOrders, finger_millimetres
from singulation_bringup.adapters.smart_gripper_adapter import SmartGripperAdapter
from singulation_core import CellGeometry, InvalidInputError
from singulation_core.transforms import pose_matrix
from singulation_node.qos import COMMAND, STATE
from singulation_node.testing import Mailbox, spinning, wait_until

TASKS = ("T_ROB_L", "T_ROB_R")


def installed(*packages):
    return all(importlib.util.find_spec(package) for package in packages)


def test_modes_are_those_of_the_message():
    assert {mode.name: int(mode) for mode in DriverMode} == {
        name: getattr(DriverState, name) for name in DriverMode.__members__
    }


@pytest.mark.parametrize(
    "values", [*itertools.product((True, False), (True, False), (True, False), (True, False, None))]
)
def test_motion_is_enabled_only_when_everything_runs(values):
    state = ControllerState(*values)
    found = verdict(state, require_egm=True)
    assert found.motion_enabled == (values == (True, True, True, True))
    assert bool(found.text) == (not found.motion_enabled)
    assert (found.mode is DriverMode.MOTORS_OFF) == (not state.motors_on)
    without = verdict(state, require_egm=False)
    assert without.motion_enabled == all(values[:3])


def test_egm_counts_for_both_arms_only():
    assert egm_runs([("T_ROB_L", 5), ("T_ROB_R", 5), ("T_SG_L", 2)], TASKS) is True
    assert egm_runs([("T_ROB_L", 5), ("T_ROB_R", 2)], TASKS) is False
    assert egm_runs([("T_ROB_L", 5)], TASKS) is None
    assert egm_runs([], TASKS) is None


@pytest.mark.parametrize("opening", [float("nan"), float("inf"), -0.001, 0.0501])
def test_an_opening_that_is_none_is_refused(opening):
    with pytest.raises(InvalidInputError, match=r"0 to 0\.05"):
        finger_millimetres(opening)
    assert finger_millimetres(0.030) == pytest.approx(15.0)


def test_orders_one_at_a_time_the_newest_of_each_hand():
    now = [0.0]
    orders = HandOrders(2.0, lambda: now[0])
    first, second, third = HandOrder("left", 1.0), HandOrder("left", 2.0), HandOrder("right", 3.0)
    orders.add(first)
    assert orders.begin() is first
    orders.add(HandOrder("left", 9.0))
    orders.add(second)
    orders.add(third)
    assert orders.begin() is None  # one is being carried out
    assert orders.end(first)
    assert not orders.end(first)
    assert orders.begin() is second
    now[0] = 1.9
    assert orders.overdue() is None
    now[0] = 2.1
    assert orders.overdue() is second
    assert not orders.end(second)  # its answer came too late
    assert orders.begin() is third
    assert orders.end(third)
    assert orders.begin() is None


@pytest.mark.parametrize(
    ("node_class", "packages"),
    [
        (DriverStateAdapter, ("abb_robot_msgs", "abb_rapid_sm_addin_msgs")),
        (SmartGripperAdapter, ("abb_robot_msgs", "abb_rapid_sm_addin_msgs")),
        (CameraTrigger, ("phoxi_camera_msgs",)),
        (CellFrames, ("tf2_msgs",)),
    ],
)
def test_a_missing_driver_is_named(node_class, packages, ros_context):
    """The node says what to build and stays unconfigured; where the driver is installed it starts."""
    node = node_class(context=ros_context)
    statuses = []
    node.diagnostics.report = lambda name, ok, text, /, **values: statuses.append((ok, text))
    with spinning(node):
        assert node.start() == installed(*packages)
    if not installed(*packages):
        assert any("NOT_READY" in text and any(map(text.__contains__, packages)) for ok, text in statuses if not ok)


def test_frames_are_those_of_the_cell(ros_context):
    table = {"table_position": [0.4, 0.0, -0.02], "table_quaternion": [0.0, 0.0, 1.0, 0.0]}
    overrides = [Parameter(name, value=value) for name, value in table.items()]
    node = CellFrames(context=ros_context, parameter_overrides=overrides)
    body_table, table_camera = node.transforms()
    node.destroy_node()
    assert (body_table.header.frame_id, body_table.child_frame_id) == ("yumi_body", "table")
    assert (table_camera.header.frame_id, table_camera.child_frame_id) == ("table", "phoxi_camera_sensor")
    move, turn = body_table.transform.translation, body_table.transform.rotation
    assert pose_matrix((move.x, move.y, move.z), (turn.x, turn.y, turn.z, turn.w)) == pytest.approx(
        pose_matrix((0.4, 0.0, -0.02), (0.0, 0.0, 1.0, 0.0))
    )
    move, turn = table_camera.transform.translation, table_camera.transform.rotation
    assert pose_matrix((move.x, move.y, move.z), (turn.x, turn.y, turn.z, turn.w)) == pytest.approx(
        CellGeometry().table_from_camera
    )


class Driver(Node):
    """Topics and services as abb_rws_client has them."""

    def __init__(self, context):
        from abb_rapid_sm_addin_msgs.msg import RuntimeState
        from abb_rapid_sm_addin_msgs.srv import SetSGCommand
        from abb_robot_msgs.msg import SystemState
        from abb_robot_msgs.srv import GetIOSignal, TriggerWithResultCode

        super().__init__("rws_client", context=context)
        self.signals = {"hand_StatusCalibrated_L": "1", "hand_StatusCalibrated_R": "0"}
        self.signals |= {"hand_ActualPosition_L": "120", "hand_ActualPosition_R": "0"}
        self.orders, self.code = [], 1
        self.system, self.runtime = SystemState(), RuntimeState()
        self.states = self.create_publisher(SystemState, "system_states", 1)
        self.runtimes = self.create_publisher(RuntimeState, "runtime_states", 1)
        self.create_service(GetIOSignal, "get_io_signal", self.signal)
        self.create_service(SetSGCommand, "set_sg_command", self.order)
        self.create_service(TriggerWithResultCode, "run_sg_routine", self.run)
        self.create_timer(0.05, self.publish)

    def publish(self):
        self.system.header.stamp = self.get_clock().now().to_msg()
        self.states.publish(self.system)
        self.runtimes.publish(self.runtime)

    def signal(self, request, response):
        response.value, response.result_code = self.signals[request.signal], 1
        return response

    def order(self, request, response):
        self.orders.append((request.task, request.command, request.target_position))
        response.result_code, response.message = self.code, "refused"
        return response

    def run(self, request, response):
        self.orders.append("run")
        response.result_code = 1
        return response


def with_egm(driver, state):
    from abb_rapid_sm_addin_msgs.msg import StateMachineState

    driver.runtime.state_machines = [StateMachineState(rapid_task=task, sm_state=state) for task in TASKS]


def drive_states(context):
    driver = Driver(context)
    adapter = DriverStateAdapter(context=context, parameter_overrides=[Parameter("gripper_period", value=0.1)])
    heard = Mailbox(driver, DriverState, "driver_state", STATE)
    with spinning(driver, adapter):
        assert adapter.start()
        assert heard.wait().mode == DriverState.MOTORS_OFF
        driver.system.motors_on = driver.system.auto_mode = driver.system.rapid_running = True
        wait_until(lambda: "nothing is known of EGM" in heard.messages[-1].message)
        with_egm(driver, 2)
        wait_until(lambda: "no EGM session" in heard.messages[-1].message)
        with_egm(driver, 5)
        wait_until(lambda: heard.messages[-1].motion_enabled and heard.messages[-1].left_gripper_calibrated)
        assert not heard.messages[-1].right_gripper_calibrated
        driver.system.rapid_running = False
        wait_until(lambda: not heard.messages[-1].motion_enabled)


def drive_grippers(context):
    from sensor_msgs.msg import JointState

    driver, adapter = Driver(context), SmartGripperAdapter(context=context)
    joints = Mailbox(driver, JointState, "joint_states", STATE)
    order = driver.create_publisher(Float64MultiArray, "left_gripper_controller/commands", COMMAND)
    with spinning(driver, adapter):
        assert adapter.start()
        wait_until(lambda: {tuple(one.name) for one in joints.messages} == {("gripper_l_joint",), ("gripper_r_joint",)})
        position = next(one for one in joints.messages if one.name == ["gripper_l_joint"]).position[0]
        assert position == pytest.approx(0.012)
        wait_until(lambda: order.get_subscription_count() == 1)
        driver.code = 2
        order.publish(Float64MultiArray(data=[0.2]))  # refused here
        order.publish(Float64MultiArray(data=[0.02]))  # refused by the driver: no run
        wait_until(lambda: len(driver.orders) == 1)
        driver.code = 1
        order.publish(Float64MultiArray(data=[0.03]))
        wait_until(lambda: len(driver.orders) == 3)
        refused, taken, ran = driver.orders
        assert refused == ("T_ROB_L", 5, pytest.approx(10.0))
        assert taken == ("T_ROB_L", 5, pytest.approx(15.0))
        assert ran == "run"


def drive_trigger(context):
    from phoxi_camera_msgs.srv import TriggerFrame
    from std_srvs.srv import Trigger

    from singulation_node.testing import call

    camera, user = Node("phoxi_camera", context=context), Node("user", context=context)
    asked = []

    def frame(request, response):
        asked.append(request.wait_grabbing_end)
        response.success, response.message = len(asked) > 1, "no laser"
        return response

    adapter = CameraTrigger(context=context, parameter_overrides=[Parameter("timeout", value=2.0)])
    with spinning(camera, user, adapter):
        assert adapter.start()
        assert "nobody offers" in call(user, Trigger, "trigger_frame", Trigger.Request()).message
        camera.create_service(TriggerFrame, "/phoxi_camera/trigger_frame", frame)
        assert call(user, Trigger, "trigger_frame", Trigger.Request()).message == "no laser"
        assert call(user, Trigger, "trigger_frame", Trigger.Request()).success
    assert asked == [True, True]


def test_with_the_messages_of_the_drivers_the_adapters_speak_to_them(ros_context):
    """Runs as far as the drivers' messages are installed, as on a cell; elsewhere their absence is what is seen."""
    drives = (
        (drive_states, ("abb_robot_msgs", "abb_rapid_sm_addin_msgs")),
        (drive_grippers, ("abb_robot_msgs", "abb_rapid_sm_addin_msgs")),
        (drive_trigger, ("phoxi_camera_msgs",)),
    )
    for drive, packages in drives:
        if installed(*packages):
            drive(ros_context)
        else:
            with pytest.raises(ModuleNotFoundError):
                drive(ros_context)
