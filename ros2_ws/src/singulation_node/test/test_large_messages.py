import fcntl
import os
import subprocess
import sys
from xml.etree import ElementTree

import pytest

from singulation_node import large_messages
from singulation_node.large_messages import (
    PROFILE,
    PROFILE_VARIABLE,
    prepare_for_large_messages,
    remove_abandoned_segments,
    segment_size,
)

LARGEST_CLOUD = 2064 * 1544 * 16  # bytes: full PhoXi image with colours
FRAGMENT = 65_000  # bytes, a little less than what a UDP packet holds


def test_the_largest_cloud_fits_into_segment_and_queue():
    root = ElementTree.parse(PROFILE).getroot()
    queue = int(root.find(".//{*}port_queue_capacity").text)
    assert segment_size() > 1.5 * LARGEST_CLOUD
    assert queue > 2 * LARGEST_CLOUD / FRAGMENT


@pytest.fixture
def plenty(monkeypatch):
    monkeypatch.delenv(PROFILE_VARIABLE, raising=False)
    monkeypatch.setattr(large_messages, "shared_memory_free", lambda: 10 * segment_size())


def test_the_profile_is_chosen(plenty, monkeypatch):
    monkeypatch.setenv(PROFILE_VARIABLE, "")
    assert prepare_for_large_messages()
    assert os.environ[PROFILE_VARIABLE] == str(PROFILE)


def test_the_users_own_profile_stays(plenty, monkeypatch):
    monkeypatch.setenv(PROFILE_VARIABLE, "/etc/my_profile.xml")
    assert prepare_for_large_messages()
    assert os.environ[PROFILE_VARIABLE] == "/etc/my_profile.xml"


@pytest.mark.parametrize(("inherited", "segments"), [(False, 5.9), (True, 0.9)])
def test_too_little_shared_memory_is_said_and_the_profile_is_not_used(plenty, monkeypatch, capsys, inherited, segments):
    monkeypatch.setenv(PROFILE_VARIABLE, str(PROFILE) if inherited else "")
    monkeypatch.setattr(large_messages, "shared_memory_free", lambda: int(segments * segment_size()))
    assert not prepare_for_large_messages()
    assert PROFILE_VARIABLE not in os.environ
    assert "--shm-size=1g" in capsys.readouterr().err


def test_a_child_needs_room_for_itself_only(plenty, monkeypatch):
    monkeypatch.setenv(PROFILE_VARIABLE, str(PROFILE))
    monkeypatch.setattr(large_messages, "shared_memory_free", lambda: int(1.1 * segment_size()))
    assert prepare_for_large_messages()


def test_only_segments_whose_owner_is_gone_are_removed(tmp_path, monkeypatch):
    monkeypatch.setattr(large_messages, "_SHARED_MEMORY", tmp_path)
    names = ("fastrtps_used", "fastrtps_left", "fastrtps_fresh")
    for name in names:
        (tmp_path / name).write_bytes(b"segment")
        (tmp_path / f"{name}_el").touch()
    for name in names[:2]:
        os.utime(tmp_path / f"{name}_el", (1.0, 1.0))
    (tmp_path / "somebody_elses_file").touch()
    with (tmp_path / "fastrtps_used_el").open() as owner:
        fcntl.flock(owner, fcntl.LOCK_EX)
        assert remove_abandoned_segments() == 1
    left = {path.name for path in tmp_path.iterdir()}
    assert "fastrtps_left" not in left
    assert {"fastrtps_used", "fastrtps_fresh", "somebody_elses_file"} < left


def test_what_killed_processes_left_makes_room(plenty, monkeypatch):
    rooms = iter((segment_size(), 6 * segment_size()))
    cleaned = []
    monkeypatch.setattr(large_messages, "shared_memory_free", lambda: next(rooms))
    monkeypatch.setattr(large_messages, "remove_abandoned_segments", lambda: cleaned.append(True))
    assert prepare_for_large_messages()
    assert cleaned


def test_fast_dds_takes_the_profile():
    """A process with it has a shared-memory segment of the wanted size."""
    program = """
import pathlib, rclpy
from singulation_node.large_messages import prepare_for_large_messages
memory = pathlib.Path("/dev/shm")
before = set(memory.iterdir())
prepare_for_large_messages()
rclpy.init()
node = rclpy.create_node("probe")
print(max(path.stat().st_size for path in memory.iterdir() if path not in before))
rclpy.try_shutdown()
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=True)
    assert int(done.stdout.split()[-1]) >= segment_size()
    assert "Error" not in done.stderr
