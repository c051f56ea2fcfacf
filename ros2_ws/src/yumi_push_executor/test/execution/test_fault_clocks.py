"""Pauses and jumps of time while a motion runs."""

import pytest
from fake_robot import push_segments
from rig import Rig

from singulation_core import ResultCode
from yumi_push_executor.supervision import Phase, SupervisionLimits


def pause(seconds):
    def happen(rig, supervisor):
        rig.skip_steps = True
        until = rig.now + seconds
        inner = rig.corrupt

        def count(sample):
            if rig.now >= until:
                rig.skip_steps, rig.corrupt = False, inner
            return inner(sample)

        rig.corrupt = count

    return happen


def test_a_supervision_that_slept_too_long_stops_the_motion(rig):
    outcome = rig.run(push_segments(), events=[(Phase.PUSH, 0.1, pause(0.6))])
    assert outcome.code is ResultCode.TIMEOUT
    assert "did not run" in outcome.text
    rig.require_good_push()


def test_a_short_hiccup_is_no_fault(rig):
    """Shorter than blind_time, longer than state_age: the states that waited are read before they are called old."""
    outcome = rig.run(events=[(Phase.PUSH, 0.1, pause(0.4))])
    assert outcome.code is ResultCode.OK


@pytest.mark.parametrize("jump", [-3600.0, -2.0, 3600.0])
def test_a_clock_that_jumps_stops_the_motion(rig, jump):
    outcome = rig.run(events=[(Phase.PUSH, 0.1, lambda rig, _: setattr(rig, "now", rig.now + jump))], until=1e9)
    assert outcome.code is ResultCode.TIMEOUT
    assert f"jumped by {jump:.1f}"[:14] in outcome.text
    rig.require_good_push()


def test_a_paused_clock_is_noticed_on_the_steady_clock():
    rig = Rig(SupervisionLimits(wall_silence=2.0))
    supervisor = rig.supervisor()
    rig.obey(supervisor.start(rig.driver, rig.instant()))
    for _ in range(50):
        rig.obey(supervisor.step(rig.cycle(), rig.driver, rig.instant()))
    began = rig.wall
    while rig.steps[-1].outcome is None:
        rig.wall += 0.02
        rig.obey(supervisor.step([], rig.driver, rig.instant()))
        assert rig.wall < began + 10.0
    assert rig.steps[-1].outcome.code is ResultCode.STATE_LOST


@pytest.mark.parametrize("phase", [Phase.GRIPPER, Phase.PUSH])
def test_states_that_paused_while_the_goal_was_reached_are_no_fault(phase):
    """A busy machine hears nothing for two seconds of a fast simulation; what it hears then is good."""
    rig = Rig()
    rig.wall_rate = 0.02
    supervisor = rig.supervisor()
    rig.obey(supervisor.start(rig.driver, rig.instant()))
    while rig.steps[-1].phase is not phase:
        rig.obey(supervisor.step(rig.cycle(), rig.driver, rig.instant()))
    rig.corrupt = lambda sample: None
    for _ in range(300):
        rig.cycle()
    rig.corrupt = lambda sample: sample
    while rig.steps[-1].outcome is None:
        rig.obey(supervisor.step(rig.cycle(), rig.driver, rig.instant()))
    assert rig.steps[-1].outcome.code is ResultCode.OK
