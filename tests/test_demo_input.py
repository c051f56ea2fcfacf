"""What people get wrong: each gets one clear line, nothing is started, and nothing is lost."""

import shutil

import numpy as np
import pytest

from made_recordings import write_bag, write_chatter_bag
from running_demo import ROOT

OWN_BAG = ROOT / "share" / "recordings" / "sim_cell"


def refuse(demo, *arguments, out=None):
    """The error line of a demo that does not begin."""
    started = demo(*arguments, out=out)
    code, output, errors = started.end(60)
    assert code == 2
    assert output == ""
    assert "Traceback" not in errors
    assert errors.startswith(("error: ", "usage: "))
    assert not (started.out / "summary.json").exists()
    return errors


def test_a_missing_bag(demo, tmp_path):
    assert f"{tmp_path / 'nothing'}: no such file" in refuse(demo, "--bag", tmp_path / "nothing")


def test_a_truncated_bag(demo, tmp_path):
    bag = shutil.copytree(OWN_BAG, tmp_path / "bag")
    storage = next(bag.glob("*.mcap"))
    storage.write_bytes(storage.read_bytes()[:5000])
    errors = refuse(demo, "--bag", bag)
    assert "BAD_FILE" in errors
    assert storage.name in errors


def test_a_bag_without_clouds_lists_what_it_has(demo, tmp_path):
    errors = refuse(demo, "--bag", write_chatter_bag(tmp_path / "bag"))
    assert "/chatter (std_msgs/msg/String, 1 messages)" in errors


def test_a_topic_that_is_not_there_lists_what_is(demo):
    errors = refuse(demo, "--bag", OWN_BAG, "--topic", "/cloud")
    assert "/points (sensor_msgs/msg/PointCloud2, 3 messages)" in errors


def test_an_unreadable_pcd_is_named_and_the_clouds_before_it_are_kept(demo, tmp_path):
    broken = tmp_path / "broken.pcd"
    broken.write_bytes(b"VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 4\nHEIGHT 1\nDATA binary\n\x00\x00")
    started = demo("--part", "replay", "--clouds", broken)
    code, _, errors = started.end(120)
    assert code == 2
    assert "broken.pcd" in errors
    assert "Traceback" not in errors
    assert started.summary["code_name"] == "BAD_FILE"


def test_an_unknown_policy_lists_the_known_ones(demo):
    errors = refuse(demo, "--policy", "wish")
    assert "wish" in errors
    assert "min_overlap" in errors


def test_an_output_folder_that_cannot_be_written(demo, tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    assert "cannot be written" in refuse(demo, out=blocked / "below")
    assert blocked.read_text() == "in the way"


def test_results_are_never_overwritten(demo, tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").write_text("keep")
    assert "is not empty" in refuse(demo, out=tmp_path / "mine")
    assert (tmp_path / "mine" / "notes.txt").read_text() == "keep"


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (("--min-gap", "nan"), "--min-gap"),
        (("--objects", "99"), "--objects"),
        (("--speed", "0"), "--speed"),
        (("--max-pushes", "-1"), "--max-pushes"),
        (("--contact-mode", "kick"), "two_point"),
    ],
)
def test_senseless_numbers_name_the_option(demo, arguments, text):
    assert text in refuse(demo, *arguments)


def test_a_second_demo_is_refused_while_one_runs(demo, tmp_path):
    first = demo("--part", "replay")
    first.wait_for_line("recorded clouds")
    errors = refuse(demo, "--part", "replay")
    assert f"process {first.process.pid}" in errors
    assert first.end()[0] == 0
    assert demo("--part", "replay").end()[0] == 0


def test_all_invalid_points_do_not_end_anything(demo, tmp_path):
    cloud = np.full((30, 40, 3), np.nan, dtype=np.float32)
    started = demo("--part", "replay", "--bag", write_bag(tmp_path / "bag", [cloud]))
    code, _, errors = started.end()
    assert code == 0, errors
    assert started.summary["frames"][0]["code_name"] == "NO_POINTS"
