"""One arm of the YuMi: where its tool is, and which joint angles bring it somewhere."""

import numpy as np
from numpy.typing import ArrayLike

from singulation_core import InvalidInputError, ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics import chain
from yumi_push_executor.kinematics.model import JOINTS, arm_model
from yumi_push_executor.kinematics.postures import CLEAR_VIEW

TIP_OFFSET = 0.136  # finger tip below tool0 along the tool axis [m]: 83.7 mm to the finger base, 52.3 mm of finger

_POSITION_TOLERANCE = 1e-6  # [m]
_ROTATION_TOLERANCE = 1e-6  # [rad]
_ITERATIONS = 60


class YumiArm:
    """Kinematics of the left or right arm; angles from the shoulder to the flange (ABB axes 1, 2, 7, 3, 4, 5, 6).

    Args:
        name: ``left`` or ``right``.

    Attributes:
        lower, upper: (7,) joint limits [rad].
        velocity: (7,) joint velocity limits [rad/s].
        clear_view: (7,) posture outside the camera's view [rad].

    Raises:
        InvalidInputError: another name.
    """

    def __init__(self, name: str) -> None:
        model = arm_model(name)
        self.name = name
        self.chain = model.chain
        (self.lower, self.upper), self.velocity = model.chain.limits, model.velocity
        self.clear_view = CLEAR_VIEW[name]

    def forward(self, q: ArrayLike) -> FloatArray:
        """4x4 pose of ``tool0`` in ``yumi_body`` for (7,) angles [rad]."""
        pose = np.eye(4)
        pose[:3] = chain.places(self.chain, self.checked(q)[None]).poses[0]
        return pose

    def tip(self, q: ArrayLike) -> FloatArray:
        """4x4 pose of the point between the finger tips in ``yumi_body``; axes parallel to ``tool0``."""
        pose = self.forward(q)
        pose[:3, 3] += TIP_OFFSET * pose[:3, 2]
        return pose

    def tip_way(self, start: FloatArray, end: FloatArray) -> float:
        """Longest way of the tips per unit of a move that is straight in joint space from (7,) to (7,) [m].

        A move that takes T seconds at constant joint speeds moves the tips at most at this value / T.
        """
        return float(chain.tip_way(self.chain, start, end, TIP_OFFSET))

    def jacobian(self, q: ArrayLike) -> FloatArray:
        """(6, 7) Jacobian of ``tool0``, linear above angular, in ``yumi_body``."""
        return np.asarray(chain.places(self.chain, self.checked(q)[None]).jacobians[0])

    def inverse(self, pose: ArrayLike, seed: ArrayLike | None = None) -> FloatArray:
        """Joint angles that bring ``tool0`` to a pose, on the branch of the seed.

        Args:
            pose: (4, 4) of ``tool0`` in ``yumi_body``.
            seed: (7,) angles to start from, the clear-view posture if None.

        Returns:
            (7,) angles [rad] within the limits.

        Raises:
            SingulationError: ``UNREACHABLE`` with what is left of the error.
        """
        target = self.checked_pose(pose)
        start = np.clip(self.checked(self.clear_view if seed is None else seed), self.lower, self.upper)
        q, distance, angle = chain.solve(self.chain, start, target, start, _ITERATIONS)
        if not (distance <= _POSITION_TOLERANCE and angle <= _ROTATION_TOLERANCE):
            where = ", ".join(f"{value:.3f}" for value in target[:3, 3])
            raise SingulationError(
                ResultCode.UNREACHABLE,
                f"{self.name} arm: tool0 at ({where}) m in yumi_body is missed by {distance * 1e3:.1f} mm and "
                f"{np.rad2deg(angle):.1f} degrees",
            )
        return q

    def checked(self, q: ArrayLike) -> FloatArray:
        """A float copy of seven finite angles.

        Raises:
            InvalidInputError: another number of them, or one that is not finite.
        """
        angles = np.array(q, dtype=np.float64)
        if angles.shape != (JOINTS,) or not np.isfinite(angles).all():
            raise InvalidInputError(f"{self.name} arm: joint angles {angles.tolist()}, need {JOINTS} finite numbers")
        return angles

    def checked_pose(self, pose: ArrayLike) -> FloatArray:
        """A float copy of a 4x4 pose.

        Raises:
            InvalidInputError: wrong shape, not finite, or not a rigid transform.
        """
        matrix = np.array(pose, dtype=np.float64)
        if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
            raise InvalidInputError(f"{self.name} arm: pose of shape {matrix.shape}, need (4, 4) finite numbers")
        rotation = matrix[:3, :3]
        if not (np.abs(rotation @ rotation.T - np.eye(3)).max() <= 1e-6 and np.linalg.det(rotation) > 0.0):
            raise InvalidInputError(f"{self.name} arm: the pose's rotation is not orthonormal and right-handed")
        return matrix
