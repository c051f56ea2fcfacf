import copy
import math

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from hypothesis import given, settings
from hypothesis import strategies as st
from singulation_msgs import msg as messages
from std_msgs.msg import Header

from singulation_core import (
    Arrangement,
    ContactMode,
    InvalidInputError,
    PlanarObject,
    Push,
    ResultCode,
    SingulationError,
)
from singulation_core import conversions as convert


def polygon(sides, radius, x, y, turn):
    angles = turn + np.arange(sides) * 2 * np.pi / sides
    return np.column_stack((x + radius * np.cos(angles), y + radius * np.sin(angles)))


polygons = st.builds(
    polygon,
    st.integers(3, 15),
    st.floats(0.01, 0.1),
    st.floats(-0.5, 0.5),
    st.floats(-0.5, 0.5),
    st.floats(0.0, 6.0),
)


@given(st.lists(polygons, max_size=5), st.integers(0, 2**31 - 1), st.integers(0, 10**9 - 1))
@settings(max_examples=50)
def test_an_arrangement_survives_the_wire(outlines, sec, nanosec):
    objects = [PlanarObject(7 * index, outline, 0.03, 12, 0.5) for index, outline in enumerate(outlines)]
    message = convert.arrangement_to_msg(Arrangement(objects), Time(sec=sec, nanosec=nanosec))
    assert message.header.stamp == Time(sec=sec, nanosec=nanosec)
    read = convert.arrangement_from_msg(message)
    assert read.frame == "table"
    assert read.stamp == pytest.approx(sec + 1e-9 * nanosec)
    for before, after in zip(objects, read.objects, strict=True):
        np.testing.assert_allclose(after.outline, before.outline, atol=1e-7)
        assert (after.id, after.height, after.point_count) == (before.id, 0.03, 12)
        assert after.confidence == pytest.approx(0.5)


def test_a_vertex_that_arrives_twice_counts_once():
    """Two vertices nearer to each other than float32 can tell apart."""
    message = convert.object_to_msg(PlanarObject(1, polygon(5, 0.02, 0.1, 0.2, 0.3)))
    expected = convert.object_from_msg(message).outline
    for vertex in (4, 0):
        points = list(message.outline.points)
        message.outline.points = points[: vertex + 1] + points[vertex:]
    assert len(message.outline.points) == 7
    np.testing.assert_array_equal(convert.object_from_msg(message).outline, expected)


@pytest.mark.parametrize("count", [0, 1, 2])
def test_an_outline_of_too_few_vertices_is_refused(count):
    message = convert.object_to_msg(PlanarObject(1, polygon(5, 0.02, 0.1, 0.2, 0.3)))
    whole, message.outline.points = message.outline.points, message.outline.points[:count]
    with pytest.raises(InvalidInputError, match="object 1: shape"):
        convert.object_from_msg(message)
    message.outline.points = whole
    assert len(convert.object_from_msg(message).outline) == 5


@given(st.floats(0, 2**31 - 1))
def test_a_stamp_survives_the_wire(seconds):
    assert convert.seconds_of(convert.stamp_of(seconds)) == pytest.approx(seconds, abs=1e-6)


@pytest.mark.parametrize("seconds", [-1.0, math.nan, math.inf, 2.0**31])
def test_a_stamp_that_no_message_holds_is_refused(seconds):
    with pytest.raises(InvalidInputError, match="stamp"):
        convert.stamp_of(seconds)


PUSHES = [
    Push((0.1, 0.0), (0.2, 0.1), ContactMode.SINGLE_POINT, 0.0, 3, "cluster_push", 0.25),
    Push((0.1, 0.0), (0.2, 0.1), ContactMode.TWO_POINT, 0.02, 3, "brute_force", math.nan),
]


@pytest.mark.parametrize("push", PUSHES)
def test_a_push_survives_the_wire(push):
    header = Header(stamp=Time(sec=5, nanosec=7), frame_id="table")
    message = convert.push_to_msg(push, header)
    assert message.header == header
    read = convert.push_from_msg(message)
    np.testing.assert_array_equal(read.start, push.start)
    np.testing.assert_array_equal(read.end, push.end)
    assert (read.contact_mode, read.contact_width, read.target_id, read.policy) == (
        push.contact_mode,
        push.contact_width,
        push.target_id,
        push.policy,
    )
    assert read.expected_gain == pytest.approx(push.expected_gain, nan_ok=True)


def break_start(message):
    message.start.x = math.nan


def break_plane(message):
    message.end.z = 0.1


def break_length(message):
    message.end = copy.deepcopy(message.start)


def break_width(message):
    message.contact_width = -0.01


def break_mode(message):
    message.contact_mode.value = 9


@pytest.mark.parametrize(
    ("spoil", "code", "text"),
    [
        (break_start, ResultCode.INVALID_INPUT, "start"),
        (break_plane, ResultCode.INVALID_INPUT, "end.z"),
        (break_length, ResultCode.INVALID_INPUT, "coincide"),
        (break_width, ResultCode.INVALID_INPUT, "contact width"),
        (break_mode, ResultCode.UNKNOWN_CONTACT_MODE, "two_point"),
    ],
)
def test_a_spoiled_push_is_refused_and_the_good_one_read(spoil, code, text):
    message = convert.push_to_msg(PUSHES[0], Header(frame_id="table"))
    spoiled = copy.deepcopy(message)
    spoil(spoiled)
    with pytest.raises(SingulationError, match=text) as refusal:
        convert.push_from_msg(spoiled)
    assert refusal.value.code == code
    assert convert.push_from_msg(message).policy == "cluster_push"


def test_a_spoiled_object_is_refused_by_its_id():
    message = convert.arrangement_to_msg(Arrangement([PlanarObject(4, polygon(5, 0.03, 0, 0, 0))]))
    spoiled = copy.deepcopy(message)
    spoiled.objects[0].outline.points.reverse()
    with pytest.raises(InvalidInputError, match="object 4: clockwise"):
        convert.arrangement_from_msg(spoiled)
    assert len(convert.arrangement_from_msg(message)) == 1


def test_the_message_is_new_and_shares_nothing():
    header = Header(frame_id="table")
    message = convert.push_to_msg(PUSHES[0], header)
    header.frame_id = "elsewhere"
    assert message.header.frame_id == "table"


def test_a_cloud_keeps_every_value():
    points = np.arange(24, dtype=np.float32).reshape(2, 4, 3)
    points[0, 1] = np.nan
    message = convert.cloud_to_msg(points, Header(frame_id="phoxi_camera_sensor"))
    assert (message.height, message.width, message.point_step, message.row_step) == (2, 4, 12, 48)
    np.testing.assert_array_equal(np.frombuffer(message.data, "<f4").reshape(2, 4, 3), points)


def test_result_codes_are_those_of_the_message():
    names = [name for name, value in vars(type(messages.ResultCode)).items() if isinstance(value, property)]
    listed = {name: getattr(messages.ResultCode, name) for name in names}
    assert {code.name: int(code) for code in ResultCode} == listed


def test_contact_modes_are_those_of_the_message():
    for mode in ContactMode:
        assert getattr(messages.ContactMode, mode.name) == mode
        assert convert.contact_mode_from_msg(convert.contact_mode_to_msg(mode)) is mode
