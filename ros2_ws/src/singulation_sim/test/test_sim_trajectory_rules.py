"""Which trajectories the controller takes: the behaviour of ros2_control's JointTrajectoryController on Jazzy."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from singulation_core import InvalidInputError
from singulation_sim.driver.trajectory import JointTrajectory, accepted, point

JOINTS = ("a", "b", "c")
GOOD = JointTrajectory(JOINTS, [point(0.5, [1.0, 2.0, 3.0]), point(1.0, [2.0, 3.0, 4.0])])


def refused(trajectory: JointTrajectory, words: str, now: float = 0.0) -> None:
    with pytest.raises(InvalidInputError, match=words):
        accepted(trajectory, JOINTS, now)
    assert accepted(GOOD, JOINTS, now) is not None


def with_point(**changes: object) -> JointTrajectory:
    """The good trajectory with its second point changed."""
    return replace(GOOD, points=[GOOD.points[0], replace(GOOD.points[1], **changes)])  # type: ignore[arg-type]


@given(st.permutations(JOINTS))
def test_permuted_joints_are_put_in_order(names: list[str]) -> None:
    values = {"a": 1.0, "b": 2.0, "c": 3.0}
    given_order = [values[name] for name in names]
    taken = accepted(JointTrajectory(names, [point(1.0, given_order, [0.0] * 3, given_order)]), JOINTS, 0.0)
    assert taken.points[0].positions.tolist() == [1.0, 2.0, 3.0]
    assert taken.points[0].accelerations.tolist() == [1.0, 2.0, 3.0]


@pytest.mark.parametrize(
    ("names", "words"),
    [
        (("a", "b"), r"missing \['c'\]"),
        (("a", "b", "x"), r"unknown \['x'\], missing \['c'\]"),
        (("a", "b", "b"), r"missing \['c'\]"),
        (("a", "b", "c", "c"), "4 joints"),
        ((), "0 joints"),
    ],
)
def test_joint_names_have_to_be_the_controllers(names: tuple[str, ...], words: str) -> None:
    refused(replace(GOOD, joint_names=names), words)


def test_without_points_it_is_refused_and_does_not_mean_stop() -> None:
    refused(replace(GOOD, points=[]), "no points")


@pytest.mark.parametrize("time", [0.5, 0.4, math.nan, math.inf])
def test_times_have_to_increase(time: float) -> None:
    refused(with_point(time=time), "points 0 and 1")


@pytest.mark.parametrize("time", [-0.1, math.nan, math.inf])
def test_first_time_is_not_negative(time: float) -> None:
    refused(replace(GOOD, points=[replace(GOOD.points[0], time=time)]), "point 0 is at")


def test_sizes_have_to_fit() -> None:
    refused(with_point(positions=np.zeros(2)), "point 1 has 2 positions, need 3")
    refused(with_point(positions=np.empty(0)), "point 1 has 0 positions")
    refused(with_point(velocities=np.zeros(2)), "2 velocities, need 0 or 3")
    refused(with_point(accelerations=np.zeros(4)), "4 accelerations")
    refused(with_point(effort=np.zeros(3)), "3 effort, need 0")


@pytest.mark.parametrize("field", ["positions", "velocities", "accelerations"])
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_numbers_have_to_be_finite(field: str, bad: float) -> None:
    refused(with_point(**{field: np.array((0.0, bad, 0.0))}), f"point 1, joint 1: {field}")


def test_it_has_to_end_at_rest() -> None:
    refused(with_point(velocities=np.array((0.0, 1e-3, 0.0))), "ends with 0.001")
    assert accepted(with_point(velocities=np.zeros(3)), JOINTS, 0.0) is not None
    moving_inside = replace(GOOD, points=[point(0.5, [0.0] * 3, [1.0] * 3), point(1.0, [1.0] * 3, [0.0] * 3)])
    assert accepted(moving_inside, JOINTS, 0.0) is not None


def test_an_end_in_the_past_is_refused_but_stamp_zero_means_now() -> None:
    refused(replace(GOOD, stamp=5.0), "in the past", now=6.5)
    assert accepted(replace(GOOD, stamp=5.0), JOINTS, 5.9) is not None
    assert accepted(GOOD, JOINTS, 1e9) is not None
