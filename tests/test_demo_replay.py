"""The first part of the demo: recorded clouds, with the real nodes as processes."""

import numpy as np
import pytest
from PIL import Image

from made_recordings import bare_table, write_bag, write_sqlite_bag
from running_demo import REAL_CLOUDS
from singulation_bringup.example_recording import SCENES, clouds
from singulation_core import ResultCode


def run(demo, *arguments):
    started = demo("--part", "replay", *arguments)
    code, output, errors = started.end()
    assert "Traceback" not in errors, errors
    return code, output, errors, started


def test_our_own_recording_shows_every_block_and_a_push(demo):
    code, output, errors, started = run(demo)
    assert code == 0, errors
    frames = started.summary["frames"]
    assert [len(frame["objects"]) for frame in frames] == [blocks for _, blocks in SCENES]
    for number, frame in enumerate(frames, start=1):
        assert frame["push"]["policy"] == "cluster_push"
        start, end = np.array(frame["push"]["start"]), np.array(frame["push"]["end"])
        assert 0.005 < np.linalg.norm(end - start) < 0.2
        with Image.open(started.out / f"cloud_{number:02d}.png") as picture:
            assert picture.width > 600
    assert "3 recorded clouds" in output
    assert started.summary["code"] == 0


def test_a_sqlite_bag_with_another_topic_name(demo, tmp_path):
    bag = write_sqlite_bag(tmp_path / "bag", clouds()[0])
    code, _, errors, started = run(demo, "--bag", bag)
    assert code == 0, errors
    assert len(started.summary["frames"][0]["objects"]) == SCENES[0][1]


@pytest.mark.parametrize("path", REAL_CLOUDS[:1], ids=lambda path: path.name)
def test_a_real_recorded_scene_gives_its_boxes(demo, path):
    code, _, errors, started = run(demo, "--clouds", path)
    assert code == 0, errors
    (frame,) = started.summary["frames"]
    assert len(frame["objects"]) == 2
    assert frame["push"] is not None


def test_nothing_to_do_and_no_points_are_different_and_neither_stops_the_rest(demo, tmp_path):
    empty = np.zeros((40, 50, 3), dtype=np.float32)
    bag = write_bag(tmp_path / "bag", [bare_table(), empty, clouds()[0]])
    code, _, errors, started = run(demo, "--bag", bag)
    assert code == 0, errors
    frames = started.summary["frames"]
    assert [frame["code"] for frame in frames] == [ResultCode.NOTHING_TO_DO, ResultCode.NO_POINTS, ResultCode.OK]
    assert [len(frame["objects"]) for frame in frames] == [0, 0, SCENES[0][1]]
