"""Joint names of the robot's controllers, and measured states matched by name.

The controllers of a real cell and the simulated ones speak of joints by names that differ from driver to driver, in an
order that differs, too; everything behind this module has seven angles per arm from the shoulder to the flange.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from singulation_core import InvalidInputError
from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics.model import ARMS, JOINTS
from yumi_push_executor.supervision import Sample

_FINGER_AGE = 1.0  # s; gripper drivers report at 5 to 10 Hz


@dataclass(frozen=True, slots=True)
class JointNames:
    """Names on the wire.

    Args:
        arms: per arm seven joint names from the shoulder to the flange (ABB axes 1, 2, 7, 3, 4, 5, 6).
        fingers: per arm the joint of a finger; the jaws open by twice its position.

    Raises:
        InvalidInputError: not seven names per arm, an empty one, or one that is used twice.
    """

    arms: dict[str, tuple[str, ...]]
    fingers: dict[str, str]

    def __post_init__(self) -> None:
        for arm in ARMS:
            if len(self.arms[arm]) != JOINTS:
                raise InvalidInputError(f"joint names: the {arm} arm has {len(self.arms[arm])}, need {JOINTS}")
        names = [name for arm in ARMS for name in (*self.arms[arm], self.fingers[arm])]
        repeated = sorted({name for name in names if names.count(name) > 1})
        if repeated or "" in names:
            raise InvalidInputError(f"joint names: {repeated or 'an empty one'}; each joint needs a name of its own")


class StateReader:
    """Puts joint states together from messages that may carry all joints or some, in any order.

    Args:
        names: on the wire.
        arm_age: how far apart in time the two arms of one sample may be [s].
    """

    def __init__(self, names: JointNames, arm_age: float) -> None:
        self._names = names
        self._arm_age = arm_age
        self._positions: dict[str, tuple[float, FloatArray]] = {}
        self._velocities: dict[str, FloatArray] = {}
        self._openings: dict[str, tuple[float, float]] = {}

    def read(
        self,
        names: Sequence[str],
        positions: Sequence[float],
        velocities: Sequence[float],
        *,
        taken: float,
        arrived: float,
    ) -> Sample | None:
        """Take a message's names, positions [rad, m] and velocities [rad/s, m/s].

        Returns:
            A sample once both arms are known; None for a message that does not speak of an arm.

        Raises:
            InvalidInputError: sizes that contradict each other, a joint twice, or an arm with joints missing.
        """
        index = _index(names, positions, velocities)
        arms = [arm for arm in ARMS if self._take_arm(arm, index, positions, velocities, taken)]
        for arm in ARMS:
            finger = self._names.fingers[arm]
            if finger in index:
                self._openings[arm] = (taken, 2.0 * float(positions[index[finger]]))
        return self._sample(taken, arrived) if arms else None

    def _take_arm(
        self, arm: str, index: dict[str, int], positions: Sequence[float], velocities: Sequence[float], taken: float
    ) -> bool:
        wanted = self._names.arms[arm]
        missing = [name for name in wanted if name not in index]
        if len(missing) == JOINTS:
            return False
        if missing:
            raise InvalidInputError(f"joint states: the {arm} arm lacks {missing}")
        columns = [index[name] for name in wanted]
        self._positions[arm] = (taken, np.array([positions[column] for column in columns]))
        if len(velocities):
            self._velocities[arm] = np.array([velocities[column] for column in columns])
        else:
            self._velocities.pop(arm, None)
        return True

    def _sample(self, taken: float, arrived: float) -> Sample | None:
        near = {arm: value for arm, (time, value) in self._positions.items() if abs(taken - time) <= self._arm_age}
        if len(near) < len(ARMS):
            return None
        openings = {arm: value for arm, (time, value) in self._openings.items() if abs(taken - time) <= _FINGER_AGE}
        finite = {arm: value for arm, value in self._velocities.items() if np.isfinite(value).all()}
        return Sample(taken, arrived, near, finite, openings)


def _index(names: Sequence[str], positions: Sequence[float], velocities: Sequence[float]) -> dict[str, int]:
    """Place of each name in the message."""
    if len(positions) != len(names) or len(velocities) not in (0, len(names)):
        raise InvalidInputError(
            f"joint states: {len(names)} names, {len(positions)} positions, {len(velocities)} velocities; need as many "
            "positions as names, and as many velocities or none"
        )
    index = {name: place for place, name in enumerate(names)}
    if len(index) != len(names):
        repeated = sorted({name for name in names if list(names).count(name) > 1})
        raise InvalidInputError(f"joint states: {repeated} more than once")
    return index
