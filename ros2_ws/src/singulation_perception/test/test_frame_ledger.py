import threading

import pytest
from hypothesis import given
from hypothesis import strategies as st

from singulation_core import ResultCode
from singulation_perception.frame_ledger import FrameLedger

OUTCOMES = ("published", "superseded", ResultCode.NO_POINTS, ResultCode.STALE_INPUT)


def enter(ledger, outcome):
    if outcome == "published":
        ledger.published(0.1, {"table": 1.0})
    elif outcome == "superseded":
        ledger.superseded()
    else:
        ledger.rejected(outcome, "a reason")


@given(outcomes=st.lists(st.sampled_from(OUTCOMES), max_size=50), waiting=st.integers(0, 2))
def test_every_cloud_is_accounted_for(outcomes, waiting):
    ledger = FrameLedger()
    for number in range(len(outcomes) + waiting):
        ledger.received(float(number))
    for outcome in outcomes:
        enter(ledger, outcome)
    state = ledger.state(100.0)
    assert state.received == state.published + state.superseded + sum(state.rejected.values()) + state.pending
    assert state.pending == waiting
    assert state.published == outcomes.count("published")
    assert state.rejected.get("NO_POINTS", 0) == outcomes.count(ResultCode.NO_POINTS)


def test_the_newest_outcome_decides_about_health():
    ledger = FrameLedger()
    assert ledger.state(0.0).healthy
    ledger.rejected(ResultCode.NO_TABLE, "no plane")
    state = ledger.state(0.0)
    assert not state.healthy
    assert state.last_error == "NO_TABLE (103): no plane"
    ledger.superseded()
    assert not ledger.state(0.0).healthy
    ledger.published(0.2, {})
    assert ledger.state(0.0).healthy


def test_rate_quiet_time_age_and_median_stages():
    ledger = FrameLedger()
    fresh = ledger.state(5.0)
    assert fresh.rate == 0.0
    assert fresh.quiet == float("inf")
    for number in range(11):
        ledger.received(10.0 + 0.25 * number)
    for milliseconds in (1.0, 9.0, 2.0):
        ledger.published(0.3, {"table": milliseconds})
    ledger.published(0.4, {"table": 3.0, "extra": 7.0})
    state = ledger.state(14.5)
    assert state.rate == pytest.approx(4.0)
    assert state.quiet == pytest.approx(2.0)
    assert state.age == 0.4
    assert state.stages == {"table": 2.5, "extra": 7.0}


def test_counting_from_many_threads_loses_nothing():
    ledger = FrameLedger()

    def count():
        for _ in range(500):
            ledger.received(1.0)
            ledger.superseded()

    threads = [threading.Thread(target=count) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(timeout=30)
    state = ledger.state(1.0)
    assert (state.received, state.superseded, state.pending) == (2000, 2000, 0)


def test_clouds_that_never_came_are_counted_apart():
    ledger = FrameLedger()
    assert ledger.state(3.0).since_loss == float("inf")
    ledger.lost(2, 1.0)
    ledger.lost(5, 2.0)
    state = ledger.state(3.0)
    assert (state.received, state.lost, state.since_loss) == (0, 5, 1.0)
