"""Look, plan, push, look again, until the blocks are separated. No ROS: the cell is handed in."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from singulation_bringup.policy_choice import DEFAULT_POLICY
from singulation_bringup.singulation_progress import Outcome, Progress, SingulationResult
from singulation_bringup.tracking import Tracked, Tracker
from singulation_core import (
    Arrangement,
    ContactMode,
    Push,
    ResultCode,
    SingulationError,
    singulation_distance,
    smallest_gap,
)
from singulation_core.push_world import simulate_push


class Cell(Protocol):
    """What the loop needs of camera, planner and robot. Each method raises SingulationError with its code."""

    def look(self) -> Arrangement:
        """A view taken after everything asked before has come to rest."""

    def plan(self, seen: Arrangement, policy: str, mode: ContactMode, min_gap: float) -> Push:
        """The push that the policy proposes to bring the blocks ``min_gap`` [m] apart."""

    def execute(self, push: Push) -> None:
        """Perform the push."""

    def check_cancelled(self) -> None:
        """Raise ``CANCELLED`` if the client does not want it any more."""


@dataclass(frozen=True, slots=True)
class SingulationGoal:
    """What is asked.

    Args:
        max_pushes: at most this many pushes.
        min_gap: smallest gap between any two outlines to call them separated [m].
        policy: name of the policy.
        contact_mode: how to touch.
        fallback_policies: asked in this order when a planned push cannot be performed.
    """

    max_pushes: int
    min_gap: float
    policy: str = DEFAULT_POLICY
    contact_mode: ContactMode = ContactMode.SINGLE_POINT
    fallback_policies: Sequence[str] = ()


# What the planner or the executor refuses because of this very push; another push may do.
_TRY_ANOTHER = {
    ResultCode.NO_PUSH,
    ResultCode.UNREACHABLE,
    ResultCode.PATH_BLOCKED,
    ResultCode.PUSH_OUTSIDE_WORKSPACE,
    ResultCode.CONTACT_WIDTH,
    ResultCode.START_TOO_FAR,
}
# The push was begun and stopped, and everything stands; the table may have changed, so a new look decides.
LOOK_AGAIN = {
    ResultCode.COLLISION_STOP,
    ResultCode.NO_PROGRESS,
    ResultCode.PATH_TOLERANCE,
    ResultCode.GOAL_TOLERANCE,
    ResultCode.STATE_LOST,
    ResultCode.TIMEOUT,
    ResultCode.STALE_INPUT,
}
# What the planner cannot work on may be an unlucky look.
_DOUBTFUL_LOOK = {ResultCode.STALE_INPUT, ResultCode.OVERLAPPING_OBJECTS}
_MAX_FAILURES_IN_A_ROW = 2

ProgressCallback = Callable[[Progress], None]


class SingulationLoop:
    """One run of the closed loop.

    Args:
        cell: camera, planner and robot.
        goal: what is asked.
        report: called after every look.
    """

    def __init__(self, cell: Cell, goal: SingulationGoal, report: ProgressCallback = lambda _: None) -> None:
        self._cell = cell
        self._goal = goal
        self._report = report
        self._tracker = Tracker()
        self._unit: float | None = None
        self._progress = Progress()
        self._seen = Arrangement(())
        self._tracked = self._tracker.update(self._seen)

    def run(self) -> SingulationResult:
        """Until separated, out of pushes, nothing helps, cancelled, or a fault that is not got over. Never raises
        ``SingulationError``: its code becomes the result's."""
        try:
            code, message = self._push_until_separated()
        except SingulationError as error:
            code, message = error.code, error.message
        if self._progress.lost:
            message += f"; blocks {sorted(self._progress.lost)} are no longer seen"
        return SingulationResult(code, message, self._progress)

    def _push_until_separated(self) -> tuple[ResultCode, str]:
        self._look()
        failures = 0
        while True:
            gap, pushes = self._progress.gaps[-1], len(self._progress.outcomes)
            if gap >= self._goal.min_gap:
                return self._end(gap, pushes)
            if pushes >= self._goal.max_pushes:
                return ResultCode.MAX_PUSHES_REACHED, (
                    f"smallest gap {1e3 * gap:.1f} mm after {_pushes(pushes)}, need {1e3 * self._goal.min_gap:.1f} mm"
                )
            failure = self._push_and_look()
            failures = 0 if failure is None else failures + 1
            if failure is not None and failures >= _MAX_FAILURES_IN_A_ROW:
                raise SingulationError(
                    ResultCode.PUSH_FAILED, f"{failures} attempts in a row failed, the last: {failure}"
                )

    def _end(self, gap: float, pushes: int) -> tuple[ResultCode, str]:
        """Everything seen is separated; a block that is not seen may hide in another one's outline."""
        code = ResultCode.OBJECT_LOST if self._progress.lost else ResultCode.OK
        return code, _separated(len(self._seen), gap, pushes)

    def _push_and_look(self) -> SingulationError | None:
        """One attempt; what went wrong with it, if a new look may help.

        Raises:
            SingulationError: what a new look does not help against. A push that was begun is on record all the same.
        """
        before = self._tracked
        try:
            push, failure = self._push()
        except SingulationError as error:
            if error.code not in _DOUBTFUL_LOOK:
                raise
            self._progress.forget_last_look()
            self._look()
            return error
        if failure is not None and failure.code is ResultCode.NOT_READY:
            # Refused before anything moved: an executor that has just joined has not heard of this view yet.
            self._progress.forget_last_look()
            self._look()
            return failure
        if failure is not None and failure.code not in LOOK_AGAIN:
            self._record(push, failure, before)
            raise failure
        try:
            self._look(expected=_expected(push, failure, before))
        except SingulationError as blind:
            self._record(push, failure, before, f"nothing was seen after it: {blind.message}")
            raise
        self._record(push, failure, before)
        return failure

    def _look(self, expected: Arrangement | None = None) -> None:
        self._cell.check_cancelled()
        seen = self._cell.look()
        if self._unit is None and len(seen) > 0:
            self._unit = float(seen.bounding_radii.mean())
        tracked = self._tracker.update(seen, expected)
        self._seen, self._tracked = seen, tracked
        lost = self._progress.lost - set(tracked.given_up) | set(tracked.lost)
        self._progress.lost = lost - set(tracked.lasting_ids.values())
        self._progress.distances.append(singulation_distance(seen, self._unit))
        # Two blocks that are seen as one touch.
        self._progress.gaps.append(min(smallest_gap(seen), 0.0 if tracked.covered else math.inf))
        self._progress.counts.append(len(seen))
        self._report(self._progress)

    def _push(self) -> tuple[Push, SingulationError | None]:
        """Perform the first proposed push that is not refused; with it what stopped it, if anything did.

        Raises:
            SingulationError: ``NO_HELPFUL_PUSH`` with every refusal, or why the planner cannot answer at all.
        """
        refusals: list[str] = []
        refused: list[Push] = []
        for policy in dict.fromkeys((self._goal.policy, *self._goal.fallback_policies)):
            self._cell.check_cancelled()
            try:
                push = self._cell.plan(self._seen, policy, self._goal.contact_mode, self._goal.min_gap)
                if any(_same(push, one) for one in refused):
                    refusals.append(f"{policy}: the same push")
                    continue
            except SingulationError as error:
                if error.code not in _TRY_ANOTHER:
                    raise
                refusals.append(f"{policy}: {error}")
                continue
            try:
                self._cell.execute(push)
            except SingulationError as error:
                if error.code not in _TRY_ANOTHER:
                    return push, error
                refusals.append(f"{policy}: {error}")
                refused.append(push)
                continue
            return push, None
        raise SingulationError(ResultCode.NO_HELPFUL_PUSH, "; ".join(refusals))

    def _record(self, push: Push, failure: SingulationError | None, before: Tracked, note: str = "") -> None:
        progress = self._progress
        if self._tracked is before:  # no look followed; there is still one value for every push
            progress.repeat_last_look()
        texts = ["" if failure is None else failure.message, note]
        outcome = Outcome(
            _with_lasting_target(push, before),
            ResultCode.OK if failure is None else failure.code,
            "; ".join(text for text in texts if text),
            before.arrangement,
            self._tracked.arrangement,
            progress.distances[-2],
            progress.distances[-1],
        )
        progress.outcomes.append(outcome)
        self._report(progress)


def _same(push: Push, other: Push) -> bool:
    """Whether two pushes are one for the robot: ends within a tenth of a millimetre."""
    return bool(np.allclose((push.start, push.end), (other.start, other.end), rtol=0.0, atol=1e-4))


def _expected(push: Push, failure: SingulationError | None, before: Tracked) -> Arrangement | None:
    """Where a push that was not stopped should have left the blocks; None if that cannot be said."""
    if failure is not None:
        return None
    try:
        return simulate_push(before.arrangement, push)
    except SingulationError:
        return None


def _with_lasting_target(push: Push, tracked: Tracked) -> Push:
    target = None if push.target_id is None else tracked.lasting_ids.get(push.target_id)
    return Push(push.start, push.end, push.contact_mode, push.contact_width, target, push.policy, push.expected_gain)


def _separated(count: int, gap: float, pushes: int) -> str:
    if count == 0:
        return "nothing to do: no objects on the table"
    if count == 1:
        return "nothing to do: one object"
    gap_text = "apart" if math.isinf(gap) else f"smallest gap {1e3 * gap:.1f} mm"
    return f"{count} objects separated, {gap_text}, after {_pushes(pushes)}"


def _pushes(count: int) -> str:
    return f"{count} push" if count == 1 else f"{count} pushes"
