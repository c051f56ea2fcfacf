"""The second part of the demo: the closed loop of real nodes in the simulated cell."""

import numpy as np
import pytest
from PIL import Image

from singulation_core import ResultCode
from singulation_perception.bag_reading import bag_topics


@pytest.mark.parametrize("mode", ["single_point", "edge", "two_point"])
def test_blocks_are_taken_apart(demo, mode):
    started = demo("--part", "cell", "--objects", "3", "--seed", "2", "--contact-mode", mode, "--max-pushes", "6")
    code, output, errors = started.end()
    assert code == 0, errors + output
    summary = started.summary
    pushes, distances = summary["pushes"], summary["singulation_distance"]
    assert pushes
    assert len(distances) == len(summary["smallest_gap"]) == len(pushes) + 1
    assert distances[-1] > distances[0] + 0.05
    assert {push["contact_mode"] for push in pushes} == {mode}
    assert ResultCode.OK in {push["code"] for push in pushes}
    for number in range(1, len(pushes) + 1):
        with Image.open(started.out / f"push_{number:02d}.png") as picture:
            assert np.asarray(picture.convert("L")).std() > 10
    with Image.open(started.out / "run.gif") as film:
        assert film.n_frames > 10
    assert f"<h2>{len(pushes)} push" in (started.out / "index.html").read_text()
    assert summary["stages"]["push"]["count"] >= len(pushes)
    assert summary["stages"]["look"]["seconds"] > 0.0
    topics = {topic.name: topic.count for topic in bag_topics(started.out / "run")}
    assert topics["/outcomes"] == len(pushes)
    assert topics["/points"] >= len(pushes) + 1
    assert topics["/joint_states"] > 100


def test_one_block_is_nothing_to_do(demo):
    started = demo("--part", "cell", "--objects", "1")
    code, output, errors = started.end()
    assert code == 0, errors
    assert "nothing to do" in output
    assert started.summary["pushes"] == []


def test_no_blocks_is_nothing_to_do(demo):
    started = demo("--part", "cell", "--objects", "0")
    code, output, errors = started.end()
    assert code == 0, errors
    assert "nothing to do: no objects" in output


def test_the_number_of_pushes_is_kept(demo):
    started = demo("--part", "cell", "--objects", "5", "--seed", "4", "--max-pushes", "1")
    code, _, errors = started.end()
    assert code == 0, errors
    assert len(started.summary["pushes"]) <= 1
