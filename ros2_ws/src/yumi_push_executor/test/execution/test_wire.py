"""Joint states and orders on the wire: matched by name, whatever their order and whatever comes with them."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from singulation_msgs.msg import DriverState

from singulation_core import InvalidInputError
from yumi_push_executor.supervision import DriverMode, Instant, Trajectory
from yumi_push_executor.wire import JointNames, StateReader
from yumi_push_executor.wire_messages import driver_status_from_msg, duration_of, opening_to_msg, trajectory_to_msg

NAMES = JointNames(
    {arm: tuple(f"{arm}_{number}" for number in range(1, 8)) for arm in ("left", "right")},
    {"left": "left_finger", "right": "right_finger"},
)
ALL = [*NAMES.arms["left"], *NAMES.arms["right"], "left_finger", "right_finger"]
VALUES = dict(zip(ALL, [*np.arange(0.1, 0.75, 0.1), *np.arange(-0.1, -0.75, -0.1), 0.01, 0.02], strict=True))


def read(reader, names, velocities=(), taken=5.0, values=VALUES):
    return reader.read(names, [values[name] for name in names], velocities, taken=taken, arrived=7.0)


@given(st.permutations([*ALL, "wheel", "lid"]), st.booleans())
def test_any_order_and_other_joints_are_fine(names, with_velocities):
    values = VALUES | {"wheel": 1.0, "lid": float("nan")}
    velocities = [10.0 * values[name] for name in names] if with_velocities else []
    sample = read(StateReader(NAMES, 0.1), names, velocities, values=values)
    np.testing.assert_allclose(sample.positions["left"], np.arange(0.1, 0.75, 0.1))
    np.testing.assert_allclose(sample.positions["right"], -np.arange(0.1, 0.75, 0.1))
    assert sample.openings == {"left": 0.02, "right": 0.04}
    assert (sample.taken, sample.arrived) == (5.0, 7.0)
    assert set(sample.velocities) == ({"left", "right"} if with_velocities else set())
    if with_velocities:
        np.testing.assert_allclose(sample.velocities["left"], np.arange(1.0, 7.5, 1.0))


def test_arms_and_hands_may_come_in_messages_of_their_own():
    reader = StateReader(NAMES, 0.1)
    assert read(reader, ["left_finger", "right_finger"], taken=4.5) is None
    assert read(reader, NAMES.arms["left"], taken=5.0) is None
    sample = read(reader, NAMES.arms["right"], taken=5.05)
    assert set(sample.positions) == {"left", "right"}
    assert sample.openings == {"left": 0.02, "right": 0.04}
    assert read(reader, NAMES.arms["right"], taken=5.2) is None  # the left arm is too old now
    late = read(reader, [*NAMES.arms["left"], *NAMES.arms["right"]], taken=6.0)
    assert late.openings == {}  # and so are the hands


def test_joints_of_others_are_no_states():
    assert read(StateReader(NAMES, 0.1), ["wheel"], values={"wheel": 1.0}) is None


@pytest.mark.parametrize(
    ("names", "positions", "velocities", "text"),
    [
        (ALL, [0.0] * 15, [], "16 names, 15 positions, 0 velocities"),
        (ALL, [0.0] * 16, [0.0] * 3, "3 velocities"),
        ([*ALL, "left_1"], [0.0] * 17, [], "'left_1'.* more than once"),
        (ALL[:5], [0.0] * 5, [], "left arm lacks .*left_6.*left_7"),
        (ALL[:7] + ALL[8:14], [0.0] * 13, [], "right arm lacks .*right_1"),
    ],
)
def test_contradictions_are_refused_and_the_next_message_is_read(names, positions, velocities, text):
    reader = StateReader(NAMES, 0.1)
    with pytest.raises(InvalidInputError, match=text):
        reader.read(names, positions, velocities, taken=5.0, arrived=7.0)
    assert read(reader, ALL) is not None


def test_speeds_that_are_no_numbers_count_as_not_reported():
    sample = read(StateReader(NAMES, 0.1), ALL, [float("nan")] * 16)
    assert sample.velocities == {}


@pytest.mark.parametrize(
    ("arms", "fingers", "text"),
    [
        ({"left": NAMES.arms["left"][:6], "right": NAMES.arms["right"]}, NAMES.fingers, "left arm has 6"),
        ({"left": NAMES.arms["right"], "right": NAMES.arms["right"]}, NAMES.fingers, "right_1"),
        (NAMES.arms, {"left": "left_1", "right": "right_finger"}, "left_1"),
        (NAMES.arms, {"left": "", "right": "right_finger"}, "an empty one"),
    ],
)
def test_names_that_cannot_be_told_apart_are_refused(arms, fingers, text):
    with pytest.raises(InvalidInputError, match=text):
        JointNames(arms, fingers)


def test_a_trajectory_message_says_now_and_carries_everything():
    times = np.array((0.0, 0.25, 1.000000001))
    rng = np.random.default_rng(0)
    positions, velocities = rng.uniform(-1.0, 1.0, (2, 3, 7))
    message = trajectory_to_msg(Trajectory(times, positions, velocities), NAMES.arms["left"])
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (0, 0)
    assert tuple(message.joint_names) == NAMES.arms["left"]
    np.testing.assert_array_equal([point.positions for point in message.points], positions)
    np.testing.assert_array_equal([point.velocities for point in message.points], velocities)
    assert [(p.time_from_start.sec, p.time_from_start.nanosec) for p in message.points] == [
        (0, 0),
        (0, 250_000_000),
        (1, 1),
    ]
    assert all(len(point.accelerations) == len(point.effort) == 0 for point in message.points)


@given(st.floats(0.0, 1e6))
def test_durations_are_exact_to_a_nanosecond(seconds):
    duration = duration_of(seconds)
    assert 0 <= duration.nanosec < 10**9
    assert math.isclose(duration.sec + 1e-9 * duration.nanosec, seconds, rel_tol=1e-15, abs_tol=1e-9)


def test_an_opening_is_one_number():
    assert list(opening_to_msg(0.04).data) == [0.04]
    with pytest.raises(InvalidInputError, match="nan"):
        opening_to_msg(float("nan"))


def test_driver_modes_are_those_of_the_message():
    for mode in DriverMode:
        assert getattr(DriverState, mode.name) == mode
    message = DriverState(mode=DriverState.GUARD_STOP, left_gripper_calibrated=True, message="door open")
    status = driver_status_from_msg(message, Instant(1.0, 2.0))
    assert (status.mode, status.motion_enabled, status.message) == (DriverMode.GUARD_STOP, False, "door open")
    assert status.calibrated == {"left": True, "right": False}
    message.mode = 77
    with pytest.raises(InvalidInputError, match="mode 77; one of: 0 MOTORS_OFF"):
        driver_status_from_msg(message, Instant(1.0, 2.0))
