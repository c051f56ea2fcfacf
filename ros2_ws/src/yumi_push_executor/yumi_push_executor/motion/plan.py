"""From a push to a checked motion of one arm, or an error that says what is in the way."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from singulation_core import Arrangement, CellGeometry, Push, PusherGeometry, ResultCode, SingulationError
from singulation_core.polygon import contains, convex_hull, inward_half_planes, separation
from yumi_push_executor.clearance import Checker, build_scene
from yumi_push_executor.kinematics import BRANCHES, CLEAR_VIEW, YumiArm
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.motion.candidates import ranked
from yumi_push_executor.motion.complete import complete, leave_view
from yumi_push_executor.motion.jaws import headings, opening
from yumi_push_executor.motion.lines import Lines, solve_lines
from yumi_push_executor.motion.motion import Motion
from yumi_push_executor.motion.parameters import MotionParameters
from yumi_push_executor.motion.travel import Travel
from yumi_push_executor.supervision.trajectory import Trajectory

_NO_BLOCKS = Arrangement(())
_MOST_TRIED = 24  # candidates that are checked in full; more would break the time budget


def plan_motion(
    push: Push,
    arrangement: Arrangement | None = None,
    *,
    cell: CellGeometry | None = None,
    joints: Mapping[str, ArrayLike] | None = None,
    pusher: PusherGeometry | None = None,
    parameters: MotionParameters | None = None,
    arms: Sequence[str] = ARMS,
) -> Motion:
    """Motion of the arm that does the push best, checked for reach, limits and clearance.

    Args:
        push: in ``table``.
        arrangement: blocks to keep clear of, in ``table``; those the jaws sweep over are pushed.
        cell: where table, workspace and camera are.
        joints: present (7,) angles of both arms [rad]; the clear-view postures if None.
        pusher: jaws; the YuMi's if None.
        parameters: speeds, heights, margins.
        arms: that may be used.

    Returns:
        The motion, from the present posture to the clear-view posture of the same arm.

    Raises:
        SingulationError: ``PUSH_OUTSIDE_WORKSPACE``, ``CONTACT_WIDTH``, ``UNREACHABLE`` or ``PATH_BLOCKED``, with the
            worst offender of the most promising candidate.
        InvalidInputError: joint angles that are none.
    """
    cell, pusher = cell or CellGeometry(), pusher or PusherGeometry()
    parameters, arrangement = parameters or MotionParameters(), arrangement or _NO_BLOCKS
    _require_inside(push, cell)
    width = opening(push, pusher)
    postures = {name: YumiArm(name).checked((joints or CLEAR_VIEW)[name]) for name in ARMS}
    solved, refusals = _solve_all(push, cell, _travel_height(arrangement, parameters), parameters, arms)
    candidates = ranked(solved, headings(push), postures, parameters)
    touched = swept_blocks(push, arrangement, pusher)
    travels: dict[str, Travel] = {}
    for tried, candidate in enumerate(candidates[:_MOST_TRIED], start=1):
        lines = candidate.lines.turned(candidate.turn)
        name = lines.arm.name
        if name not in travels:
            scene = build_scene(name, cell, arrangement, touched, push.end - push.start, parameters.unknown_height)
            checker = Checker(scene, postures, width, parameters.margins)
            travels[name] = Travel(lines.arm, checker, cell, parameters)
        try:
            segments = complete(lines, travels[name], postures[name], width, parameters)
        except SingulationError as refusal:
            refusals.append(refusal)
            continue
        margin = lines.room()[0]
        return Motion(push, name, segments, width, lines.heading, lines.branch, margin, (len(candidates), tried))
    raise _most_telling(refusals, len(candidates))


def plan_clear_view(
    arm: str,
    arrangement: Arrangement | None = None,
    *,
    cell: CellGeometry | None = None,
    joints: Mapping[str, ArrayLike] | None = None,
    opening: float = 0.0,
    parameters: MotionParameters | None = None,
) -> Trajectory:
    """Way of one arm from wherever it stands, as after a push that was stopped, to its clear-view posture.

    Args:
        arm: ``left`` or ``right``.
        arrangement: blocks to keep clear of, in ``table``.
        cell: where the table is.
        joints: present (7,) angles of both arms [rad]; the clear-view postures if None.
        opening: present distance between the jaws [m].
        parameters: speeds, heights, margins.

    Raises:
        SingulationError: ``UNREACHABLE`` or ``PATH_BLOCKED`` with what is in the way.
    """
    cell, parameters, arrangement = cell or CellGeometry(), parameters or MotionParameters(), arrangement or _NO_BLOCKS
    postures = {name: YumiArm(name).checked((joints or CLEAR_VIEW)[name]) for name in ARMS}
    scene = build_scene(arm, cell, arrangement, (), np.zeros(2), parameters.unknown_height)
    checker = Checker(scene, postures, opening, parameters.margins)
    travel = Travel(YumiArm(arm), checker, cell, parameters)
    return leave_view(travel, arm, postures[arm], _travel_height(arrangement, parameters))


def swept_blocks(push: Push, arrangement: Arrangement, pusher: PusherGeometry) -> frozenset[int]:
    """Ids of the blocks that the jaws sweep over on their way from start to end."""
    reach = float(np.hypot(pusher.edge_width, pusher.edge_thickness)) / 2.0
    across = np.array((-push.direction[1], push.direction[0])) * (reach + 0.5 * push.contact_width)
    along = push.direction * reach
    corners = [push.start - along, push.end + along]
    swept = convex_hull([corner + side for corner in corners for side in (across, -across)])
    return frozenset(item.id for item in arrangement.objects if separation(swept, item.outline) <= 0.0)


def _require_inside(push: Push, cell: CellGeometry) -> None:
    """Both ends in the workspace, which is convex."""
    ends = np.array((push.start, push.end))
    if contains(cell.workspace_polygon, ends, margin=-1e-6).all():
        return
    normals, offsets = inward_half_planes(cell.workspace_polygon)
    outside = (offsets - ends @ normals.T).max(axis=1)
    worst = int(outside.argmax())
    raise SingulationError(
        ResultCode.PUSH_OUTSIDE_WORKSPACE,
        f"the {('start', 'end')[worst]} of the push, ({ends[worst][0]:.3f}, {ends[worst][1]:.3f}) m in table, lies "
        f"{outside[worst] * 1e3:.1f} mm outside the workspace {cell.workspace}",
    )


def _travel_height(arrangement: Arrangement, parameters: MotionParameters) -> float:
    """Height of the tips above the table at which they pass over every block [m]."""
    tallest = max((item.height or parameters.unknown_height for item in arrangement.objects), default=0.0)
    return max(parameters.travel_height, tallest + parameters.travel_clearance)


def _solve_all(
    push: Push, cell: CellGeometry, height: float, parameters: MotionParameters, arms: Sequence[str]
) -> tuple[list[Lines], list[SingulationError]]:
    solved: list[Lines] = []
    refusals: list[SingulationError] = []
    for name in arms:
        for branch in range(len(BRANCHES)):
            try:
                solved.append(solve_lines(YumiArm(name), branch, push, cell.body_from_table, height, parameters))
            except SingulationError as refusal:
                refusals.append(refusal)
    return solved, refusals


def _most_telling(refusals: list[SingulationError], candidates: int) -> SingulationError:
    """Of all refusals the one that says most: what blocked the best candidate, else the first that was out of reach."""
    blocked = [one for one in refusals if one.code is ResultCode.PATH_BLOCKED]
    if blocked:
        return SingulationError(
            ResultCode.PATH_BLOCKED, f"{blocked[0].message}; {len(blocked)} of {candidates} candidates tried, none free"
        )
    if refusals:
        return SingulationError(ResultCode.UNREACHABLE, f"{refusals[0].message}; no branch of any arm allowed does it")
    return SingulationError(ResultCode.UNREACHABLE, "the jaws cannot be turned as the push needs within the limits")
