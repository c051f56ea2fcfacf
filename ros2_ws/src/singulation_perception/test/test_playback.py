import numpy as np
import pytest
from ros2_ws.src.singulation_perception.test.bag_making import cloud_bag

from singulation_core import ResultCode, SingulationError
from singulation_perception.playback import Rhythm, find_recording

SECOND = 10**9


def write_ply(path, points=((0, 0, 1),)):
    lines = "".join(f"{x} {y} {z}\n" for x, y, z in points)
    head = f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n"
    path.write_text(f"{head}property float x\nproperty float y\nproperty float z\nend_header\n{lines}")
    return path


def test_rhythm_keeps_the_distances_of_the_recording():
    rhythm = Rhythm(2.0)
    assert rhythm.recorded_at(4.0) is None
    assert rhythm.due(100 * SECOND, 5.0) == 5.0
    assert rhythm.due(103 * SECOND, 5.1) == 6.5
    assert rhythm.recorded_at(6.5) == 103 * SECOND
    rhythm.restart()
    assert rhythm.due(100 * SECOND, 50.0) == 50.0


def test_step_by_step_the_time_stands_still_between_clouds():
    rhythm = Rhythm(1.0, stepping=True)
    rhythm.due(100 * SECOND, 5.0)
    assert rhythm.recorded_at(60.0) == 100 * SECOND
    rhythm.restart()
    rhythm.due(101 * SECOND, 61.0)
    assert rhythm.recorded_at(61.0) == 101 * SECOND


def test_files_are_played_in_the_given_order_and_distance(tmp_path):
    paths = [write_ply(tmp_path / f"{name}.ply") for name in "ba"]
    recording = find_recording(paths, "", 0.5)
    clouds = list(recording.open())
    assert recording.count == 2
    assert [one.source for one in clouds] == [str(path) for path in paths]
    assert clouds[1].recorded - clouds[0].recorded == SECOND // 2
    assert len(list(recording.open())) == 2


def test_a_bag_can_be_played_again(tmp_path):
    bag, _ = cloud_bag(tmp_path / "bag")
    recording = find_recording([bag], "", 1.0)
    assert recording.count == 3
    assert recording.name == f"{bag} /points"
    for _ in range(2):
        assert len(list(recording.open())) == 3


def test_files_are_read_one_by_one(tmp_path):
    paths = [write_ply(tmp_path / "good.ply"), tmp_path / "broken.ply"]
    paths[1].write_text("broken")
    clouds = find_recording(paths, "", 1.0).open()
    assert next(clouds).layout.width == 1
    with pytest.raises(SingulationError, match=r"broken\.ply"):
        next(clouds)


def test_what_is_missing_is_said_before_anything_is_played(tmp_path):
    good = write_ply(tmp_path / "good.ply")
    with pytest.raises(SingulationError, match=r"none\.pcd: no such file") as caught:
        find_recording([good, tmp_path / "none.pcd"], "", 1.0)
    assert caught.value.code == ResultCode.BAD_FILE


def test_a_bag_among_files_is_refused(tmp_path):
    bag, points = cloud_bag(tmp_path / "bag")
    with pytest.raises(SingulationError, match="either one bag or cloud files") as caught:
        find_recording([write_ply(tmp_path / "good.ply"), bag], "", 1.0)
    assert caught.value.code == ResultCode.INVALID_INPUT
    assert find_recording([bag], "/points", 1.0).count == len(np.asarray(points))
