"""Joint states lost, spoiled or frozen while a motion runs: the code, the reaction; and the next push works."""

import dataclasses

import numpy as np
import pytest
from rig import set_rig

from singulation_core import ResultCode
from yumi_push_executor.supervision import Phase, SupervisionLimits

LIMITS = SupervisionLimits()
MOVING = [Phase.APPROACH, Phase.DESCEND, Phase.PUSH, Phase.RETREAT, Phase.CLEAR_VIEW]


def freeze(rig, _):
    """Same numbers, new stamps."""
    kept = rig.watch.latest
    rig.corrupt = lambda sample: dataclasses.replace(kept, taken=sample.taken, arrived=sample.arrived)


def same_stamp(rig, _):
    kept = rig.watch.latest
    rig.corrupt = lambda sample: dataclasses.replace(sample, taken=kept.taken)


def late(rig, _):
    rig.corrupt = lambda sample: dataclasses.replace(sample, taken=sample.taken - 0.6)


def replaced(value, arm="left", joint=2):
    def spoil(sample):
        positions = {name: np.array(q) for name, q in sample.positions.items()}
        positions[arm][joint if joint is not None else slice(None)] = value
        return dataclasses.replace(sample, positions=positions)

    return set_rig(corrupt=spoil)


def lost_arm(sample):
    return dataclasses.replace(sample, positions={"left": sample.positions["left"]})


STATE_FAULTS = {
    "drop": (set_rig(corrupt=lambda sample: None), LIMITS.state_age, "old"),
    "same stamps": (same_stamp, LIMITS.state_age, "old"),
    "late": (late, LIMITS.state_age, "before they arrive"),
    "NaN": (replaced(np.nan), 0.0, "left joint 3 is nan"),
    "infinite": (replaced(-np.inf), 0.0, "left joint 3 is -inf"),
    "all zero": (replaced(0.0, joint=None), 0.0, "exactly 0"),
    "other arm NaN": (replaced(np.nan, "right", 6), 0.0, "right joint 7 is nan"),
    "outside the range": (replaced(9.0), 0.0, "outside its range"),
    "one arm missing": (set_rig(corrupt=lost_arm), 0.0, "lack the right arm"),
}


@pytest.mark.parametrize("phase", [Phase.GRIPPER, Phase.APPROACH, Phase.PUSH])
@pytest.mark.parametrize("name", STATE_FAULTS)
def test_lost_states_stop_the_arm_on_its_path(rig, name, phase):
    happen, allowed, text = STATE_FAULTS[name]
    outcome = rig.run(events=[(phase, 0.15, happen)])
    assert outcome.code is ResultCode.STATE_LOST
    assert text in outcome.text
    assert not outcome.standing  # nobody can see it
    assert "standstill was not seen" in outcome.text
    assert rig.reaction() <= allowed + 0.02
    assert rig.standstill() <= 0.1
    assert rig.fastest_command() <= 3.2
    assert rig.asked_to_lift == 0
    rig.require_good_push()


def test_states_that_come_back_during_the_stop_confirm_it(rig):
    outcome = rig.run(
        events=[
            (Phase.PUSH, 0.3, set_rig(corrupt=lambda sample: None)),
            (Phase.STOPPING, 0.3, set_rig(corrupt=lambda sample: sample)),
        ]
    )
    assert (outcome.code, outcome.standing) == (ResultCode.STATE_LOST, True)
    rig.require_good_push()


@pytest.mark.parametrize("phase", [Phase.APPROACH, Phase.PUSH, Phase.CLEAR_VIEW])
def test_frozen_states_are_noticed_and_not_believed(rig, phase):
    outcome = rig.run(events=[(phase, 0.35, freeze)])
    assert outcome.code is ResultCode.NO_PROGRESS
    assert "frozen" in outcome.text
    assert not outcome.standing
    assert rig.reaction() <= LIMITS.progress_window + 0.02
    assert rig.standstill() <= 0.1
    assert rig.fastest_command() <= 3.2
    assert rig.asked_to_lift == 0
    rig.require_good_push()


@pytest.mark.parametrize("phase", MOVING)
def test_states_frozen_before_the_arm_was_seen_to_move_are_noticed(rig, phase):
    outcome = rig.run(events=[(phase, 0.0, freeze)])
    assert outcome.code is ResultCode.NO_PROGRESS
    assert "frozen" in outcome.text
    assert not outcome.standing
    assert rig.reaction() <= LIMITS.start_latency + 0.2
    assert rig.asked_to_lift == 0
    rig.require_good_push()
