"""From a push to a checked motion of one arm, or an error that says what is in the way."""

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from singulation_core import (
    Arrangement,
    CellGeometry,
    InvalidInputError,
    Push,
    PusherGeometry,
    ResultCode,
    SingulationError,
)
from singulation_core.polygon import FloatArray
from yumi_push_executor.clearance import Checker, build_scene
from yumi_push_executor.kinematics import BRANCHES, CLEAR_VIEW, YumiArm
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.motion.candidates import Candidate, ranked
from yumi_push_executor.motion.complete import complete, leave_view
from yumi_push_executor.motion.jaws import headings, middle_line, opening
from yumi_push_executor.motion.lines import Lines, solve_lines
from yumi_push_executor.motion.motion import Motion
from yumi_push_executor.motion.parameters import MotionParameters
from yumi_push_executor.motion.table import require_inside, swept_blocks, travel_height
from yumi_push_executor.motion.travel import Travel
from yumi_push_executor.supervision.trajectory import Trajectory

_NO_BLOCKS = Arrangement(())
# Limits of the search, which keep the planning of a push that cannot be done within its time.
_MOST_TRIED = 24  # candidates
_MOST_CHECKED = 1200  # postures


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
        cell: where table and workspace are.
        joints: present (7,) angles of both arms [rad]; the clear-view postures if None.
        pusher: jaws; the YuMi's if None.
        parameters: speeds, heights, margins.
        arms: that may be used.

    Returns:
        The motion, from the present posture to the clear-view posture of the same arm.

    Raises:
        SingulationError: ``PUSH_OUTSIDE_WORKSPACE``, ``CONTACT_WIDTH``, ``UNREACHABLE`` or ``PATH_BLOCKED``, with the
            worst offender of the most promising candidate.
        InvalidInputError: joint angles that are none, or no arm.
    """
    cell, pusher = cell or CellGeometry(), pusher or PusherGeometry()
    parameters, arrangement = parameters or MotionParameters(), arrangement or _NO_BLOCKS
    require_inside(push, cell)
    width, postures = opening(push, pusher), _postures(joints)
    line = middle_line(push, pusher)
    solved, refusals = _solve_all(line, cell, travel_height(arrangement, parameters), parameters, arms)
    candidates = ranked(solved, headings(push), postures, parameters)
    shift, touched = push.end - push.start, swept_blocks(push, arrangement, pusher)

    @cache  # an arm that no tried candidate needs costs nothing
    def travel(arm: str) -> Travel:
        scene = build_scene(arm, cell, arrangement, touched, shift, parameters.unknown_height)
        return Travel(YumiArm(arm), Checker(scene, postures, width, parameters.margins), cell, parameters)

    motion = _first_free(push, candidates, travel, postures, width, parameters, refusals)
    if motion is None:
        raise _most_telling(refusals, len(candidates))
    return motion


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
    model, postures = YumiArm(arm), _postures(joints)
    scene = build_scene(arm, cell, arrangement, (), np.zeros(2), parameters.unknown_height)
    travel = Travel(model, Checker(scene, postures, opening, parameters.margins), cell, parameters)
    return leave_view(travel, arm, postures[arm], travel_height(arrangement, parameters))


def _postures(joints: Mapping[str, ArrayLike] | None) -> dict[str, FloatArray]:
    joints = CLEAR_VIEW if joints is None else joints
    missing = [name for name in ARMS if name not in joints]
    if missing:
        raise InvalidInputError(f"joints: none given for the {' and '.join(missing)} arm, need both")
    return {name: YumiArm(name).checked(joints[name]) for name in ARMS}


def _solve_all(
    push: Push, cell: CellGeometry, height: float, parameters: MotionParameters, arms: Sequence[str]
) -> tuple[list[Lines], list[SingulationError]]:
    """Straight lines of every arm on every branch, and why some have none."""
    if not arms:
        raise InvalidInputError("arms: none allowed, need at least one")
    solved: list[Lines] = []
    refusals: list[SingulationError] = []
    for arm, branch in product([YumiArm(name) for name in arms], range(len(BRANCHES))):
        try:
            solved.append(solve_lines(arm, branch, push, cell.body_from_table, height, parameters))
        except SingulationError as refusal:
            refusals.append(refusal)
    return solved, refusals


def _first_free(
    push: Push,
    candidates: list[Candidate],
    travel: Callable[[str], Travel],
    postures: Mapping[str, FloatArray],
    width: float,
    parameters: MotionParameters,
    refusals: list[SingulationError],
) -> Motion | None:
    """The first candidate that is clear all the way; the others' refusals are appended."""
    used: dict[str, Travel] = {}
    for tried, candidate in enumerate(candidates[:_MOST_TRIED], start=1):
        if sum(one.checked for one in used.values()) > _MOST_CHECKED:
            break
        lines = candidate.lines.turned(candidate.turn)
        name = lines.arm.name
        used[name] = travel(name)
        try:
            segments = complete(lines, used[name], postures[name], width, parameters)
        except SingulationError as refusal:
            refusals.append(refusal)
            continue
        room, count = lines.room()[0], (len(candidates), tried)
        return Motion(push, name, segments, width, lines.heading, lines.branch, room, count)
    return None


def _most_telling(refusals: list[SingulationError], candidates: int) -> SingulationError:
    """Of all refusals the one that says most: what blocked the best candidate, else the first that was out of reach."""
    blocked = [one for one in refusals if one.code is ResultCode.PATH_BLOCKED]
    if blocked:
        text = f"{blocked[0].message}; {len(blocked)} of {candidates} candidates tried, none free"
        return SingulationError(ResultCode.PATH_BLOCKED, text)
    if refusals:
        return SingulationError(ResultCode.UNREACHABLE, f"{refusals[0].message}; no branch of any arm allowed does it")
    return SingulationError(ResultCode.UNREACHABLE, "the jaws cannot be turned as the push needs within the limits")
