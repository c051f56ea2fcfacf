import shutil
import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ros2_ws.src.singulation_perception.test.bag_making import SECOND, STORE, cloud, cloud_bag, text, write_bag

from singulation_core import ResultCode, SingulationError
from singulation_perception.bag_reading import bag_topics, cloud_topic, read_bag_clouds
from singulation_perception.decoding import decode_points


def failure(action):
    with pytest.raises(SingulationError) as caught:
        action()
    assert caught.value.code == ResultCode.BAD_FILE
    return caught.value.message


def points_of(path, topic=""):
    return [decode_points(one.data, one.layout) for one in read_bag_clouds(path, topic)]


@pytest.mark.parametrize(
    ("storage", "compression"),
    [
        ("mcap", None),
        ("mcap", "STORAGE"),
        ("mcap", "MESSAGE"),
        ("sqlite3", None),
        ("sqlite3", "MESSAGE"),
        ("sqlite3", "FILE"),
    ],
)
def test_clouds_come_back_with_stamps_and_frame(tmp_path, storage, compression):
    bag, points = cloud_bag(tmp_path / "bag", storage=storage, compression=compression)
    clouds = list(read_bag_clouds(bag))
    assert [one.recorded for one in clouds] == [100 * SECOND, 101 * SECOND, 102 * SECOND]
    assert [one.stamp for one in clouds] == [one.recorded - SECOND // 50 for one in clouds]
    assert {one.frame for one in clouds} == {"phoxi_camera_sensor"}
    assert clouds[1].source == f"{bag} /points #2"
    np.testing.assert_array_equal([decode_points(one.data, one.layout) for one in clouds], points)


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_a_storage_file_alone_and_a_folder_without_metadata_can_be_read(tmp_path, storage):
    bag, points = cloud_bag(tmp_path / "bag", storage=storage)
    file = next(item for item in bag.iterdir() if item.suffix in (".mcap", ".db3"))
    np.testing.assert_array_equal(points_of(file), points)
    (bag / "metadata.yaml").unlink()
    np.testing.assert_array_equal(points_of(bag), points)


def test_a_recording_split_into_files_is_read_in_order(tmp_path):
    bag, points = cloud_bag(tmp_path / "bag")
    second, more = cloud_bag(tmp_path / "more", count=2)
    (bag / "bag.mcap").rename(bag / "bag_0.mcap")
    shutil.copy(second / "more.mcap", bag / "bag_1.mcap")
    (bag / "metadata.yaml").unlink()
    np.testing.assert_array_equal(points_of(bag), [*points, *more])


def test_the_topics_are_listed(tmp_path):
    bag = write_bag(tmp_path / "bag", [("/b", text(), 1), ("/a", cloud(np.zeros((1, 2, 3))), 2), ("/b", text(), 3)])
    assert [str(topic) for topic in bag_topics(bag)] == [
        "/a (sensor_msgs/msg/PointCloud2, 1 messages)",
        "/b (std_msgs/msg/String, 2 messages)",
    ]


def test_one_of_several_cloud_topics_has_to_be_chosen(tmp_path):
    first, second = np.zeros((1, 2, 3)), np.ones((1, 2, 3))
    bag = write_bag(tmp_path / "bag", [("/left", cloud(first), 1), ("/right", cloud(second), 2), ("/note", text(), 3)])
    assert "choose one: /left, /right" in failure(lambda: points_of(bag))
    assert "no clouds (sensor_msgs/msg/PointCloud2) on topic '/note'" in failure(lambda: points_of(bag, "/note"))
    assert "/left (sensor_msgs/msg/PointCloud2, 1 messages)" in failure(lambda: points_of(bag, "/middle"))
    np.testing.assert_array_equal(points_of(bag, "right")[0], second[0])


def test_a_bag_without_clouds_says_what_it_has(tmp_path):
    bag = write_bag(tmp_path / "bag", [("/chatter", text(), 1)])
    assert "the bag has: /chatter (std_msgs/msg/String, 1 messages)" in failure(lambda: cloud_topic(bag))
    assert "no topics at all" in failure(lambda: cloud_topic(write_bag(tmp_path / "empty", [])))


def test_what_is_no_recording(tmp_path):
    (tmp_path / "folder").mkdir()
    assert "it has nothing" in failure(lambda: bag_topics(tmp_path / "folder"))
    (tmp_path / "folder" / "notes.txt").write_text("hello")
    assert "it has notes.txt" in failure(lambda: bag_topics(tmp_path / "folder"))
    assert "no such file or folder" in failure(lambda: bag_topics(tmp_path / "none"))
    assert "ending '.txt'" in failure(lambda: bag_topics(tmp_path / "folder" / "notes.txt"))


def test_metadata_that_names_a_missing_file(tmp_path):
    bag, _ = cloud_bag(tmp_path / "bag")
    (bag / "bag.mcap").unlink()
    message = failure(lambda: bag_topics(bag))
    assert "bag.mcap" in message
    assert "there are metadata.yaml (" in message


def test_damaged_metadata(tmp_path):
    bag, points = cloud_bag(tmp_path / "bag")
    good = (bag / "metadata.yaml").read_text()
    for content in (
        "",
        "]",
        "rosbag2_bagfile_information: 3",
        good.replace("mcap", "tape"),
        good.replace("version: 9", "version: 99"),
    ):
        (bag / "metadata.yaml").write_text(content)
        assert str(bag) in failure(lambda: bag_topics(bag))
    (bag / "metadata.yaml").write_text(good)
    np.testing.assert_array_equal(points_of(bag), points)


@settings(max_examples=60, deadline=None)
@given(share=st.floats(0, 0.9999), storage=st.sampled_from(["mcap", "sqlite3"]))
def test_a_bag_cut_off_anywhere_is_refused_or_gives_whole_clouds(tmp_path_factory, share, storage):
    bag, points = cloud_bag(tmp_path_factory.mktemp("cut") / "bag", count=4, shape=(20, 30), storage=storage)
    file = next(item for item in bag.iterdir() if item.suffix in (".mcap", ".db3"))
    content = file.read_bytes()
    file.write_bytes(content[: int(share * len(content))])
    read = []
    try:
        read.extend(decode_points(one.data, one.layout) for one in read_bag_clouds(bag))
    except SingulationError as error:
        assert error.code == ResultCode.BAD_FILE
        assert file.name in error.message
        assert f"({file.stat().st_size} bytes)" in error.message
    for one, expected in zip(read, points, strict=False):
        np.testing.assert_array_equal(one, expected)


@settings(max_examples=100, deadline=None)
@given(place=st.floats(0, 1), change=st.binary(min_size=1, max_size=8), storage=st.sampled_from(["mcap", "sqlite3"]))
def test_a_bag_with_flipped_bytes_never_raises_anything_uncoded(tmp_path_factory, place, change, storage):
    bag, _ = cloud_bag(tmp_path_factory.mktemp("flip") / "bag", storage=storage)
    file = next(item for item in bag.iterdir() if item.suffix in (".mcap", ".db3"))
    content = bytearray(file.read_bytes())
    at = int(place * len(content))
    content[at : at + len(change)] = change
    file.write_bytes(content)
    try:
        for one in read_bag_clouds(bag):
            decode_points(one.data, one.layout)
    except SingulationError as error:
        assert error.code in (ResultCode.BAD_FILE, ResultCode.BAD_LAYOUT, ResultCode.NO_POINTS)


def test_a_message_that_is_no_cloud_names_its_place(tmp_path):
    bag, _ = cloud_bag(tmp_path / "bag")
    kind = "sensor_msgs/msg/PointCloud2"
    from rosbags.rosbag2 import StoragePlugin, Writer

    with Writer(tmp_path / "odd", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connection = writer.add_connection("/points", kind, typestore=STORE)
        writer.write(connection, 1, STORE.serialize_cdr(cloud(np.zeros((1, 1, 3))), kind))
        writer.write(connection, 2, b"\x00\x01\x00\x00 nonsense")
    clouds = read_bag_clouds(tmp_path / "odd")
    assert next(clouds).layout.width == 1
    assert "/points #2: the message is damaged" in failure(lambda: next(clouds))
    assert len(points_of(bag)) == 3


def peak_memory(bag):
    """Largest amount of memory taken while a bag is read [bytes]."""
    tracemalloc.start()
    try:
        for one in read_bag_clouds(bag):
            assert one.layout.height == 200
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_memory_does_not_grow_with_the_bag(tmp_path, storage):
    short, _ = cloud_bag(tmp_path / "short", count=8, shape=(200, 300), storage=storage)
    long, _ = cloud_bag(tmp_path / "long", count=40, shape=(200, 300), storage=storage)
    assert peak_memory(long) < peak_memory(short) + 200 * 300 * 12  # one cloud
