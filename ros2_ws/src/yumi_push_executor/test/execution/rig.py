"""A robot, its states and a supervisor without ROS. Time is a number; seven seconds of motion take a quarter of one."""

from collections.abc import Callable

import numpy as np
import pytest
from fake_robot import ARMS, CYCLE, HOME, RANGES, SPEEDS, FakeArm, offsets, push_segments, smooth

from singulation_core import ResultCode
from yumi_push_executor.supervision import (
    ArmOrder,
    DriverMode,
    DriverStatus,
    Instant,
    Outcome,
    Phase,
    Sample,
    StateWatch,
    SupervisionLimits,
    Supervisor,
)


class Rig:
    """A robot, its states and a supervisor; ``events`` happen at given times after the start of the motion."""

    def __init__(self, limits=None, noise=2e-5, seed=0):
        self.limits = limits or SupervisionLimits()
        self.noise, self.rng = noise, np.random.default_rng(seed)
        self.now, self.wall, self.wall_rate = 100.0, 5000.0, 1.0
        self.watch = StateWatch(self.limits, RANGES)
        self.driver = None
        self.orders, self.path, self.steps = [], [], []
        self.heal()

    def heal(self):
        """Everything as it should be, both arms at home and standing; the supervision remembers what it has seen."""
        self.arms = {arm: FakeArm(np.array(HOME[arm])) for arm in ARMS}
        self.openings = dict.fromkeys(ARMS, 0.0)
        self.wanted = dict.fromkeys(ARMS, 0.0)
        self.jaw_speed = 0.05
        self.calibrated = dict.fromkeys(ARMS, True)
        self.mode, self.enabled, self.driver_talks, self.message = DriverMode.MOTORS_ON, True, True, ""
        self.corrupt: Callable[[Sample], Sample | None] = lambda sample: sample
        self.lift, self.lift_error, self.asked_to_lift = 0.08, None, 0
        self.clear, self.clear_error = False, None
        self.skip_steps = False
        for _ in range(75):
            self.cycle()

    def plan_lift(self, arm, q):
        self.asked_to_lift += 1
        if self.lift_error is not None:
            raise self.lift_error
        return None if not self.lift else smooth(q, q - offsets(0.0, self.lift), 0.4)

    def plan_clear(self, arm, q):
        if self.clear_error is not None:
            raise self.clear_error
        return smooth(q, HOME[arm], 1.0) if self.clear else None

    def instant(self):
        return Instant(self.now, self.wall)

    def cycle(self):
        """One cycle of the robot; the samples it lets out."""
        self.now += CYCLE
        self.wall += CYCLE * self.wall_rate
        for name, arm in self.arms.items():
            arm.cycle(self.now, self.enabled)
            reach = self.jaw_speed * CYCLE
            self.openings[name] += min(max(self.wanted[name] - self.openings[name], -reach), reach)
        if self.driver_talks:
            self.driver = DriverStatus(self.mode, self.enabled, dict(self.calibrated), self.message, self.instant())
        sample = self.corrupt(self.measured())
        self.path.append((self.now, {arm: self.arms[arm].q for arm in ARMS}))
        return [] if sample is None or not self.watch.add(sample, self.instant()) else [sample]

    def measured(self):
        noisy = {arm: self.arms[arm].q + self.noise * self.rng.standard_normal(7) for arm in ARMS}
        return Sample(self.now, self.wall, noisy, {}, dict(self.openings))

    def obey(self, step):
        self.steps.append(step)
        for order in step.orders:
            self.orders.append((self.now, step.phase, order))
            if isinstance(order, ArmOrder):
                if self.enabled:
                    self.arms[order.arm].order(order.trajectory, self.now)
            else:
                self.wanted[order.arm] = order.opening

    def supervisor(self, segments=None):
        return Supervisor(segments or push_segments(), self.watch, self.limits, SPEEDS, self.plan_lift, self.plan_clear)

    def run(self, segments=None, events=(), until=30.0) -> Outcome:
        """A motion to its end; ``events`` are (phase, seconds after the phase was first seen, function)."""
        self.orders.clear()
        self.steps.clear()
        supervisor = self.supervisor(segments)
        self.obey(supervisor.start(self.driver, self.instant()))
        self.began, self.happened, seen = self.now, None, {}
        waiting = list(events)
        while self.now - self.began < until:
            fresh = self.cycle()
            seen.setdefault(self.steps[-1].phase, self.now)
            for event in list(waiting):
                phase, after, function = event
                if phase in seen and self.now - seen[phase] >= after:
                    waiting.remove(event)
                    self.happened = self.happened or self.now
                    function(self, supervisor)
            if self.skip_steps:
                continue
            self.obey(supervisor.step(fresh, self.driver, self.instant()))
            if self.steps[-1].outcome is not None:
                return self.steps[-1].outcome
        pytest.fail(f"no outcome within {until} s")

    def standstill(self, speed=0.02):
        """Seconds from the first order to stop until no joint moves faster than ``speed`` [rad/s] ever again."""
        ordered = next(time for time, phase, _ in self.orders if phase is Phase.STOPPING)
        lifted = [time for time, phase, _ in self.orders if phase is Phase.STOPPING and time > ordered]
        end = lifted[0] if lifted else self.now
        self.path = [(time, arms) for time, arms in self.path if time >= self.began]
        times = np.array([time for time, _ in self.path])
        joints = np.array([np.concatenate((arms["left"], arms["right"])) for _, arms in self.path])
        fast = np.abs(np.diff(joints, axis=0)).max(axis=1) / CYCLE > speed
        moving = times[1:][fast & (times[1:] >= ordered) & (times[1:] <= end)]
        return float(moving[-1] - ordered) if len(moving) else 0.0

    def reaction(self):
        """Seconds from the first event to the first order to stop."""
        return next(time for time, phase, _ in self.orders if phase is Phase.STOPPING) - self.happened

    def fastest_command(self):
        """Largest change of any commanded joint position from one cycle to the next, of both arms [rad/s]."""
        return max(
            float(np.abs(np.diff(np.array(arm.references), axis=0)).max(initial=0.0)) for arm in self.arms.values()
        )

    def require_good_push(self):
        """After whatever happened the next push works."""
        self.heal()
        assert self.run().code is ResultCode.OK


def set_arm(name="left", **values):
    """An event that changes an arm of the rig."""
    return lambda rig, _: [setattr(rig.arms[name], key, value) for key, value in values.items()]


def set_rig(**values):
    """An event that changes the rig."""
    return lambda rig, _: [setattr(rig, key, value) for key, value in values.items()]
