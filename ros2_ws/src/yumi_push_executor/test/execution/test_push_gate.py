"""Which pushes are fresh."""

import pytest

from singulation_core import Arrangement, PlanarObject, ResultCode, SingulationError
from yumi_push_executor.push_gate import PushGate

NOW = 1000.0


def view(stamp):
    square = ((0.0, 0.0), (0.02, 0.0), (0.02, 0.02), (0.0, 0.02))
    return Arrangement((PlanarObject(int(stamp[0]), square),), stamp=stamp[0] + 1e-9 * stamp[1])


@pytest.fixture
def gate():
    gate = PushGate(max_age=30.0, max_skew=0.5, need_objects=True)
    for second in range(980, 1000):
        gate.add((second, 7), view((second, 7)))
    return gate


def refused(gate, stamp, now=NOW):
    with pytest.raises(SingulationError) as caught:
        gate.require_fresh(stamp, now)
    return caught.value


def test_the_arrangement_of_the_same_stamp_is_kept_clear_of(gate):
    assert gate.require_fresh((985, 7), NOW).objects[0].id == 985


def test_an_unknown_stamp_that_is_fresh_takes_the_newest_arrangement(gate):
    assert gate.require_fresh((990, 0), NOW).objects[0].id == 999


@pytest.mark.parametrize(
    ("stamp", "text"),
    [((0, 0), "no stamp"), ((969, 0), "31.0 s old"), ((1001, 0), "1.00 s in the future")],
)
def test_stamps_without_meaning_or_too_far_away_are_stale(gate, stamp, text):
    error = refused(gate, stamp)
    assert error.code is ResultCode.STALE_INPUT
    assert text in error.message
    assert gate.require_fresh((999, 7), NOW)


def test_a_view_taken_before_the_last_motion_ended_is_stale(gate):
    gate.moved(998.5)
    error = refused(gate, (998, 7))
    assert error.code is ResultCode.STALE_INPUT
    assert "before the last motion ended; look again" in error.message
    assert gate.require_fresh((999, 7), NOW)


def test_without_any_arrangement_nothing_is_pushed_unless_that_is_wanted():
    assert refused(PushGate(30.0, 0.5, need_objects=True), (999, 0)).code is ResultCode.NOT_READY
    assert len(PushGate(30.0, 0.5, need_objects=False).require_fresh((999, 0), NOW)) == 0


def test_old_arrangements_are_forgotten(gate):
    for nanoseconds in range(100):
        gate.add((999, 100 + nanoseconds), view((999, 100 + nanoseconds)))
    assert gate.require_fresh((985, 7), NOW).stamp == pytest.approx(999.0, abs=1e-6)
