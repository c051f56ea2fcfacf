"""The stream of joint states: which samples are good, and when it is lost."""

import numpy as np
import pytest
from fake_robot import HOME, RANGES

from singulation_core import ResultCode
from yumi_push_executor.supervision import Instant, Sample, StateWatch, SupervisionLimits

LIMITS = SupervisionLimits()


@pytest.fixture
def watch():
    return StateWatch(LIMITS, RANGES)


def sample(taken, arrived=None, shift=0.0, velocities=None):
    positions = {arm: HOME[arm] + shift for arm in HOME}
    return Sample(
        taken, taken if arrived is None else arrived, positions, velocities or {}, {"left": 0.0, "right": 0.0}
    )


def feed(watch, times, **changes):
    return [watch.add(sample(time, **changes), Instant(time, time)) for time in times]


def test_good_samples_are_kept_for_half_a_second(watch):
    assert all(feed(watch, np.arange(10.0, 12.0, 0.01)))
    assert watch.latest.taken == pytest.approx(11.99)
    assert watch.before(11.5).taken == pytest.approx(11.5, abs=0.011)
    assert watch.before(11.4) is None
    assert watch.refused == 0


def test_samples_out_of_order_are_refused_and_counted(watch):
    feed(watch, [10.0, 10.1])
    assert feed(watch, [10.05, 10.1]) == [False, False]
    assert (watch.latest.taken, watch.refused) == (10.1, 2)
    assert feed(watch, [10.2]) == [True]


@pytest.mark.parametrize("delay", [LIMITS.state_delay + 0.1, -LIMITS.state_delay - 0.1])
def test_samples_stamped_long_ago_or_in_the_future_are_not_taken(watch, delay):
    assert not watch.add(sample(20.0), Instant(20.0 + delay, 20.0 + delay))
    fault = watch.fault(Instant(20.0, 20.0))
    assert fault.code is ResultCode.NOT_READY
    assert ("before" if delay > 0.0 else "after") in fault.text
    assert watch.add(sample(21.0), Instant(21.0, 21.0))
    assert watch.fault(Instant(21.0, 21.0)) is None


def test_a_new_clock_starts_a_new_stream(watch):
    feed(watch, [1000.0, 1000.1])
    assert feed(watch, [5.0]) == [True]
    assert watch.before(2000.0).taken == 5.0


def test_both_clocks_must_say_that_a_state_is_old(watch):
    feed(watch, [10.0])
    assert watch.fault(Instant(10.0 + 2.0, 10.1)) is None  # a fast simulation
    assert watch.fault(Instant(10.1, 10.0 + 2.0)) is None  # a slow one
    assert watch.fault(Instant(12.0, 12.0)).code is ResultCode.STATE_LOST
    assert watch.fault(Instant(10.1, 10.0 + LIMITS.wall_silence + 0.1)).code is ResultCode.STATE_LOST
    assert watch.fault(Instant(float("nan"), 12.0)).code is ResultCode.STATE_LOST


def test_speed_is_reported_or_measured(watch):
    for time in np.arange(10.0, 10.2, 0.01):
        watch.add(sample(time, shift=0.5 * (time - 10.0)), Instant(time, time))
    np.testing.assert_allclose(watch.speed("left"), 0.5, atol=1e-9)
    watch.add(sample(10.3, velocities={"left": np.full(7, 0.2)}), Instant(10.3, 10.3))
    np.testing.assert_array_equal(watch.speed("left"), 0.2)


def test_speed_is_unknown_before_two_samples(watch):
    assert np.isnan(watch.speed("left")).all()
    feed(watch, [10.0])
    assert np.isnan(watch.speed("left")).all()


def test_a_sample_that_cannot_be_real_is_forgotten_by_the_next_good_one(watch):
    feed(watch, [10.0])
    bad = sample(10.1)
    bad.positions["right"][3] = np.nan
    assert not watch.add(bad, Instant(10.1, 10.1))
    assert "right joint 4 is nan" in watch.fault(Instant(10.1, 10.1)).text
    feed(watch, [10.2])
    assert watch.fault(Instant(10.2, 10.2)) is None
