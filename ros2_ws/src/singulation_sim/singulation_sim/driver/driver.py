"""The simulated driver of both arms: what the robot controller and ros2_control together show to the outside."""

import math

import numpy as np

from singulation_core import InvalidInputError, ResultCode, SingulationError
from singulation_sim.driver.arm import SimulatedArm
from singulation_sim.driver.controller import TrajectoryController
from singulation_sim.driver.faults import FaultBoard, known_fault
from singulation_sim.driver.gripper import Gripper
from singulation_sim.driver.mode import DriverMode
from singulation_sim.driver.safety import Phase, SafetyController
from singulation_sim.driver.sensors import JointSensors
from singulation_sim.driver.servo import ArmServo
from singulation_sim.driver.settings import ARMS, PERIOD, DriverSettings, DriverStatus
from singulation_sim.driver.states import JointStates
from singulation_sim.driver.trajectory import JointTrajectory, accepted
from yumi_push_executor.kinematics import YumiArm


class SimulatedDriver:
    """Both arms, stepped every ``PERIOD``; time comes from the caller.

    Args:
        settings: of the robot.
        start: time of the first cycle [s].
        seed: of the measurement noise.
    """

    def __init__(self, settings: DriverSettings | None = None, start: float = 0.0, seed: int = 0) -> None:
        self.settings = settings or DriverSettings()
        self.now = start
        self.arms = {name: _arm(name, self.settings) for name in ARMS}
        self._safety = SafetyController()
        self._faults = FaultBoard()
        self._sensors = JointSensors(self.settings, seed)
        self._late: list[tuple[float, str, JointTrajectory]] = []

    @property
    def status(self) -> DriverStatus:
        """What the driver reports of itself."""
        left, right = (self.arms[name].gripper.calibrated for name in ARMS)
        safety = self._safety
        return DriverStatus(safety.mode, safety.motion_enabled, left, right, safety.message)

    @property
    def is_moving(self) -> bool:
        """Whether anything moves or is about to."""
        return any(arm.is_moving for arm in self.arms.values()) or bool(self._late)

    def command_arm(self, name: str, trajectory: JointTrajectory) -> None:
        """What arrives on ``<arm>_arm_controller/joint_trajectory``.

        Raises:
            SingulationError: ``REJECTED`` while motion is not enabled, ``INVALID_INPUT`` as ``accepted`` says.
        """
        arm = self._arm(name)
        self._require_motion(f"{name} arm: trajectory")
        accepted(trajectory, arm.joint_names, self.now)
        delay = self._faults.value("delay_commands", self.now)
        if self._safety.phase is Phase.COAST or self._faults.present("drop_commands", self.now):
            return
        if delay is not None:
            self._late.append((self.now + delay, name, trajectory))
        else:
            arm.command(trajectory, self.now)

    def command_gripper(self, name: str, opening: float) -> None:
        """What arrives on ``<arm>_gripper_controller/commands``: jaw opening [m].

        Raises:
            SingulationError: ``REJECTED`` while motion is not enabled, else as ``Gripper.command``.
        """
        arm = self._arm(name)
        self._require_motion(f"{name} gripper: command")
        arm.gripper.command(opening)

    def inject(self, fault: str, value: float = 0.0) -> None:
        """Make a fault of ``FAULTS`` happen.

        Raises:
            InvalidInputError: unknown name, or a value that is not finite.
        """
        kind = known_fault(fault)
        if not math.isfinite(value):
            raise InvalidInputError(f"fault {fault}: value {value}, need a finite number")
        if fault == "collision":
            self.collide("motion supervision tripped", value)
        elif kind.stop is not None:
            self._stop(kind.stop, fault, self.now + value if value > 0.0 else math.inf)
        elif fault == "egm_timeout":
            self._safety.lose_link(self.now + (value if value > 0.0 else self.settings.egm_timeout))
        elif fault.startswith("gripper"):
            self._fault_hands(fault, value)
        else:
            self._faults.set(fault, value, self.now)

    def collide(self, message: str, handler_time: float = 0.0) -> None:
        """Motion supervision trips; ``handler_time`` as the value of the fault ``collision``."""
        wait = handler_time or self.settings.collision_handler_time
        self._hold()
        self._safety.collide(message, wait if wait >= 0.0 else math.inf)

    def reset(self) -> None:
        """All faults gone, everything acknowledged, motors on; the arms hold where they are."""
        self._faults.clear()
        self._hold()
        self._safety.reset()
        for arm in self.arms.values():
            arm.gripper.stuck = False
            arm.gripper.calibrated = self.settings.grippers_calibrated

    def step(self) -> None:
        """One cycle of ``PERIOD``."""
        self.now += PERIOD
        self._deliver_late()
        phase = self._safety.phase
        if phase is Phase.FOLLOW:
            self._follow()
        else:
            finished = [arm.stopping(phase, PERIOD, self.settings.back_off) for arm in self.arms.values()]
            self._safety.advance(self.now, all(finished))
            if phase is Phase.COAST and self._safety.phase is not phase:
                self._hold()

    def joint_states(self) -> JointStates | None:
        """Measured states of all joints, with the faults that are present; None if they are lost."""
        frozen = self._safety.phase is Phase.COAST
        return self._sensors.shown(self.arms, self._faults, self.now, frozen)

    def _follow(self) -> None:
        limit = self._faults.value("slow", self.now)
        for arm in self.arms.values():
            noise = self._sensors.noise() if arm.controller.is_moving else np.zeros((2, 1))
            problem = arm.follow(self.now, PERIOD, math.inf if limit is None else limit, noise)
            if problem is not None:
                self._stop(DriverMode.MOTORS_OFF, problem, math.inf)
                return

    def _deliver_late(self) -> None:
        due = [item for item in self._late if item[0] <= self.now]
        self._late = [item for item in self._late if item[0] > self.now]
        for _, name, trajectory in due:
            # What has become wrong while it was late (its end is in the past now) is refused like anything else.
            try:
                self.arms[name].command(trajectory, self.now)
            except InvalidInputError:
                continue

    def _stop(self, mode: DriverMode, message: str, until: float) -> None:
        self._hold()
        self._safety.stop(mode, message, until)

    def _hold(self) -> None:
        self._late.clear()
        for arm in self.arms.values():
            arm.hold()

    def _fault_hands(self, fault: str, value: float) -> None:
        chosen = {0: ARMS, 1: ("left",), 2: ("right",)}.get(value)  # type: ignore[call-overload]  # 1.0 == 1
        if chosen is None:
            raise InvalidInputError(f"fault {fault}: value {value}; 0 is both hands, 1 left, 2 right")
        for name in chosen:
            gripper = self.arms[name].gripper
            gripper.stuck = gripper.stuck or fault == "gripper_stuck"
            gripper.calibrated = gripper.calibrated and fault != "gripper_uncalibrated"

    def _require_motion(self, what: str) -> None:
        if not self._safety.motion_enabled:
            raise SingulationError(
                ResultCode.REJECTED,
                f"{what} refused, motion is not enabled: {self._safety.mode.name}, {self._safety.message}",
            )

    def _arm(self, name: str) -> SimulatedArm:
        if name not in self.arms:
            raise InvalidInputError(f"arm {name!r}; one of: {', '.join(ARMS)}")
        return self.arms[name]


def _arm(name: str, settings: DriverSettings) -> SimulatedArm:
    model = YumiArm(name)
    home = model.clear_view
    return SimulatedArm(
        TrajectoryController(settings.joints[name], home),
        ArmServo(home, model.velocity, settings.lag, settings.braking),
        Gripper(calibrated=settings.grippers_calibrated),
        (model.lower, model.upper),
    )
