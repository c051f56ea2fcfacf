"""The simulated driver under the executor's supervision, in simulated time, with a record of what really moved."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from singulation_core import Arrangement, CellGeometry, SingulationError
from singulation_core.polygon import FloatArray
from singulation_sim.driver import PERIOD, SimulatedDriver, TrajectoryPoint
from singulation_sim.driver import JointTrajectory as DriverTrajectory
from yumi_push_executor.executor_settings import ExecutorSettings
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.push_planner import PushPlanner
from yumi_push_executor.supervision import (
    ArmOrder,
    DriverMode,
    DriverStatus,
    Instant,
    Order,
    Outcome,
    Phase,
    Sample,
    Segment,
    StateWatch,
    Step,
    SupervisionLimits,
    Supervisor,
)
from yumi_push_executor.wire import StateReader

_CYCLES_PER_STATE = 1  # joint states come at 250 Hz, EGM's rate
_DELAY = 0.004  # s from an order to its arrival at the driver
_LONGEST = 120.0  # s; no push takes so long
_AFTER = 25  # cycles
_NONE = np.empty(0)


@dataclass(eq=False)
class Record:
    """What happened during one motion.

    Args:
        times: (n,) of each cycle [s].
        joints: per cycle (14,) true joint positions [rad].
        speeds: per cycle the fastest true joint speed [rad/s].
        orders: time and phase of each order.
        phases: when each phase began.
    """

    times: list[float] = field(default_factory=list)
    joints: list[FloatArray] = field(default_factory=list)
    speeds: list[float] = field(default_factory=list)
    orders: list[tuple[float, Phase]] = field(default_factory=list)
    phases: dict[Phase, float] = field(default_factory=dict)


class BenchRobot:
    """Runs motions; what ``executor_node`` does with topics is done with calls here.

    Args:
        limits: of the supervision.
        seed: of the measurement noise.
    """

    def __init__(self, limits: SupervisionLimits | None = None, seed: int = 0) -> None:
        self.settings = ExecutorSettings()
        self.planner = PushPlanner(self.settings)
        self.limits = limits or self.settings.limits
        self.driver = SimulatedDriver(start=1.0, seed=seed)
        self.watch = StateWatch(self.limits, self.planner.ranges)
        self._reader = StateReader(self.settings.joint_names, self.limits.state_age)
        self._waiting: list[tuple[float, Order]] = []
        self.record = Record()
        self.outcomes = 0  # of the last motion, counted for a tenth of a second after the first
        for _ in range(50):
            self.cycle()

    @property
    def sample(self) -> Sample:
        """Newest good joint states."""
        latest = self.watch.latest
        if latest is None:
            raise RuntimeError("the driver reports no states")
        return latest

    @property
    def geometry(self) -> CellGeometry:
        """Where the table is."""
        return self.settings.cell

    def tip(self, arm: str) -> FloatArray:
        """(3,) where the tips of an arm really are, in ``table`` [m]."""
        return self.planner.tip(arm, self.driver.arms[arm].positions)

    def heal(self) -> None:
        """Reset the driver and let it report."""
        self.driver.reset()
        self._waiting.clear()
        for _ in range(50):
            self.cycle()

    def run(self, segments: Sequence[Segment], on_cycle: Callable[[Step, Supervisor], None]) -> Outcome:
        """One motion to its end.

        Raises:
            SingulationError: it was refused.
        """
        clear = self.planner.clear_view
        supervisor = Supervisor(
            segments,
            self.watch,
            self.limits,
            self.planner.speeds,
            self.planner.lift,
            lambda arm, _: clear(arm, self.sample, Arrangement(())),
        )
        self.record = Record()
        step = supervisor.start(self._status(), self._instant())
        began = self.driver.now
        while step.outcome is None:
            self._take(step)
            on_cycle(step, supervisor)
            step = supervisor.step(self.cycle(), self._status(), self._instant())
            if self.driver.now - began > _LONGEST:
                raise RuntimeError(f"no outcome within {_LONGEST} s")
        self._take(step)
        outcome, self.outcomes = step.outcome, 1
        for _ in range(_AFTER):
            step = supervisor.step(self.cycle(), self._status(), self._instant())
            self.outcomes += step.outcome is not outcome or bool(step.orders)
        return outcome

    def cycle(self) -> list[Sample]:
        """Let the driver go on until its next joint states; those that are good."""
        for _ in range(_CYCLES_PER_STATE):
            self._deliver()
            self.driver.step()
            arms = [self.driver.arms[arm] for arm in ARMS]
            self.record.times.append(self.driver.now)
            self.record.joints.append(np.concatenate([arm.positions for arm in arms]))
            self.record.speeds.append(max(float(np.abs(arm.servo.velocities).max()) for arm in arms))
        states = self.driver.joint_states()
        if states is None:
            return []
        now = self.driver.now
        sample = self._reader.read(
            states.names, states.positions.tolist(), states.velocities.tolist(), taken=now, arrived=now
        )
        return [sample] if sample is not None and self.watch.add(sample, self._instant()) else []

    def _take(self, step: Step) -> None:
        self.record.phases.setdefault(step.phase, self.driver.now)
        for order in step.orders:
            self.record.orders.append((self.driver.now, step.phase))
            self._waiting.append((self.driver.now + _DELAY, order))

    def _deliver(self) -> None:
        while self._waiting and self._waiting[0][0] <= self.driver.now + 0.5 * PERIOD:
            _, order = self._waiting.pop(0)
            try:
                self._obey(order)
            except SingulationError:
                continue  # a driver that does not take an order says nothing, as on the wire

    def _obey(self, order: Order) -> None:
        if not isinstance(order, ArmOrder):
            self.driver.command_gripper(order.arm, order.opening)
            return
        trajectory = order.trajectory
        speeds = trajectory.velocities
        points = [
            TrajectoryPoint(float(time), trajectory.positions[k], _NONE if speeds is None else speeds[k], _NONE, _NONE)
            for k, time in enumerate(trajectory.times)
        ]
        self.driver.command_arm(order.arm, DriverTrajectory(self.settings.joint_names.arms[order.arm], points))

    def _instant(self) -> Instant:
        return Instant(self.driver.now, self.driver.now)

    def _status(self) -> DriverStatus:
        status = self.driver.status
        calibrated = {"left": status.left_gripper_calibrated, "right": status.right_gripper_calibrated}
        return DriverStatus(
            DriverMode(int(status.mode)), status.motion_enabled, calibrated, status.message, self._instant()
        )
