"""From the straight lines of a push to a whole motion: the way there and the way out, everything checked."""

from itertools import pairwise, product

import numpy as np

from singulation_core import CellGeometry, ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from yumi_push_executor.clearance import Checker, Stage
from yumi_push_executor.kinematics import CLEAR_VIEW, TIP_OFFSET, chain
from yumi_push_executor.motion.lines import Lines, straight_line
from yumi_push_executor.motion.parameters import MotionParameters
from yumi_push_executor.motion.timing import backwards, joined, joint_move
from yumi_push_executor.supervision.segment import Phase, Segment
from yumi_push_executor.supervision.trajectory import Trajectory

# Largest way of any joint and of the tips between two checked postures [m]. The velocity along a rigid link lies
# between those of its ends, so between them nothing comes nearer than half of it below the margin.
_STEP = 0.008
_COARSE = 25
_EXTRA_RISE = (0.0, 0.05, 0.1)  # [m] above the travel height, tried in turn
_NEAR_TABLE = 0.10  # [m] beside the workspace: a low arm within it rises before it travels


class Completion:
    """One candidate on its way to a motion.

    Args:
        lines: straight parts.
        checker: of the same arm.
        present: (7,) angles of the arm now [rad].
        cell: where the table is.
        parameters: of the motion.
    """

    def __init__(
        self, lines: Lines, checker: Checker, present: FloatArray, cell: CellGeometry, parameters: MotionParameters
    ) -> None:
        self._lines, self._checker, self._present = lines, checker, present
        self._arm, self._cell, self._parameters = lines.arm, cell, parameters
        self._up = np.asarray(cell.body_from_table[:3, 2])
        self._clear_view = CLEAR_VIEW[lines.arm.name]

    def segments(self, opening: float) -> tuple[Segment, ...]:
        """All segments in order.

        Raises:
            SingulationError: ``PATH_BLOCKED`` or ``UNREACHABLE`` with the worst offender.
        """
        lines, name = self._lines, self._arm.name
        # The narrowest places first: most refusals fall here, at the price of a few postures.
        self._require_clear(lines.down.end[None], Stage.DESCEND, "at the start of the push")
        self._require_clear(lines.push.end[None], Stage.PUSH, "at the end of the push")
        self._require_clear(self._along(lines.down), Stage.DESCEND, "going down")
        self._require_clear(self._along(lines.push), Stage.PUSH, "pushing")
        self._require_clear(self._along(lines.up), Stage.PUSH, "rising from the end")
        approach, extra = self._approach()
        down = lines.down if extra is None else joined([extra, lines.down])
        rise, leave = self._leave()
        up = lines.up if rise is None else joined([lines.up, rise])
        parts = {
            Phase.APPROACH: approach,
            Phase.DESCEND: down,
            Phase.PUSH: lines.push,
            Phase.RETREAT: up,
            Phase.CLEAR_VIEW: leave,
        }
        moves = (Segment(phase, name, trajectory=trajectory) for phase, trajectory in parts.items())
        return (Segment(Phase.GRIPPER, name, opening=opening), *moves)

    def _approach(self) -> tuple[Trajectory, Trajectory | None]:
        """Way from the present posture to above the start, and the extra way down if it ends higher."""
        lift = self._lift()
        begin = self._present if lift is None else lift.end
        refusal: SingulationError | None = None
        for vias, rise in product(((), (self._clear_view,)), _EXTRA_RISE):
            try:
                extra = self._rise(self._lines.down.start, rise)
                end = self._lines.down.start if extra is None else extra.end
                moves = self._moves([begin, *vias, end], Stage.TRAVEL, "on the way to the start")
                return joined(moves if lift is None else [lift, *moves]), None if extra is None else backwards(extra)
            except SingulationError as error:
                refusal = refusal or error
        assert refusal is not None
        raise refusal

    def _leave(self) -> tuple[Trajectory | None, Trajectory]:
        """Extra way up from above the end if needed, and the way out of the camera's view."""
        refusal: SingulationError | None = None
        for rise in _EXTRA_RISE:
            try:
                extra = self._rise(self._lines.up.end, rise)
                begin = self._lines.up.end if extra is None else extra.end
                moves = self._moves([begin, self._clear_view], Stage.CLEAR, "on the way out of the view")
                return extra, joined(moves)
            except SingulationError as error:
                refusal = refusal or error
        assert refusal is not None
        raise refusal

    def _lift(self) -> Trajectory | None:
        """Straight up if the tips are low over the table, as after a push that was stopped."""
        tip = chain.tips(self._arm.chain, self._present[None], TIP_OFFSET)[0]
        x, y, height = self._cell.body_from_table[:3, :3].T @ (tip - self._cell.body_from_table[:3, 3])
        x_min, x_max, y_min, y_max = self._cell.workspace
        beside = max(x_min - x, x - x_max, y_min - y, y - y_max)
        lines_height = self._height_above_start()
        if beside > _NEAR_TABLE or height > lines_height - 1e-3:
            return None
        speed = self._parameters.vertical_speed
        lift = straight_line(
            self._arm, self._present, self._up, lines_height - height, speed, self._parameters, None, "rising"
        )
        self._require_clear(self._along(lift), Stage.LEAVE, "rising from where it stands")
        return lift

    def _height_above_start(self) -> float:
        tip = chain.tips(self._arm.chain, self._lines.down.start[None], TIP_OFFSET)[0]
        return float(self._up @ (tip - self._cell.body_from_table[:3, 3]))

    def _rise(self, posture: FloatArray, height: float) -> Trajectory | None:
        if height == 0.0:
            return None
        speed = self._parameters.vertical_speed
        rise = straight_line(self._arm, posture, self._up, height, speed, self._parameters, None, "rising higher")
        self._require_clear(self._along(rise), Stage.TRAVEL, "rising higher")
        return rise

    def _moves(self, postures: list[FloatArray], stage: Stage, where: str) -> list[Trajectory]:
        for start, end in pairwise(postures):
            self._require_clear(self._between(start, end), stage, where)
        return [joint_move(self._arm, a, b, self._parameters) for a, b in pairwise(postures)]

    def _between(self, start: FloatArray, end: FloatArray) -> FloatArray:
        coarse = np.linspace(start, end, _COARSE)
        step = chain.longest_step(self._arm.chain, coarse, TIP_OFFSET)
        return np.linspace(start, end, int(np.ceil(step * (_COARSE - 1) / _STEP)) + 1)

    def _along(self, trajectory: Trajectory) -> FloatArray:
        """Postures of a straight line, close enough together."""
        tips = chain.tips(self._arm.chain, trajectory.positions, TIP_OFFSET)
        gone = np.concatenate(([0.0], np.cumsum(np.sqrt((np.diff(tips, axis=0) ** 2).sum(axis=1)))))
        wanted = np.linspace(0.0, gone[-1], int(np.ceil(gone[-1] / _STEP)) + 1)
        return np.asarray(trajectory.positions[np.unique(np.searchsorted(gone, wanted).clip(max=len(gone) - 1))])

    def _require_clear(self, postures: FloatArray, stage: Stage, where: str) -> None:
        found = self._checker.first_contact(postures, stage)
        if found is not None:
            index, contact = found
            raise SingulationError(
                ResultCode.PATH_BLOCKED,
                f"{self._arm.name} arm {where}, way-point {index + 1} of {len(postures)}: {contact}",
            )
