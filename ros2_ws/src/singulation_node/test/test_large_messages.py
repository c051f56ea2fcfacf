import os
import subprocess
import sys
from xml.etree import ElementTree

import pytest

from singulation_node import large_messages
from singulation_node.large_messages import PROFILE, PROFILE_VARIABLE, prepare_for_large_messages, segment_size

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
