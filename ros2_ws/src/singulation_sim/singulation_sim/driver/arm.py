"""One simulated arm: its trajectory controller, its joints, its hand."""

from collections.abc import Callable, Sequence

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_sim.driver.controller import TrajectoryController
from singulation_sim.driver.gripper import Gripper
from singulation_sim.driver.safety import Phase
from singulation_sim.driver.servo import ArmServo
from singulation_sim.driver.trajectory import JointTrajectory, TrajectoryPoint

_SETTLED = 1e-9  # rad; nearer than this the lag's long tail is cut off
_EMPTY = np.empty(0)


class SimulatedArm:
    """Joints and hand of one arm.

    Args:
        controller: with the arm's joint names.
        servo: standing where the controller holds.
        gripper: the arm's hand.
        limits: lower and upper joint limits, (joints,) each [rad].
    """

    def __init__(
        self,
        controller: TrajectoryController,
        servo: ArmServo,
        gripper: Gripper,
        limits: tuple[FloatArray, FloatArray],
    ) -> None:
        self.controller, self.servo, self.gripper = controller, servo, gripper
        self._lower, self._upper = limits
        self._was_moving = False
        self._stopped_at = self.positions
        self._way_back: Callable[[float], bool] | None = None

    @property
    def joint_names(self) -> Sequence[str]:
        """In the order of all arrays."""
        return self.controller.joint_names

    @property
    def positions(self) -> FloatArray:
        """(joints,) where the joints really are [rad]."""
        return self.servo.positions

    @property
    def is_moving(self) -> bool:
        """Whether joints or fingers move or are about to."""
        return self.controller.is_moving or not self.servo.stands or self.gripper.is_moving

    def command(self, trajectory: JointTrajectory, now: float) -> None:
        """As ``TrajectoryController.command``."""
        self.controller.command(trajectory, now)

    def hold(self) -> None:
        """Forget trajectories and hold where the joints are."""
        self._was_moving = not self.servo.stands
        self._stopped_at = self.positions
        self._way_back = None
        self.controller.hold(self.positions)
        self.gripper.stop()

    def follow(self, now: float, period: float, speed_limit: float, noise: FloatArray) -> str | None:
        """One cycle of following the trajectory.

        Args:
            now: [s].
            period: [s].
            speed_limit: of every joint [rad/s].
            noise: (2, joints) errors of the measured positions and velocities [rad, rad/s].

        Returns:
            Why the robot controller shuts the motors down, None if it does not.
        """
        self.gripper.step(period)
        measured = TrajectoryPoint(now, self.positions + noise[0], self.servo.velocities + noise[1], _EMPTY, _EMPTY)
        reference = self.controller.reference(now, measured)
        inside = (self._lower <= reference) & (reference <= self._upper)
        if not inside.all():
            joint = int(np.flatnonzero(~inside)[0])
            return (
                f"{self.joint_names[joint]} was sent to {reference[joint]:.4f} rad, outside its range "
                f"{self._lower[joint]:.4f} to {self._upper[joint]:.4f}"
            )
        self._servo_to(reference, period, speed_limit)
        return None

    def _servo_to(self, reference: FloatArray, period: float, speed_limit: float) -> None:
        if self.servo.stands and float(np.abs(reference - self.positions).max()) < _SETTLED:
            return
        self.servo.follow(reference, period, speed_limit)

    def _coast(self, period: float) -> None:
        """Nothing but its own limits stops an arm whose link is down."""
        ahead = self.positions + self.servo.velocities * period
        if ((self._lower <= ahead) & (ahead <= self._upper)).all():
            self.servo.coast(period)
        else:
            self.servo.halt()

    def stopping(self, phase: Phase, period: float, back_off: float) -> bool:
        """One cycle of a phase in which no trajectory is followed; whether the arm has finished it.

        Args:
            phase: any but ``FOLLOW``.
            period: [s].
            back_off: how far behind the place where the stop began an arm goes back, in joint space [rad].
        """
        if phase is Phase.COAST:
            self._coast(period)
        elif phase is Phase.BRAKE:
            self.servo.brake(period)
        elif phase is Phase.BACK_OFF and self._was_moving:
            if self._way_back is None:
                braked = float(np.linalg.norm(self.positions - self._stopped_at))
                self._way_back = self.servo.way_back(braked + back_off)
            if not self._way_back(period):
                return False
            self.controller.hold(self.positions)
        return self.servo.stands
