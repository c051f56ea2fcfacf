import fcntl
import os
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from singulation_node import large_messages
from singulation_node.domain import reserved_domain
from singulation_node.large_messages import (
    PROFILE,
    PROFILE_VARIABLE,
    prepare_for_large_messages,
    remove_abandoned,
    segment_size,
)

SHARED_MEMORY = Path("/dev/shm")
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


def test_only_what_has_no_owner_is_removed(tmp_path, monkeypatch):
    monkeypatch.setattr(large_messages, "_SHARED_MEMORY", tmp_path)
    for name in ("fastrtps_used", "fastrtps_left", "fastrtps_fresh", "fastrtps_port7661", "fastrtps_port7663"):
        (tmp_path / name).write_bytes(b"memory")
        if "port" not in name:  # such a queue was closed by its owner, but somebody else still had it open
            (tmp_path / f"{name}_el").touch()
    for name in ("fastrtps_used_el", "fastrtps_left_el", "fastrtps_port7661"):
        os.utime(tmp_path / name, (1.0, 1.0))
    (tmp_path / "somebody_elses_file").touch()
    with (tmp_path / "fastrtps_used_el").open() as owner:
        fcntl.flock(owner, fcntl.LOCK_EX)
        assert remove_abandoned() == 2
    left = {path.name for path in tmp_path.iterdir() if not path.name.endswith("_el")}
    assert left == {"fastrtps_used", "fastrtps_fresh", "fastrtps_port7663", "somebody_elses_file"}


def test_what_killed_processes_left_makes_room(plenty, monkeypatch):
    cleaned = []
    monkeypatch.setattr(large_messages, "shared_memory_free", lambda: (6 if cleaned else 1) * segment_size())
    monkeypatch.setattr(large_messages, "remove_abandoned", lambda: cleaned.append(True))
    assert prepare_for_large_messages()


def test_fast_dds_takes_the_profile():
    """A process with it has a shared-memory segment of the wanted size."""
    program = """
import rclpy, sys
from singulation_node.large_messages import prepare_for_large_messages
prepare_for_large_messages()
rclpy.init()
node = rclpy.create_node("probe")
print("ready", flush=True)
sys.stdin.readline()
rclpy.try_shutdown()
"""
    pipe = subprocess.PIPE
    with reserved_domain() as domain:  # in a shared one it would open what others have, and may remove
        command, environment = [sys.executable, "-c", program], {**os.environ, "ROS_DOMAIN_ID": str(domain)}
        with subprocess.Popen(command, env=environment, stdin=pipe, stdout=pipe, stderr=pipe, text=True) as process:
            assert process.stdout.readline() == "ready\n"
            largest = max(path.stat().st_size for path in opened_by(process))
            _, errors = process.communicate("", timeout=60)
    assert largest >= segment_size()
    assert "Error" not in errors


def opened_by(process):
    """Shared memory of Fast DDS that a process has opened; that of other tests is beside it."""
    words = Path(f"/proc/{process.pid}/maps").read_text().split()
    return {Path(word) for word in words if word.startswith(f"{SHARED_MEMORY}/fastrtps_")}


def test_small_queues_that_were_left_behind_are_made_anew():
    """Whoever got such a queue lost a cloud each time it was slow."""
    program = """
import pathlib, rclpy, sys
from singulation_node.large_messages import prepare_for_large_messages
if sys.argv[1] == "prepared":
    prepare_for_large_messages()
rclpy.init()
node = rclpy.create_node("probe")
print("ready", flush=True)
sys.stdin.readline()
"""

    def queues_beside(words):
        process = subprocess.Popen(
            [sys.executable, "-c", program, words], env=environment, stdin=pipe, stdout=pipe, text=True
        )
        assert process.stdout.readline() == "ready\n"
        return process, {path: path.stat().st_size for path in opened_by(process) if path.name in own}

    pipe = subprocess.PIPE
    with reserved_domain() as domain:
        lowest = 7400 + 250 * domain  # DDS-RTPS 9.6.1; others, from 7000 on, belong to whoever comes first
        own = {f"fastrtps_port{port}" for port in range(lowest, lowest + 250)}
        environment = {**os.environ, "ROS_DOMAIN_ID": str(domain)}
        environment.pop(PROFILE_VARIABLE, None)
        killed, small = queues_beside("as installed")
        killed.kill()
        killed.wait(timeout=30)
        for path in small:
            os.utime(path, (1.0, 1.0))
            path.with_name(f"{path.name}_el").unlink(missing_ok=True)  # the owner went, but a sender kept the queue
        prepared, sizes = queues_beside("prepared")
        prepared.communicate("", timeout=30)
    again = small.keys() & sizes.keys()
    assert again
    assert all(sizes[path] > small[path] for path in again)
