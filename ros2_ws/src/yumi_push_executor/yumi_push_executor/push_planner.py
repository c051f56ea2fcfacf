"""Plans for the executor node: the motion of a push, the retreat after a fault, where a tip is on the table."""

import numpy as np

from singulation_core import Arrangement, ContactMode, Push
from singulation_core.polygon import FloatArray
from singulation_core.transforms import inverse
from yumi_push_executor.clearance import parts_in_view
from yumi_push_executor.executor_settings import ExecutorSettings
from yumi_push_executor.kinematics import YumiArm
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.lifting import plan_lift
from yumi_push_executor.motion import plan_clear_view, plan_motion
from yumi_push_executor.motion.parameters import MAX_OPENING
from yumi_push_executor.supervision import JointRange, Phase, Sample, Segment, Trajectory


class PushPlanner:
    """Knows the robot and where the table is.

    Args:
        settings: of the node.
    """

    def __init__(self, settings: ExecutorSettings) -> None:
        self._settings = settings
        self._arms = {arm: YumiArm(arm) for arm in ARMS}
        self._body_from_table = settings.cell.body_from_table
        self._table_from_body = inverse(self._body_from_table)

    def warm_up(self) -> None:
        """Compile what a motion and a retreat need; the first time ever this takes some seconds."""
        for arm in ARMS:
            push = Push(np.array((0.0, 0.0)), np.array((0.03, 0.0)), ContactMode.SINGLE_POINT)
            low = plan_motion(push, cell=self._settings.cell, arms=(arm,)).segment(Phase.DESCEND).trajectory
            assert low is not None
            self.lift(arm, low.end)
            parts_in_view({arm: low.end}, self._settings.cell)

    @property
    def ranges(self) -> dict[str, JointRange]:
        """Joint range per arm."""
        return {arm: JointRange(model.lower, model.upper) for arm, model in self._arms.items()}

    @property
    def speeds(self) -> dict[str, FloatArray]:
        """(7,) fastest joint speeds per arm [rad/s]."""
        return {arm: model.velocity for arm, model in self._arms.items()}

    def plan(self, push: Push, arrangement: Arrangement, sample: Sample) -> tuple[Segment, ...]:
        """The motion of a push, from where the arms are.

        Raises:
            SingulationError: no motion; the code says why.
        """
        settings = self._settings
        motion = plan_motion(
            push,
            arrangement,
            cell=settings.cell,
            joints=sample.positions,
            parameters=settings.motion,
            arms=ARMS if settings.arms == "both" else (settings.arms,),
        )
        return motion.segments

    def lift(self, arm: str, q: FloatArray) -> Trajectory | None:
        """A retreat upwards for an arm at (7,) rad; None if its tips are above everything already.

        Raises:
            SingulationError: ``UNREACHABLE``.
        """
        settings = self._settings
        if float(self.tip(arm, q)[2]) >= settings.lift_height:
            return None
        return plan_lift(self._arms[arm], q, self._body_from_table[:3, 2], settings.lift_height, settings.lift_speed)

    def clear_view(self, arm: str, sample: Sample, arrangement: Arrangement) -> Trajectory | None:
        """The way of an arm out of the camera's view; None if it is not in it.

        Raises:
            SingulationError: ``UNREACHABLE`` or ``PATH_BLOCKED``.
        """
        settings = self._settings
        if not parts_in_view({arm: sample.positions[arm]}, settings.cell):
            return None
        opening = sample.openings.get(arm, MAX_OPENING)
        return plan_clear_view(
            arm, arrangement, cell=settings.cell, joints=sample.positions, opening=opening, parameters=settings.motion
        )

    def tip(self, arm: str, q: FloatArray) -> FloatArray:
        """(3,) point between the finger tips of an arm at (7,) rad, in the table frame [m]."""
        tip = self._arms[arm].tip(q)[:3, 3]
        return np.asarray(self._table_from_body[:3, :3] @ tip + self._table_from_body[:3, 3])
