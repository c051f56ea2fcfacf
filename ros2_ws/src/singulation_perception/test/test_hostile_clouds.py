"""Clouds that no camera should send: each is refused with a code, the node stays, the next good cloud works."""

import time
from array import array

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from ros2_ws.src.singulation_perception.test.node_bench import SECOND
from ros2_ws.src.singulation_perception.test.table_scene import message, scene
from sensor_msgs.msg import PointCloud2, PointField

fuzzed = settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


def changed(**values):
    def change(cloud):
        for name, value in values.items():
            setattr(cloud, name, value)
        return cloud

    return change


def points_changed(function):
    def change(cloud):
        points = np.frombuffer(cloud.data, "<f4").reshape(cloud.height, cloud.width, 3)
        stamp = cloud.header.stamp.sec * SECOND + cloud.header.stamp.nanosec
        return message(function(points.copy()), stamp)

    return change


def random_depth(points):
    points[..., 2] = np.random.default_rng(1).uniform(0.7, 1.0, points.shape[:2])
    return points


def stamped(sec):
    def change(cloud):
        cloud.header.stamp.sec = sec
        return cloud

    return change


BAD = {
    "empty": (lambda cloud: PointCloud2(header=cloud.header, fields=cloud.fields), "NO_POINTS"),
    "zero width": (changed(width=0), "BAD_LAYOUT"),
    "short data": (lambda cloud: changed(data=cloud.data[:-1])(cloud), "BAD_LAYOUT"),
    "long data": (lambda cloud: changed(data=cloud.data + cloud.data[:1])(cloud), "BAD_LAYOUT"),
    "no z": (lambda cloud: changed(fields=cloud.fields[:2])(cloud), "BAD_LAYOUT"),
    "big-endian by mistake": (changed(is_bigendian=True), "NO_POINTS NOT_METRES"),
    "all missing as NaN": (points_changed(lambda points: points * np.float32(np.nan)), "NO_POINTS"),
    "all missing as zeros": (points_changed(lambda points: points * np.float32(0)), "NO_POINTS"),
    "all infinite": (points_changed(lambda points: points + np.float32(np.inf)), "NO_POINTS"),
    "all identical": (
        points_changed(lambda points: points * np.float32(0) + np.float32((0, 0, 0.9))),
        "NO_TABLE NO_POINTS",
    ),
    "millimetres": (points_changed(lambda points: points * np.float32(1000)), "NOT_METRES"),
    "no plane": (points_changed(random_depth), "NO_TABLE WRONG_TABLE"),
    "floor of the bin": (points_changed(lambda points: points + np.float32((0, 0, 0.05))), "WRONG_TABLE"),
    "stamp zero": (stamped(0), "STALE_INPUT"),
    "from the future": (stamped(2**31 - 2), "STALE_INPUT"),
    "backwards": (stamped(1), "STALE_INPUT"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_cloud_is_rejected_with_a_code_publishes_nothing_and_the_next_good_one_works(bench, name):
    change, codes = BAD[name]
    bench.good()
    published, rejected = bench.see(change(message(scene(), bench.next_stamp())))
    assert published == 0
    assert len(rejected) == 1
    assert rejected[0] in codes.split()
    assert bench.good().objects
    assert len(bench.objects.messages) == 2
    assert bench.ledger.received == 3


def test_a_bare_table_is_an_arrangement_without_objects(bench):
    assert bench.see(message(scene(blocks=()), bench.next_stamp())) == (1, [])
    assert len(bench.objects.wait(1).objects) == 0
    assert len(bench.good().objects) == 3


def test_the_same_cloud_twice_counts_once(bench):
    cloud = message(scene(), bench.next_stamp())
    assert bench.see(cloud) == (1, [])
    assert bench.see(cloud) == (0, ["STALE_INPUT"])
    bench.good()


integers = st.one_of(st.integers(0, 200), st.integers(0, 2**32 - 1))
any_cloud = st.builds(
    PointCloud2,
    height=integers,
    width=integers,
    point_step=integers,
    row_step=integers,
    is_bigendian=st.booleans(),
    is_dense=st.booleans(),
    data=st.binary(max_size=600).map(lambda data: __import__("array").array("B", data)),
    fields=st.lists(
        st.builds(
            PointField,
            name=st.sampled_from(["x", "y", "z", "intensity"]),
            offset=integers,
            datatype=st.integers(0, 255),
            count=integers,
        ),
        max_size=5,
    ),
)


def outcome(bench, cloud):
    """What the node makes of a cloud that is handed to it directly: published, and the codes of rejections."""
    cloud.header.stamp = message(scene(blocks=()), bench.next_stamp()).header.stamp
    before = bench.ledger
    bench.node.ledger.received(time.monotonic())
    bench.node._process(cloud)
    after = bench.ledger
    assert after.pending == 0
    assert after.received == before.received + 1
    rejected = {name for name, count in after.rejected.items() if count > before.rejected.get(name, 0)}
    return after.published - before.published, rejected


@settings(fuzzed, max_examples=80)
@given(cloud=any_cloud)
def test_any_message_has_exactly_one_outcome(bench, cloud):
    assert "INTERNAL" not in outcome(bench, cloud)[1]


def test_ten_times_the_usual_number_of_points_is_refused(bench):
    width = 16_000_001
    cloud = message(scene(), bench.next_stamp())
    cloud = changed(height=1, width=width, row_step=12 * width, data=array("B", bytes(12 * width)))(cloud)
    assert outcome(bench, cloud) == (0, {"CLOUD_TOO_LARGE"})
    bench.good()


@st.composite
def layouts(draw):
    """Names, offsets and types of the coordinates, point_step, padding of the rows, byte order."""
    fields, offset = [], 0
    for name in draw(st.permutations("xyz")):
        kind = draw(st.sampled_from(["f4", "f8"]))
        offset += draw(st.integers(0, 9))
        fields.append((name, offset, kind))
        offset += int(kind[1])
    return fields, offset + draw(st.integers(0, 9)), draw(st.integers(0, 40)), draw(st.sampled_from("<>"))


def written(points, layout):
    """The points as a message of that layout, all other bytes set to 0xA5."""
    fields, step, padding, order = layout
    height, width = points.shape[:2]
    data = np.full((height, width * step + padding), 0xA5, dtype=np.uint8)
    for name, offset, kind in fields:
        values = points[..., "xyz".index(name)].astype(order + kind)
        for byte in range(int(kind[1])):
            place = offset + byte
            data[:, place : width * step : step] = values.view(np.uint8).reshape(height, width, -1)[..., byte]
    return PointCloud2(
        height=height,
        width=width,
        point_step=step,
        row_step=data.shape[1],
        is_bigendian=order == ">",
        fields=[
            PointField(name=name, offset=at, datatype=7 if kind == "f4" else 8, count=1) for name, at, kind in fields
        ],
        data=array("B", data.tobytes()),
    )


@settings(fuzzed, max_examples=25)
@given(layout=layouts())
def test_a_good_cloud_is_good_in_any_layout(bench, layout):
    count = len(bench.objects.messages)
    assert outcome(bench, written(scene(), layout)) == (1, set())
    assert len(bench.objects.wait(count + 1).objects) == 3


DAMAGES = ["value", "axis", "scale", "cut", "repeat", "noise", "turn"]
VALUES = [np.nan, np.inf, -np.inf, 0.0, -0.0, 1e38, -1e38, 1e-40, 0.9]


@st.composite
def spoiled(draw):
    """The good scene after up to three damages."""
    points = scene()
    for damage in draw(st.lists(st.sampled_from(DAMAGES), min_size=1, max_size=3)):
        random = np.random.default_rng(draw(st.integers(0, 99)))
        if damage == "value":
            hit = random.random(points.shape[:2]) < draw(st.sampled_from([0.01, 0.5, 0.99, 1.0]))
            points[hit] = draw(st.sampled_from(VALUES))
        elif damage == "axis":
            points[..., draw(st.integers(0, 2))] = draw(st.sampled_from(VALUES))
        elif damage == "scale":
            points = np.clip(points, -1e30, 1e30) * np.float32(10.0 ** draw(st.integers(-6, 6)))
        elif damage == "cut":
            points = points[: draw(st.integers(1, len(points))), : draw(st.integers(1, points.shape[1]))]
        elif damage == "repeat":
            points = np.broadcast_to(points[:1, :1], points.shape).copy()
        elif damage == "noise":
            points = points + random.normal(0.0, 10.0 ** draw(st.integers(-4, 1)), points.shape)
        else:
            points = np.ascontiguousarray(points[..., random.permutation(3)])
    return np.asarray(points, dtype=np.float32)


@settings(fuzzed, max_examples=60)
@given(points=spoiled())
def test_spoiled_points_are_used_or_refused_and_the_next_good_cloud_works(bench, points):
    with np.errstate(all="ignore"):
        valid = np.isfinite(points).all(axis=-1) & (points != 0.0).any(axis=-1)
    published, rejected = outcome(bench, message(points, bench.next_stamp()))
    assert "INTERNAL" not in rejected
    if not valid.any():
        assert published == 0
    assert outcome(bench, message(scene(), bench.next_stamp()))[0] == 1
