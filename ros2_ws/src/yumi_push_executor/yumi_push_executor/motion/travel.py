"""Moves of one arm between the straight lines of a push, every one checked for clearance."""

import numpy as np

from singulation_core import CellGeometry, ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from yumi_push_executor.clearance import Checker, Stage
from yumi_push_executor.kinematics import TIP_OFFSET, YumiArm, chain
from yumi_push_executor.motion.lines import straight_line
from yumi_push_executor.motion.parameters import MotionParameters
from yumi_push_executor.motion.timing import joint_move
from yumi_push_executor.supervision.trajectory import Trajectory

# Largest way of any joint and of the tips between two checked postures [m]. The velocity along a rigid link lies
# between those of its ends, so between them nothing comes nearer than half of it below the margin.
_STEP = 0.008
_COARSE = 25  # postures from which that way is estimated
_BESIDE = 0.10  # [m] beside the workspace: a low arm within it rises before it travels


class Travel:
    """Checked moves of one arm.

    Args:
        arm: that moves.
        checker: of the same arm.
        cell: where the table is.
        parameters: of the motion.
    """

    def __init__(self, arm: YumiArm, checker: Checker, cell: CellGeometry, parameters: MotionParameters) -> None:
        self._arm, self._checker, self._parameters = arm, checker, parameters
        self._cell, self._pose = cell, cell.body_from_table

    @property
    def checked(self) -> int:
        """Postures checked so far."""
        return self._checker.checked

    def move(self, start: FloatArray, end: FloatArray, stage: Stage, where: str) -> Trajectory:
        """Straight in joint space.

        Raises:
            SingulationError: ``PATH_BLOCKED`` with the first way-point that is not clear.
        """
        coarse = np.linspace(start, end, _COARSE)
        step = chain.longest_step(self._arm.chain, coarse, TIP_OFFSET)
        between = np.linspace(start, end, int(np.ceil(step * (_COARSE - 1) / _STEP)) + 1)
        self.require_clear(between, stage, where)
        return joint_move(self._arm, start, end, self._parameters)

    def rise(self, start: FloatArray, height: float, stage: Stage, where: str) -> Trajectory:
        """Straight away from the table by ``height`` [m].

        Raises:
            SingulationError: ``UNREACHABLE`` or ``PATH_BLOCKED`` with the worst or first way-point.
        """
        speed = self._parameters.vertical_speed
        up = np.asarray(self._pose[:3, 2])
        rise = straight_line(self._arm, start, up, height, speed, self._parameters, None, where)
        self.require_clear(self.along(rise), stage, where)
        return rise

    def lift(self, present: FloatArray, height: float) -> Trajectory | None:
        """Straight up to ``height`` [m] above the table if the tips are low over it, as after a push that was stopped.

        Raises:
            SingulationError: ``UNREACHABLE`` or ``PATH_BLOCKED``.
        """
        x, y, z = self.tip_in_table(present)
        x_min, x_max, y_min, y_max = self._cell.workspace
        beside = max(x_min - x, x - x_max, y_min - y, y - y_max)
        if beside > _BESIDE or z > height - 1e-3:
            return None
        return self.rise(present, height - z, Stage.LEAVE, "rising from where it stands")

    def tip_in_table(self, q: FloatArray) -> FloatArray:
        """(3,) point between the tips, in ``table`` [m]."""
        tip = chain.tips(self._arm.chain, q[None], TIP_OFFSET)[0]
        return np.asarray(self._pose[:3, :3].T @ (tip - self._pose[:3, 3]))

    def along(self, trajectory: Trajectory) -> FloatArray:
        """Way-points of a straight line, both ends and enough between them to check."""
        tips = chain.tips(self._arm.chain, trajectory.positions, TIP_OFFSET)
        gone = np.concatenate(([0.0], np.cumsum(np.sqrt((np.diff(tips, axis=0) ** 2).sum(axis=1)))))
        wanted = np.linspace(0.0, gone[-1], int(np.ceil(gone[-1] / _STEP)) + 1)
        return np.asarray(trajectory.positions[np.unique(np.searchsorted(gone, wanted).clip(max=len(gone) - 1))])

    def require_clear(self, postures: FloatArray, stage: Stage, where: str) -> None:
        """Refuse (n, 7) postures of which one is not clear.

        Raises:
            SingulationError: ``PATH_BLOCKED``.
        """
        found = self._checker.first_contact(postures, stage)
        if found is None:
            return
        index, contact = found
        point = f", way-point {index + 1} of {len(postures)}" if len(postures) > 1 else ""
        raise SingulationError(ResultCode.PATH_BLOCKED, f"{self._arm.name} arm {where}{point}: {contact}")
