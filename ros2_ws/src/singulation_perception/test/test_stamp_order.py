import pytest
from hypothesis import given
from hypothesis import strategies as st

from singulation_core import ResultCode, SingulationError
from singulation_perception.stamp_order import StampOrder

SECOND = 10**9
NOW = 1_700_000_000 * SECOND


def accepts(order, stamp, now=NOW, max_future=1.0, max_age=None):
    """Whether a stamp is taken; a refusal must be coded."""
    try:
        order.check(stamp, now, max_future, max_age)
    except SingulationError as error:
        assert error.code == ResultCode.STALE_INPUT
        return False
    return True


def test_clouds_of_any_age_are_taken_in_order():
    order = StampOrder()
    assert all(accepts(order, stamp) for stamp in (1, 2, SECOND, NOW - 1, NOW))


@pytest.mark.parametrize(
    ("stamp", "text"),
    [
        (0, "is zero"),
        (-5, "is zero"),
        (NOW + 2 * SECOND, "2.000 s in the future, at most 1.000"),
        (2**31 * SECOND, "in the future"),
        (NOW - 10 * SECOND, "equals that of the cloud before"),
        (NOW - 13 * SECOND, "is 3.000 s before the cloud before"),
    ],
)
def test_what_cannot_be_true_is_refused_once(stamp, text):
    order = StampOrder()
    assert accepts(order, NOW - 10 * SECOND)
    with pytest.raises(SingulationError, match=text):
        order.check(stamp, NOW, 1.0, None)
    assert accepts(order, NOW - 9 * SECOND)


def test_a_clock_ahead_within_the_limit_is_accepted():
    assert accepts(StampOrder(), NOW + SECOND)
    assert not accepts(StampOrder(), NOW + SECOND + 1)


def test_a_recording_that_starts_again_costs_one_cloud():
    order = StampOrder()
    loops = [[accepts(order, stamp) for stamp in (10, 20, 30)] for _ in range(3)]
    assert loops == [[True, True, True], [False, True, True], [False, True, True]]


def test_a_stamp_from_the_future_does_not_block_what_follows():
    order = StampOrder()
    assert accepts(order, NOW - SECOND)
    assert not accepts(order, NOW + 3600 * SECOND)
    assert accepts(order, NOW)


def test_age_is_judged_only_on_request():
    assert accepts(StampOrder(), NOW - 3 * SECOND)
    assert not accepts(StampOrder(), NOW - 3 * SECOND, max_age=2.0)
    assert accepts(StampOrder(), NOW - 2 * SECOND, max_age=2.0)


def test_without_a_clock_the_node_is_not_ready_and_then_it_is():
    order = StampOrder()
    with pytest.raises(SingulationError, match="/clock") as caught:
        order.check(SECOND, 0, 1.0, None)
    assert caught.value.code == ResultCode.NOT_READY
    assert accepts(order, SECOND, now=2 * SECOND)


@given(stamps=st.lists(st.integers(-5, 50), max_size=30))
def test_whatever_is_accepted_is_newer_than_the_cloud_before_it(stamps):
    order = StampOrder()
    before = None
    for stamp in stamps:
        if accepts(order, stamp, now=20, max_future=0.0):
            assert 0 < stamp <= 20
            assert before is None or stamp > before
        if 0 < stamp <= 20:
            before = stamp
