"""The loop against a cell in memory: each fault once, and every push accounted for."""

import numpy as np
import pytest

from singulation_bringup.policy_choice import DEFAULT_POLICY
from singulation_bringup.singulation_loop import SingulationGoal, SingulationLoop
from singulation_core import Arrangement, ContactMode, PlanarObject, Push, ResultCode, SingulationError

SQUARE = np.array(((0.0, 0.0), (0.04, 0.0), (0.04, 0.04), (0.0, 0.04)))


def row(gap, count=2):
    return Arrangement([PlanarObject(i, SQUARE + (i * (0.04 + gap), 0.0)) for i in range(count)])


class ScriptedCell:
    """Every push widens the gap by 10 mm, unless a fault is scripted for it."""

    def __init__(self, count=2, faults=(), plan_faults=(), cancel_after=None):
        self.gap, self.count = 0.001, count
        self.faults, self.plan_faults = list(faults), list(plan_faults)
        self.cancel_after, self.asked, self.differ = cancel_after, [], True

    def look(self):
        return row(self.gap, self.count)

    def plan(self, seen, policy, mode, min_gap):
        self.asked.append(policy)
        self._stumble(self.plan_faults)
        across = 0.001 * (policy != DEFAULT_POLICY) * self.differ
        return Push((-0.02, 0.02 + across), (0.02, 0.02 + across), mode, 0.0, target_id=0, policy=policy)

    def execute(self, push):
        self._stumble(self.faults)
        self.gap += 0.01

    def check_cancelled(self):
        if self.cancel_after is not None and len(self.asked) >= self.cancel_after:
            raise SingulationError(ResultCode.CANCELLED, "cancelled by the client")

    @staticmethod
    def _stumble(faults):
        fault = faults.pop(0) if faults else None
        if fault is not None:
            raise SingulationError(fault, "scripted")


def run(cell, **options):
    goal = SingulationGoal(**{"max_pushes": 10, "min_gap": 0.03, "fallback_policies": ("second",), **options})
    reports = []
    result = SingulationLoop(cell, goal, lambda progress: reports.append(len(progress.outcomes))).run()
    assert len(result.progress.distances) == len(result.progress.gaps) == len(result.progress.outcomes) + 1
    return result, reports


def test_it_pushes_until_separated():
    result, reports = run(ScriptedCell())
    assert result.code is ResultCode.OK
    assert len(result.progress.outcomes) == 3
    assert np.all(np.diff(result.progress.distances) > 0)
    assert result.progress.gaps[-1] == pytest.approx(0.031)
    assert reports[-1] == 3
    for before, after in zip(result.progress.outcomes, result.progress.outcomes[1:], strict=False):
        assert before.distance_after == after.distance_before


@pytest.mark.parametrize("count", [0, 1])
def test_nothing_to_do_is_no_failure(count):
    result, _ = run(ScriptedCell(count=count))
    assert result.code is ResultCode.OK
    assert "nothing to do" in result.message
    assert result.progress.outcomes == []


def test_the_number_of_pushes_is_kept():
    result, _ = run(ScriptedCell(), max_pushes=2)
    assert result.code is ResultCode.MAX_PUSHES_REACHED
    assert len(result.progress.outcomes) == 2
    assert "need 30.0 mm" in result.message


@pytest.mark.parametrize("code", [ResultCode.UNREACHABLE, ResultCode.PATH_BLOCKED])
def test_a_refused_motion_asks_the_next_policy(code):
    cell = ScriptedCell(faults=[code])
    result, _ = run(cell)
    assert result.code is ResultCode.OK
    assert cell.asked[:2] == [DEFAULT_POLICY, "second"]
    assert result.progress.outcomes[0].push.policy == "second"


def test_all_refused_is_no_helpful_push_with_every_reason():
    result, _ = run(ScriptedCell(plan_faults=[ResultCode.NO_PUSH, None], faults=[ResultCode.UNREACHABLE]))
    assert result.code is ResultCode.NO_HELPFUL_PUSH
    assert "NO_PUSH" in result.message
    assert "UNREACHABLE" in result.message


def test_a_refused_push_is_not_tried_again_under_another_name():
    cell = ScriptedCell(faults=[ResultCode.PATH_BLOCKED])
    cell.differ = False
    result, _ = run(cell)
    assert result.code is ResultCode.NO_HELPFUL_PUSH
    assert cell.asked == [DEFAULT_POLICY, "second"]
    assert "second: the same push" in result.message


def test_a_stopped_push_is_an_outcome_and_the_next_look_decides():
    result, _ = run(ScriptedCell(faults=[ResultCode.COLLISION_STOP]))
    assert result.code is ResultCode.OK
    assert [outcome.code for outcome in result.progress.outcomes] == [ResultCode.COLLISION_STOP] + [ResultCode.OK] * 3


def test_failing_again_and_again_ends_it():
    result, _ = run(ScriptedCell(faults=[ResultCode.COLLISION_STOP] * 2))
    assert result.code is ResultCode.PUSH_FAILED
    assert len(result.progress.outcomes) == 2


@pytest.mark.parametrize("code", [ResultCode.SAFETY_STOP, ResultCode.CANCELLED, ResultCode.GRIPPER_NOT_CALIBRATED])
def test_what_needs_a_person_ends_it_with_its_code_and_its_push_on_record(code):
    result, _ = run(ScriptedCell(faults=[None, code]))
    assert result.code is code
    assert [outcome.code for outcome in result.progress.outcomes] == [ResultCode.OK, code]


def test_an_unknown_policy_ends_it_with_the_planners_words():
    result, _ = run(ScriptedCell(plan_faults=[ResultCode.UNKNOWN_POLICY]))
    assert result.code is ResultCode.UNKNOWN_POLICY
    assert result.progress.outcomes == []


def test_cancelling_keeps_what_was_done():
    result, _ = run(ScriptedCell(cancel_after=2), contact_mode=ContactMode.SINGLE_POINT)
    assert result.code is ResultCode.CANCELLED
    assert len(result.progress.outcomes) == 2  # the second was done when the wish came; nothing is seen after it
    assert "cancelled" in result.progress.outcomes[1].message


def test_a_block_that_vanishes_is_named():
    cell = ScriptedCell(count=3)
    looks = iter([row(0.001, 3), row(0.05, 2)])
    cell.look = lambda: next(looks)
    result, _ = run(cell)
    assert result.code is ResultCode.OBJECT_LOST
    assert "blocks [1] are no longer seen" in result.message


def test_a_block_that_is_seen_again_is_not_lost():
    cell = ScriptedCell(count=3)
    looks = iter([row(0.001, 3), row(0.002, 2), row(0.05, 3)])
    cell.look = lambda: next(looks)
    result, _ = run(cell)
    assert result.code is ResultCode.OK
    assert "no longer" not in result.message


def test_an_executor_that_has_just_joined_gets_another_view():
    result, _ = run(ScriptedCell(faults=[ResultCode.NOT_READY]))
    assert result.code is ResultCode.OK
    assert [outcome.code for outcome in result.progress.outcomes] == [ResultCode.OK] * 3


def test_an_executor_that_never_gets_ready_ends_it():
    result, _ = run(ScriptedCell(faults=[ResultCode.NOT_READY] * 5))
    assert result.code is ResultCode.PUSH_FAILED
    assert result.progress.outcomes == []
