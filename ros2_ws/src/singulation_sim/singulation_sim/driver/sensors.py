"""What is measured of the joints, and what faults make of it."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_sim.driver.arm import SimulatedArm
from singulation_sim.driver.faults import FaultBoard
from singulation_sim.driver.settings import ARMS, DriverSettings
from singulation_sim.driver.states import JointStates

_WRONG_VALUES = {"nan_states": np.nan, "zero_states": 0.0}


class JointSensors:
    """Measured states of all joints.

    Args:
        settings: names and noise.
        seed: of the noise.
    """

    def __init__(self, settings: DriverSettings, seed: int) -> None:
        self._settings = settings
        self._rng = np.random.default_rng(seed)
        self._last: JointStates | None = None

    def noise(self) -> FloatArray:
        """(2, 7) errors of the positions and velocities of one arm [rad, rad/s]."""
        sigma = np.array(((self._settings.position_noise,), (self._settings.velocity_noise,)))
        return np.asarray(sigma * self._rng.standard_normal((2, 7)))

    def shown(
        self, arms: Mapping[str, SimulatedArm], faults: FaultBoard, now: float, frozen: bool
    ) -> JointStates | None:
        """The states to be reported at ``now`` [s]; None for none at all.

        Args:
            arms: as they really are.
            faults: those present.
            now: [s].
            frozen: whether the link is down, so that the last states are repeated.
        """
        if faults.present("drop_states", now):
            return None
        if frozen or faults.present("freeze_states", now):
            self._last = self._last or self._measured(arms)
            return self._last
        self._last = self._measured(arms)
        for fault, value in _WRONG_VALUES.items():
            if faults.present(fault, now):
                filled = np.full_like(self._last.positions, value)
                return replace(self._last, positions=filled, velocities=filled)
        return self._last

    def _measured(self, arms: Mapping[str, SimulatedArm]) -> JointStates:
        """True states of both arms, then of both hands, with noise on the arms."""
        joints = [np.stack((arms[name].positions, arms[name].servo.velocities)) + self.noise() for name in ARMS]
        hands = [arms[name].gripper for name in ARMS]
        fingers = np.array([[hand.finger_position for hand in hands], [hand.finger_velocity for hand in hands]])
        names = [joint for name in ARMS for joint in arms[name].joint_names]
        names += [self._settings.finger_joints[name] for name in ARMS]
        positions, velocities = np.hstack((*joints, fingers))
        return JointStates(tuple(names), positions, velocities)
