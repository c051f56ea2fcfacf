"""The retreat after a fault goes straight up."""

import numpy as np
import pytest

from singulation_core import CellGeometry, ContactMode, Push, ResultCode, SingulationError
from yumi_push_executor.kinematics import YumiArm
from yumi_push_executor.lifting import plan_lift
from yumi_push_executor.motion import plan_motion
from yumi_push_executor.supervision import Phase

UP = CellGeometry().body_from_table[:3, 2]


def low_posture(arm):
    motion = plan_motion(Push((-0.02, 0.0), (0.05, 0.01), ContactMode.SINGLE_POINT), arms=(arm,))
    return motion.segment(Phase.PUSH).trajectory.end


@pytest.mark.parametrize("name", ["left", "right"])
def test_it_is_straight_upright_slow_and_from_rest_to_rest(name):
    arm = YumiArm(name)
    start = low_posture(name)
    lift = plan_lift(arm, start, UP, rise=0.05, speed=0.1)
    times = np.linspace(0.0, lift.duration, 400)
    positions, velocities = lift.sample(times)
    poses = np.array([arm.tip(q) for q in positions])
    way = poses[:, :3, 3] - poses[0, :3, 3]
    sideways = way - np.outer(way @ UP, UP)
    assert np.abs(sideways).max() < 5e-4
    assert way[-1] @ UP == pytest.approx(0.05, abs=1e-5)
    assert np.abs(poses[:, :3, :3] - poses[0, :3, :3]).max() < 2e-3
    speeds = np.diff(way @ UP) / np.diff(times)
    assert speeds.min() > -1e-4
    assert speeds.max() <= 0.101
    assert np.all(np.abs(velocities) <= 0.5 * arm.velocity)
    np.testing.assert_array_equal(velocities[[0, -1]], 0.0)
    np.testing.assert_allclose(positions[0], start, atol=1e-9)


def test_it_ends_where_the_arm_ends():
    arm = YumiArm("left")
    start = low_posture("left")
    lift = plan_lift(arm, start, UP, rise=1.0, speed=0.1)
    height = (arm.tip(lift.end)[:3, 3] - arm.tip(start)[:3, 3]) @ UP
    assert 0.1 < height < 0.9
    assert np.all((lift.end >= arm.lower) & (lift.end <= arm.upper))
    with pytest.raises(SingulationError) as caught:
        plan_lift(arm, lift.end, UP, rise=0.05, speed=0.1)
    assert caught.value.code is ResultCode.UNREACHABLE
