"""Executor node, driver node and client in one process, with short motions of a scripted planner."""

import threading
from dataclasses import replace

import numpy as np
from fake_driver import FakeDriver
from fake_robot import ARMS, HOME, RANGES, SPEEDS, offsets, smooth
from rclpy.node import Node
from rclpy.parameter import Parameter
from singulation_msgs.action import ExecutePush
from singulation_msgs.msg import Arrangement, DriverState, PushOutcome, PushTrajectory

from singulation_core.conversions import stamp_of
from singulation_node.action_client import PatientActionClient
from singulation_node.qos import LATCHED, STATE
from singulation_node.testing import Mailbox, wait_until
from yumi_push_executor.executor_node import ExecutorNode
from yumi_push_executor.supervision import ArmOrder, Phase, Segment

# A busy test machine is no fault of the robot.
PATIENT = {"state_age": 0.6, "state_delay": 2.0, "blind_time": 5.0, "lag": 0.6, "start_latency": 1.5, "driver_age": 3.0}
REACH = (offsets(0.1, 0.1), offsets(0.1, 0.15), offsets(0.2, 0.15), offsets(0.2, 0.1), offsets())


class ScriptedPlanner:
    """Six short segments from where the arm is; ``trouble`` is called first and may raise."""

    def __init__(self):
        self.ranges, self.speeds = RANGES, SPEEDS
        self.arm, self.duration = "left", 0.3
        self.trouble = lambda: None
        self.seen = None
        self.lifts = 0

    def warm_up(self):
        pass

    def plan(self, push, arrangement, sample):
        self.trouble()
        self.seen = arrangement
        here, segments = sample.positions[self.arm], [Segment(Phase.GRIPPER, self.arm, opening=0.01)]
        for phase, offset in zip(list(Phase)[2:7], REACH, strict=True):
            there = HOME[self.arm] + offset
            segments.append(Segment(phase, self.arm, smooth(here, there, self.duration)))
            here = there
        return tuple(segments)

    def lift(self, arm, q):
        self.lifts += 1
        return smooth(q, q - offsets(0.0, 0.05), 0.3)

    def clear_view(self, arm, sample, arrangement):
        self.trouble()
        here = sample.positions[arm]
        return None if np.abs(here - HOME[arm]).max() < 0.02 else smooth(here, HOME[arm], 0.5)

    def tip(self, arm, q):
        return np.array((q[0], q[1], q[2]))


class ScriptedExecutor(ExecutorNode):
    """The node with that planner; ``sent`` counts the trajectories it has ordered."""

    def __init__(self, **options):
        self.planner = ScriptedPlanner()
        self.sent = 0
        super().__init__(**options)

    def configure(self):
        super().configure()
        controllers, send = self._controllers, self._controllers.send

        def counted(order):
            self.sent += isinstance(order, ArmOrder)
            send(order)

        controllers.send = counted
        self._execution._outside = replace(self._execution._outside, send=counted)

    def make_planner(self):
        return self.planner


class NodeCell:
    """All three nodes; ``nodes`` have to be spun."""

    def __init__(self, context, **parameters):
        values = PATIENT | {"need_objects": False, "use_sim_time": True} | parameters
        overrides = [Parameter(name, value=value) for name, value in values.items()]
        self.executor = ScriptedExecutor(context=context, parameter_overrides=overrides)
        self.driver = FakeDriver(context=context)
        self.client = Node("client", context=context)
        self.nodes = (self.executor, self.driver, self.client)
        self.action = PatientActionClient(self.client, ExecutePush, "execute_push")
        self.outcomes = Mailbox(self.client, PushOutcome, "last_outcome", LATCHED)
        self.objects = self.client.create_publisher(Arrangement, "objects", STATE)
        self.pushes = self.client.create_publisher(PushTrajectory, "push", STATE)
        self.phases = []
        self._heard = None  # by the executor when the newest joint states were published
        self.driver.said, self.driver.under_way = self._said, self._under_way

    def _said(self, publisher):
        view = getattr(self.executor, "_view", None)
        listens = view is not None and publisher.get_subscription_count() > 0
        self._heard = (view, view.messages) if listens else None

    def _under_way(self):
        """Whether the newest joint states or an order have still to be heard."""
        states = self._heard is not None and self._heard == (self.executor._view, self.executor._view.messages)
        return states or len(self.driver.trajectories) < self.executor.sent

    def start(self):
        assert self.executor.start()
        self.ready()

    def ready(self):
        """Until a push would be taken."""
        view = self.executor._view
        wait_until(self.action.server_is_ready, what="the action")
        wait_until(lambda: view.driver and view.watch.latest, what="states")
        wait_until(lambda: not self.executor._controllers.problems(), what="controllers")

    def heal(self):
        """Whatever a test has broken; both arms at home."""
        driver, planner = self.driver, self.executor.planner
        wait_until(lambda: len(driver.trajectories) >= self.executor.sent, what="the last order")
        with driver.lock:
            driver.heal()
            healed = driver.time
        planner.trouble, planner.arm, planner.duration = (lambda: None), "left", 0.3
        self.phases.clear()
        view = self.executor._view
        wait_until(
            lambda: (
                view.watch.fault(self.executor.instant()) is None
                and min(view.watch.latest.taken, view.driver.seen.time) > healed
                and view.driver.mode == DriverState.MOTORS_ON
                and view.driver.motion_enabled
                and view.driver.calibrated["left"]
                and all(np.abs(view.watch.latest.positions[arm] - HOME[arm]).max() < 0.01 for arm in ARMS)
            ),
            what="good states",
        )

    def push(self, **changes):
        """A push that is fresh now."""
        message = PushTrajectory()
        message.header.frame_id = "table"
        message.header.stamp = stamp_of(self.driver.time)
        message.end.x = 0.05
        for name, value in changes.items():
            setattr(message, name, value)
        return message

    def send(self, message=None):
        """The goal handle of a push."""
        goal = ExecutePush.Goal(push=message or self.push())
        future = self.action.send_goal_async(goal, lambda heard: self.phases.append(Phase(heard.feedback.phase)))
        wait_until(future.done, what="goal response")
        assert future.result().accepted
        return future.result()

    def result(self, goal):
        """(status, result) of a goal."""
        future = goal.get_result_async()
        wait_until(future.done, 30.0, "result")
        return future.result().status, future.result().result

    def execute(self, message=None):
        return self.result(self.send(message))

    def reach(self, phase):
        """Until the feedback has said so."""
        known = len(self.outcomes.messages)
        wait_until(lambda: phase in self.phases or len(self.outcomes.messages) > known, what=phase.name)
        assert phase in self.phases, self.outcomes.messages[-1].message

    def stands(self):
        """Whether no joint of either arm moves, by what the driver really does."""
        with self.driver.lock:
            return self.driver.fastest < 0.02


class Blocker:
    """Holds a thread until released, for a moment that would otherwise be too short."""

    def __init__(self):
        self.reached, self.released = threading.Event(), threading.Event()

    def __call__(self):
        self.reached.set()
        assert self.released.wait(20.0)
