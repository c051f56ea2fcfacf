"""A driver node as the cell has one: takes trajectories and jaw openings, publishes joint and driver states.

It makes the time as well: five times as fast as the wall's where the machine allows, never ahead of its own states, and
not before what is under way has been heard: a busy machine makes everything slower, and nothing late.
"""

import threading
import time

import numpy as np
from fake_robot import ARMS, CYCLE, HOME, FakeArm
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from singulation_msgs.msg import DriverState
from std_msgs.msg import Float64MultiArray
from trajectory_msgs.msg import JointTrajectory

from singulation_core.conversions import stamp_of
from singulation_node.qos import COMMAND, STATE
from yumi_push_executor.supervision import Phase, Trajectory

PERIOD = 0.024  # s of its own time between joint states
SPEED = 5.0
PATIENCE = 2.0  # s of the wall's time that a message may be under way; after that it counts as lost
NAMES = {arm: tuple(f"yumi_rob{arm[0]}_joint_{number}" for number in range(1, 8)) for arm in ARMS}
FINGERS = {"left": "gripper_l_joint", "right": "gripper_r_joint"}


class FakeDriver(Node):
    """Two arms; what the test wants to go wrong it sets on ``arms``, ``state`` and ``change``."""

    def __init__(self, names=NAMES, **options):
        super().__init__("fake_driver", **options)
        self.names = names
        self.lock = threading.Lock()
        self.heal()
        self.trajectories, self.fastest = [], 0.0
        self.noise = np.random.default_rng(1)
        self._states = self.create_publisher(JointState, "joint_states", STATE)
        self._driver = self.create_publisher(DriverState, "driver_state", STATE)
        for arm in ARMS:
            self._listen(arm)
        self._ticks = self.create_publisher(Clock, "/clock", STATE)
        self.time = 1000.0
        self.said = lambda publisher: None  # what happens before joint states are published
        self.under_way = lambda: False  # whether somebody has still to hear of something
        self._ticked = time.monotonic()
        # Not in the group of the subscriptions: a late machine would then let time pass and no order come through.
        self.create_timer(PERIOD / SPEED, self._tick, callback_group=MutuallyExclusiveCallbackGroup())

    def heal(self):
        """Nothing is wrong, both arms at home."""
        self.arms = {arm: FakeArm(np.array(HOME[arm])) for arm in ARMS}
        self.openings, self.wanted = dict.fromkeys(ARMS, 0.0), dict.fromkeys(ARMS, 0.0)
        self.state = DriverState(
            mode=DriverState.MOTORS_ON, motion_enabled=True, left_gripper_calibrated=True, right_gripper_calibrated=True
        )
        self.change = lambda message: message  # of joint states; None drops them
        self.orders = 0
        self.plans = []  # (number of the order, seconds after it, what then happens)

    def _listen(self, arm):
        self.create_subscription(
            JointTrajectory,
            f"{arm}_arm_controller/joint_trajectory",
            lambda message: self._order(arm, message),
            COMMAND,
        )
        self.create_subscription(
            Float64MultiArray,
            f"{arm}_gripper_controller/commands",
            lambda message: self.wanted.__setitem__(arm, message.data[0]),
            COMMAND,
        )

    def _order(self, arm, message):
        assert message.header.stamp.sec == 0, "stamp 0 means now"
        places = [message.joint_names.index(name) for name in self.names[arm]]
        times = [point.time_from_start.sec + 1e-9 * point.time_from_start.nanosec for point in message.points]
        positions = [[point.positions[place] for place in places] for point in message.points]
        velocities = [[point.velocities[place] for place in places] for point in message.points]
        with self.lock:
            self.trajectories.append((self.time, arm, message))
            self.orders += 1
            self.plans = [
                (0, self.time + after, do) if at == self.orders else (at, after, do) for at, after, do in self.plans
            ]
            if self.state.motion_enabled:
                self.arms[arm].order(Trajectory(times, positions, velocities), self.time)

    def _tick(self):
        now = time.monotonic()
        if self.under_way() and now - self._ticked < PATIENCE:
            return
        self._ticked = now
        with self.lock:
            for _ in range(round(PERIOD / CYCLE)):
                self.time += CYCLE
                self._let_happen()
                for arm in ARMS:
                    self.arms[arm].cycle(self.time, self.state.motion_enabled)
                    step = 0.05 * CYCLE
                    self.openings[arm] += float(np.clip(self.wanted[arm] - self.openings[arm], -step, step))
            self.fastest = max(float(np.abs(self.arms[arm].v).max()) for arm in ARMS)
            stamp = stamp_of(self.time)
            message = self.change(self._message(stamp))
        self._ticks.publish(Clock(clock=stamp))
        if message is not None:
            self.said(self._states)
            self._states.publish(message)
        self.state.header.stamp = stamp
        self._driver.publish(self.state)

    def during(self, phase, after, do):
        """Let something happen a while [s] after the order of a phase has come; they are ordered in turn."""
        with self.lock:
            self.plans.append((self.orders + phase - Phase.GRIPPER, after, do))

    def _let_happen(self):
        due = [do for at, when, do in self.plans if at == 0 and when <= self.time]
        self.plans = [plan for plan in self.plans if plan[0] != 0 or plan[1] > self.time]
        for do in due:
            do()

    def _message(self, stamp):
        joints = {name: float(q) for arm in ARMS for name, q in zip(self.names[arm], self.arms[arm].q, strict=True)}
        joints = {name: q + 2e-5 * float(self.noise.standard_normal()) for name, q in joints.items()}
        joints |= {FINGERS[arm]: self.openings[arm] / 2.0 for arm in ARMS}
        message = JointState(name=sorted(joints), position=[joints[name] for name in sorted(joints)])
        message.header.stamp = stamp
        return message
