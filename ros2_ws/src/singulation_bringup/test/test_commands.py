"""bring_up and status over ROS, with small lifecycle nodes in the places of the real ones."""

from dataclasses import dataclass

import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import JointState
from singulation_msgs.msg import Arrangement, DriverState, PushOutcome, PushTrajectory
from std_srvs.srv import Trigger

from singulation_bringup.commands import bring_up, status
from singulation_bringup.commands.command_node import CommandNode
from singulation_bringup.commands.overview import Component, Overview, Traffic, screen
from singulation_core import ResultCode, SingulationError
from singulation_node.managed_node import ManagedNode
from singulation_node.parameters import parameter
from singulation_node.qos import LATCHED, STATE
from singulation_node.testing import spinning, wait_until


@dataclass(frozen=True)
class NoSettings:
    unused: bool = parameter(False, "not used")


class Managed(ManagedNode[NoSettings]):
    """Counts its transitions and fails where it is told to."""

    def __init__(self, name, context, log, fault=""):
        super().__init__(name, NoSettings, context=context)
        self.log, self.fault = log, fault

    def configure(self):
        self._step("configure")

    def activate(self):
        self._step("activate")

    def _step(self, name):
        if self.fault == name:
            raise SingulationError(ResultCode.NO_TRANSFORM, "scripted")
        self.log.append((name, self.get_name()))


class Eyes(Managed):
    """Perception and camera in one."""

    def __init__(self, context, log, sees=True):
        super().__init__("perception_node", context, log)
        self.sees, self.refuses = sees, False
        self.objects = self.create_publisher(Arrangement, "objects", STATE)
        self.create_service(Trigger, "trigger_frame", self.trigger)

    def trigger(self, request, response):
        if self.refuses:
            response.message = "the lens is capped"
            return response
        if self.sees:
            self.objects.publish(Arrangement())
        else:
            self.diagnostics.report("clouds", False, "the last cloud was rejected: WRONG_TABLE (104): 30 mm")
        response.success = True
        return response


def options(*arguments):
    return bring_up.parse(["--timeout", "20", "--view-timeout", "20", *arguments])


def cell(context, log, sees=True, fault=""):
    others = [Managed(name, context, log) for name in ("planner_node", "singulate_node")]
    return [Eyes(context, log, sees), *others, Managed("executor_node", context, log, fault)]


def test_all_are_configured_before_the_first_is_active_and_the_robot_comes_last(ros_context, capsys):
    log = []
    nodes = cell(ros_context, log)
    with spinning(*nodes), CommandNode("bring_up", context=ros_context) as command:
        bring_up.bring_up(command, options("--check-camera"))
        assert [name for name, _ in log] == ["configure"] * 4 + ["activate"] * 4
        assert log[4] == ("activate", "perception_node")
        assert log[-1] == ("activate", "executor_node")
        assert "0 objects in view" in capsys.readouterr().out
        bring_up.bring_up(command, options("--check-camera"))  # again: nothing to do
        assert len(log) == 8


def test_a_wrong_table_keeps_the_robot_inactive_until_it_is_mended(ros_context):
    log = []
    nodes = cell(ros_context, log, sees=False)
    with spinning(*nodes), CommandNode("bring_up", context=ros_context) as command:
        with pytest.raises(SingulationError, match="WRONG_TABLE") as caught:
            bring_up.bring_up(command, options("--check-camera"))
        assert caught.value.code is ResultCode.NO_FRESH_VIEW
        assert ("activate", "executor_node") not in log
        assert not nodes[-1].is_active
        nodes[0].sees = True
        bring_up.bring_up(command, options("--check-camera"))
        assert nodes[-1].is_active


def test_a_camera_that_refuses_is_quoted_and_can_be_tried_again(ros_context):
    nodes = cell(ros_context, [])
    nodes[0].refuses = True
    with spinning(*nodes), CommandNode("bring_up", context=ros_context) as command:
        with pytest.raises(SingulationError, match="trigger_frame: the lens is capped") as caught:
            bring_up.bring_up(command, options("--check-camera"))
        assert caught.value.code is ResultCode.NO_FRESH_VIEW
        assert not nodes[-1].is_active
        nodes[0].refuses = False
        bring_up.bring_up(command, options("--check-camera"))
        assert nodes[-1].is_active


@pytest.mark.parametrize("step", ["configure", "activate"])
def test_a_node_that_fails_says_why_and_can_be_tried_again(ros_context, step):
    log = []
    nodes = cell(ros_context, log, fault=step)
    with spinning(*nodes), CommandNode("bring_up", context=ros_context) as command:
        with pytest.raises(SingulationError, match=f"executor_node could not {step}.*NO_TRANSFORM") as caught:
            bring_up.bring_up(command, options())
        assert caught.value.code is ResultCode.NOT_READY
        nodes[-1].fault = ""
        bring_up.bring_up(command, options())
        assert nodes[-1].is_active


def test_a_node_that_is_not_there_is_named(ros_context):
    log = []
    nodes = [Managed("planner_node", ros_context, log)]
    with spinning(*nodes), CommandNode("bring_up", context=ros_context) as command:
        with pytest.raises(SingulationError, match="executor_node/get_state") as caught:
            bring_up.bring_up(command, options("--nodes", "planner_node", "executor_node", "--timeout", "0.5"))
        assert caught.value.code is ResultCode.TIMEOUT
        bring_up.bring_up(command, options("--nodes", "planner_node"))
        assert nodes[0].is_active


def test_status_shows_states_rates_robot_and_outcomes(ros_context):
    log = []
    robot = Managed("executor_node", ros_context, log)
    planner = Managed("planner_node", ros_context, log, fault="configure")
    states = robot.create_publisher(JointState, "joint_states", STATE)
    robot.create_timer(0.02, lambda: states.publish(JointState(name=["a", "b"])))
    driver = robot.create_publisher(DriverState, "driver_state", STATE)
    robot.create_timer(
        0.1, lambda: driver.publish(DriverState(mode=1, motion_enabled=True, left_gripper_calibrated=True))
    )
    outcome = robot.create_publisher(PushOutcome, "last_outcome", LATCHED)
    outcome.publish(PushOutcome(code=305, message="silent for 0.3 s", push=PushTrajectory(target_id=4)))
    overview = Overview(("executor_node", "planner_node", "nobody"))
    with spinning(robot, planner), CommandNode("status", context=ros_context) as command:
        robot.start()
        planner.start()
        status.listen(command, overview)
        wait_until(lambda: {"executor_node", "planner_node"} <= set(overview.components))
        wait_until(lambda: len(overview.topics["joint_states"].arrivals) > 20)
        wait_until(lambda: overview.topics["last_outcome"].arrivals and overview.topics["driver_state"].arrivals)
        shown = status.show(command, overview, status.parse(["--seconds", "3"]))
    now = overview.topics["joint_states"].arrivals[-1]
    text = screen(overview, now, 3.0, "title", everything=True)
    assert shown == 1
    assert overview.state("executor_node", now, 3.0) == "active"
    assert overview.state("planner_node", now, 3.0) == "failed"
    assert overview.state("nobody", now, 3.0) == "missing"
    assert overview.topics["joint_states"].rate(now, 3.0) > 0.0
    for words in (
        "2 joints",
        "MOTORS_ON, takes motions, right gripper not calibrated",
        "STATE_LOST, object 4",
        "NO_TRANSFORM",
    ):
        assert words in text
    assert all(len(line) <= 110 for line in screen(overview, now, 3.0, "title").splitlines())


def good_overview(now):
    overview = Overview(("planner_node",), present={"planner_node"})
    overview.hear("planner_node: state", Component(0, "active", {}, now))
    return overview


def test_a_cell_that_is_well_says_so_and_silence_is_noticed():
    overview = good_overview(10.0)
    assert "everything is well" in screen(overview, 10.5, 3.0, "title")
    assert overview.state("planner_node", 20.0, 3.0) == "silent"
    assert overview.problems(20.0, 3.0) == ["planner_node is silent"]


def test_an_error_of_any_part_is_a_problem_and_a_warning_is_not():
    overview = good_overview(10.0)
    overview.hear("camera: frames", Component(1, "slow", {}, 10.0))
    assert overview.problems(10.0, 3.0) == []
    assert "could push now, with 1 warning (" in screen(overview, 10.0, 3.0, "title")
    overview.hear("camera: lens", Component(DiagnosticStatus.ERROR[0], "dark\nvery", {"lux": "0"}, 10.0))
    text = screen(overview, 10.0, 3.0, "title")
    assert "ERROR  lens: dark very" in text
    assert "1 to look at" in text


def test_rates_need_two_messages():
    traffic = Traffic()
    assert traffic.rate(1.0, 3.0) == 0.0
    traffic.note(1.0)
    assert traffic.rate(1.0, 3.0) == 0.0
    for tick in range(1, 11):
        traffic.note(1.0 + 0.1 * tick)
    assert traffic.rate(2.0, 3.0) == pytest.approx(10.0)
    assert traffic.rate(60.0, 3.0) == 0.0


def test_arguments_out_of_range_are_refused(capsys):
    with pytest.raises(SystemExit):
        status.parse(["--seconds", "0.5"])
    assert "need 2 to 3600" in capsys.readouterr().err
    assert status.parse([]).seconds == 4.0
