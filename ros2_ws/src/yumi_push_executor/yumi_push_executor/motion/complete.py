"""From the straight lines of a push to a whole motion: the way there and the way out of the camera's view."""

from itertools import pairwise, product

import numpy as np

from singulation_core import ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from yumi_push_executor.clearance import Stage
from yumi_push_executor.kinematics import CLEAR_VIEW, TIP_OFFSET, chain
from yumi_push_executor.motion.lines import Lines
from yumi_push_executor.motion.parameters import MotionParameters
from yumi_push_executor.motion.timing import backwards, joined
from yumi_push_executor.motion.travel import Travel
from yumi_push_executor.supervision.segment import Phase, Segment
from yumi_push_executor.supervision.trajectory import Trajectory

_RISES = (0.0, 0.05, 0.1)  # [m] above the travel height, tried in turn


def complete(
    lines: Lines, travel: Travel, present: FloatArray, opening: float, parameters: MotionParameters
) -> tuple[Segment, ...]:
    """All segments of a push in order, from the present posture (7,) [rad] to the clear-view posture.

    Raises:
        SingulationError: ``PATH_BLOCKED`` or ``UNREACHABLE`` with the worst offender.
    """
    name = lines.arm.name
    _require_clear_lines(lines, travel)
    for line, where in ((lines.down, "going down"), (lines.push, "pushing"), (lines.up, "rising")):
        _require_straight(lines, line, parameters.straightness, where)
    lift = travel.lift(present, float(travel.tip_in_table(lines.down.start)[2]))
    approach, extra = _approach(lines, travel, present if lift is None else lift.end)
    rise, leave = _leave(lines, travel)
    parts = {
        Phase.APPROACH: approach,
        Phase.DESCEND: lines.down if extra is None else joined([backwards(extra), lines.down]),
        Phase.PUSH: lines.push,
        Phase.RETREAT: lines.up if rise is None else joined([lines.up, rise]),
        Phase.CLEAR_VIEW: leave,
    }
    moves = [Segment(phase, name, trajectory=trajectory) for phase, trajectory in parts.items()]
    # Jaws that stand low may have a block between them: they move only after they have risen.
    first = [] if lift is None else [Segment(Phase.APPROACH, name, trajectory=lift)]
    return (*first, Segment(Phase.GRIPPER, name, opening=opening), *moves)


def leave_view(travel: Travel, name: str, present: FloatArray, height: float) -> Trajectory:
    """Way of an arm from any posture out of the camera's view, rising first to ``height`` [m] if it is low.

    Raises:
        SingulationError: ``PATH_BLOCKED`` or ``UNREACHABLE``.
    """
    refusal: SingulationError | None = None
    for rise in _RISES:
        try:
            lift = travel.lift(present, height + rise)
            start = present if lift is None else lift.end
            move = travel.move(start, CLEAR_VIEW[name], Stage.TRAVEL, "on the way out of the view")
            return move if lift is None else joined([lift, move])
        except SingulationError as error:
            refusal = refusal or error
    assert refusal is not None  # for the type checker: every pass returns or refuses
    raise refusal


def _require_clear_lines(lines: Lines, travel: Travel) -> None:
    """The narrowest places first: most refusals fall there, at the price of a single posture."""
    travel.require_clear(lines.down.end[None], Stage.DESCEND, "at the start of the push")
    travel.require_clear(lines.push.end[None], Stage.PUSH, "at the end of the push")
    travel.require_clear(travel.along(lines.down), Stage.DESCEND, "going down")
    travel.require_clear(travel.along(lines.push), Stage.PUSH, "pushing")
    travel.require_clear(travel.along(lines.up), Stage.PUSH, "rising from the end")


def _require_straight(lines: Lines, line: Trajectory, tolerance: float, where: str) -> None:
    """Between the way-points the controller follows splines; those must be straight too."""
    middles = 0.5 * (line.times[:-1] + line.times[1:])
    tips = chain.tips(lines.arm.chain, line.sample(middles)[0], TIP_OFFSET)
    ends = chain.tips(lines.arm.chain, np.array((line.start, line.end)), TIP_OFFSET)
    direction = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    off = tips - ends[0]
    deviation = np.sqrt(((off - (off @ direction)[:, None] * direction) ** 2).sum(axis=1))
    worst = int(deviation.argmax())
    if not (deviation[worst] <= tolerance):
        raise SingulationError(
            ResultCode.UNREACHABLE,
            f"{lines.arm.name} arm {where}: behind way-point {worst + 1} the tips leave the straight line by "
            f"{deviation[worst] * 1e3:.2f} mm, allowed {tolerance * 1e3:.2f} mm",
        )


def _approach(lines: Lines, travel: Travel, begin: FloatArray) -> tuple[Trajectory, Trajectory | None]:
    """Way from a posture to above the start, and how much higher than the lines it ends (upwards)."""
    above = lines.down.start
    refusal: SingulationError | None = None
    for vias, rise in product(((), (CLEAR_VIEW[lines.arm.name],)), _RISES):
        try:
            extra = travel.rise(above, rise, Stage.TRAVEL, "above the start") if rise else None
            stops = [begin, *vias, above if extra is None else extra.end]
            moves = [travel.move(a, b, Stage.TRAVEL, "on the way to the start") for a, b in pairwise(stops)]
            return joined(moves), extra
        except SingulationError as error:
            refusal = refusal or error
    assert refusal is not None  # for the type checker: every pass returns or refuses
    raise refusal


def _leave(lines: Lines, travel: Travel) -> tuple[Trajectory | None, Trajectory]:
    """How much higher than the lines the arm rises, and the way out of the camera's view from there."""
    above = lines.up.end
    refusal: SingulationError | None = None
    for rise in _RISES:
        try:
            extra = travel.rise(above, rise, Stage.CLEAR, "above the end") if rise else None
            start = above if extra is None else extra.end
            end = CLEAR_VIEW[lines.arm.name]
            return extra, travel.move(start, end, Stage.CLEAR, "on the way out of the view")
        except SingulationError as error:
            refusal = refusal or error
    assert refusal is not None  # for the type checker: every pass returns or refuses
    raise refusal
