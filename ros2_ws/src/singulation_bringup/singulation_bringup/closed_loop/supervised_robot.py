"""The simulated robot under the executor's own supervision, in simulated time."""

from collections.abc import Callable, Sequence

import numpy as np

from singulation_bringup.closed_loop.stopwatch import Stopwatch
from singulation_core import Arrangement, CellGeometry, ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from singulation_core.transforms import inverse
from singulation_sim.cell import SimulatedCell
from singulation_sim.driver import JointTrajectory, TrajectoryPoint
from yumi_push_executor import MotionParameters, YumiArm, plan_clear_view
from yumi_push_executor.clearance import parts_in_view
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.lifting import plan_lift
from yumi_push_executor.supervision import (
    DriverMode,
    DriverStatus,
    Instant,
    JawOrder,
    JointRange,
    Order,
    Outcome,
    Phase,
    Sample,
    Segment,
    StateWatch,
    SupervisionLimits,
    Supervisor,
    Trajectory,
)
from yumi_push_executor.wire import JointNames, StateReader

_CYCLES_PER_STATE = 2  # joint states come at 125 Hz
_LIFT_HEIGHT, _LIFT_SPEED = 0.05, 0.1  # m, m/s: of a retreat after a fault
_LONGEST = 300.0  # s of simulated time; no motion takes so long
_NONE = np.empty(0)


class SupervisedRobot:
    """Runs motions on a simulated cell as ``executor_node`` runs them on a robot.

    Args:
        cell: driver, table and camera; time passes only while a motion runs.
        geometry: where the table is.
        limits: of the supervision.
        motion: speeds and heights.
        stopwatch: told what supervision and simulation cost.
        cancelled: asked at every state.
        on_cycle: called after every state with the cell.
    """

    def __init__(
        self,
        cell: SimulatedCell,
        geometry: CellGeometry,
        limits: SupervisionLimits,
        motion: MotionParameters,
        stopwatch: Stopwatch,
        cancelled: Callable[[], bool] = lambda: False,
        on_cycle: Callable[[SimulatedCell], None] = lambda _: None,
    ) -> None:
        self._cell, self._geometry, self._limits, self._motion = cell, geometry, limits, motion
        self._stopwatch, self._cancelled, self._on_cycle = stopwatch, cancelled, on_cycle
        self._arms = {name: YumiArm(name) for name in ARMS}
        ranges = {name: JointRange(arm.lower, arm.upper) for name, arm in self._arms.items()}
        self._speeds = {name: arm.velocity for name, arm in self._arms.items()}
        self._watch = StateWatch(limits, ranges)
        settings = cell.driver.settings
        self._names = JointNames(dict(settings.joints), dict(settings.finger_joints))
        self._reader = StateReader(self._names, limits.state_age)
        self.moved = 0.0  # s of simulated time in motions so far
        self.refused = 0  # orders that the driver did not take

    @property
    def postures(self) -> dict[str, FloatArray]:
        """(7,) measured angles of both arms [rad].

        Raises:
            SingulationError: ``NOT_READY``: the robot says nothing.
        """
        self._listen()
        latest = self._watch.latest
        if latest is None:
            raise SingulationError(ResultCode.NOT_READY, "no joint state has come yet")
        return dict(latest.positions)

    def perform(self, segments: Sequence[Segment]) -> None:
        """Run a motion to its end.

        Raises:
            SingulationError: with the supervision's code; everything stands still then.
        """
        outcome = self._run(segments)
        if outcome.code is not ResultCode.OK:
            raise SingulationError(outcome.code, outcome.text)

    def leave_view(self, seen: Arrangement) -> None:
        """Bring arms that stand before the camera, as after a push that was stopped, out of its view.

        Raises:
            SingulationError: no way out, or the motion failed.
        """
        for name in ARMS:
            postures = self.postures
            if not parts_in_view({name: postures[name]}, self._geometry):
                continue
            opening = self._cell.driver.arms[name].gripper.opening
            way = plan_clear_view(
                name, seen, cell=self._geometry, joints=postures, opening=opening, parameters=self._motion
            )
            self.perform([Segment(Phase.CLEAR_VIEW, name, trajectory=way)])

    def _run(self, segments: Sequence[Segment]) -> Outcome:
        supervisor = Supervisor(segments, self._watch, self._limits, self._speeds, self._lift)
        began = self._now
        with self._stopwatch.timed("supervise"):
            self._listen()
            step = supervisor.start(self._status(), self._instant())
            self._obey(step.orders)
        while step.outcome is None:
            with self._stopwatch.timed("simulate"):
                self._pass_time()
            with self._stopwatch.timed("supervise"):
                if self._cancelled():
                    supervisor.cancel()
                step = supervisor.step(self._listen(), self._status(), self._instant())
                self._obey(step.orders)
            if self._now - began > _LONGEST:
                raise SingulationError(ResultCode.INTERNAL, f"the supervision did not end within {_LONGEST} s")
        self.moved += self._now - began
        return step.outcome

    @property
    def _now(self) -> float:
        return self._cell.now

    def _pass_time(self) -> None:
        for _ in range(_CYCLES_PER_STATE):
            self._cell.step()
        self._on_cycle(self._cell)

    def _listen(self) -> list[Sample]:
        states = self._cell.driver.joint_states()
        latest = self._watch.latest
        if states is None or (latest is not None and latest.taken >= self._now):
            return []
        positions, velocities = states.positions.tolist(), states.velocities.tolist()
        sample = self._reader.read(states.names, positions, velocities, taken=self._now, arrived=self._now)
        return [sample] if sample is not None and self._watch.add(sample, self._instant()) else []

    def _instant(self) -> Instant:
        return Instant(self._now, self._now)

    def _status(self) -> DriverStatus:
        status = self._cell.driver.status
        calibrated = {"left": status.left_gripper_calibrated, "right": status.right_gripper_calibrated}
        mode = DriverMode(int(status.mode))
        return DriverStatus(mode, status.motion_enabled, calibrated, status.message, self._instant())

    def _obey(self, orders: Sequence[Order]) -> None:
        """What a driver refuses (motion not enabled) is lost, as on the wire; the supervision notices."""
        for order in orders:
            try:
                if isinstance(order, JawOrder):
                    self._cell.driver.command_gripper(order.arm, order.opening)
                else:
                    trajectory = _on_the_wire(order.trajectory, self._names.arms[order.arm])
                    self._cell.driver.command_arm(order.arm, trajectory)
            except SingulationError:
                self.refused += 1

    def _lift(self, arm: str, q: FloatArray) -> Trajectory | None:
        table_from_body = inverse(self._geometry.body_from_table)
        tip = table_from_body @ self._arms[arm].tip(q) @ np.array((0.0, 0.0, 0.0, 1.0))
        if float(tip[2]) >= _LIFT_HEIGHT:
            return None
        up = self._geometry.body_from_table[:3, 2]
        return plan_lift(self._arms[arm], q, up, _LIFT_HEIGHT, _LIFT_SPEED)


def _on_the_wire(trajectory: Trajectory, names: Sequence[str]) -> JointTrajectory:
    """What the driver gets of a trajectory: to start at once."""
    velocities = trajectory.velocities
    accelerations = trajectory.accelerations
    points = [
        TrajectoryPoint(
            float(moment),
            trajectory.positions[k],
            _NONE if velocities is None else velocities[k],
            _NONE if accelerations is None else accelerations[k],
            _NONE,
        )
        for k, moment in enumerate(trajectory.times)
    ]
    return JointTrajectory(names, points)
