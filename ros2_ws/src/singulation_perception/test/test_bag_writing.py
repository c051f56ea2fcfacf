import json
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.serialization import deserialize_message
from rosbags.rosbag2 import Reader
from sensor_msgs.msg import JointState
from singulation_msgs.msg import Arrangement, PlanarObject, PushOutcome, PushTrajectory
from std_msgs.msg import Header, String

from singulation_core import InvalidInputError, ResultCode, SingulationError
from singulation_perception.bag_types import register_type, typestore
from singulation_perception.bag_writing import BagRecorder, type_name


def content(bag):
    """(topic, type, time, serialized message) of every message of a bag."""
    with Reader(bag) as reader:
        return [(one.topic, one.msgtype, time, bytes(raw)) for one, time, raw in reader.messages()]


def outcome():
    block = PlanarObject(id=7, bounding_radius=0.03, confidence=0.5)
    arrangement = Arrangement(header=Header(frame_id="table"), objects=[block, block])
    return PushOutcome(message="moved", before=arrangement, push=PushTrajectory(policy="cluster_push", target_id=7))


MESSAGES = {
    "/outcomes": outcome(),
    "/joint_states": JointState(name=["a", "b"], position=[1.0, -2.5]),
    "/diagnostics": DiagnosticArray(
        status=[DiagnosticStatus(level=b"\x02", name="n", values=[KeyValue(key="k", value="v")])]
    ),
}


def test_our_messages_and_ros_own_come_back_equal(tmp_path):
    with BagRecorder(tmp_path / "bag") as recorder:
        for time, (topic, message) in enumerate(MESSAGES.items(), start=1):
            recorder.write(topic, message, time)
    assert recorder.count == 3
    for topic, kind, time, raw in content(tmp_path / "bag"):
        message = MESSAGES[topic]
        assert kind == type_name(message)
        assert list(MESSAGES)[time - 1] == topic
        assert deserialize_message(raw, type(message)) == message


@pytest.mark.parametrize("name", ["PushOutcome", "Arrangement", "DriverState"])
def test_definitions_have_the_hash_that_rosidl_computed(name):
    register_type(f"singulation_msgs/msg/{name}")
    for prefix in os.environ["AMENT_PREFIX_PATH"].split(os.pathsep):
        description = Path(prefix) / "share" / "singulation_msgs" / "msg" / f"{name}.json"
        if description.is_file():
            break
    hashes = {one["type_name"]: one["hash_string"] for one in json.loads(description.read_text())["type_hashes"]}
    full = f"singulation_msgs/msg/{name}"
    assert typestore().hash_rihs01(full) == hashes[full]


def test_an_unknown_type_says_where_it_was_looked_for():
    with pytest.raises(InvalidInputError, match=r"no share/nowhere_msgs/msg/Nothing\.msg"):
        register_type("nowhere_msgs/msg/Nothing")
    register_type("singulation_msgs/msg/Arrangement")


def test_an_existing_folder_is_never_overwritten(tmp_path):
    (tmp_path / "bag").mkdir()
    with pytest.raises(SingulationError, match="exists already") as caught:
        BagRecorder(tmp_path / "bag")
    assert caught.value.code == ResultCode.BAD_FILE
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(SingulationError, match="cannot record there"):
        BagRecorder(tmp_path / "file" / "bag")
    BagRecorder(tmp_path / "other").close()


def test_a_topic_keeps_its_type(tmp_path):
    with BagRecorder(tmp_path / "bag") as recorder:
        recorder.write("/a", String(data="one"), 1)
        with pytest.raises(SingulationError, match=r"/a carries std_msgs/msg/String") as caught:
            recorder.write("/a", Header(), 2)
        assert caught.value.code == ResultCode.INVALID_INPUT
        recorder.write("/a", String(data="two"), 3)
    assert [time for _, _, time, _ in content(tmp_path / "bag")] == [1, 3]


def test_after_closing_nothing_is_taken_and_closing_again_is_harmless(tmp_path):
    recorder = BagRecorder(tmp_path / "bag")
    recorder.write("/a", String(), 1)
    recorder.close()
    recorder.close()
    with pytest.raises(SingulationError, match="closed") as caught:
        recorder.write("/a", String(), 2)
    assert caught.value.code == ResultCode.REJECTED
    assert len(content(tmp_path / "bag")) == 1


def test_an_error_in_the_block_leaves_a_complete_bag(tmp_path):
    with pytest.raises(ZeroDivisionError), BagRecorder(tmp_path / "bag") as recorder:
        recorder.write("/a", String(data="kept"), 1)
        raise ZeroDivisionError
    assert len(content(tmp_path / "bag")) == 1


def test_a_full_disk_is_reported_and_holds_nobody_up(tmp_path, monkeypatch):
    recorder = BagRecorder(tmp_path / "bag")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(recorder._tape.writer, "write", full)

    def flood():
        for time in range(100):
            recorder.write("/a", String(), time)

    with pytest.raises(SingulationError, match="No space left") as caught:
        flood()
    assert caught.value.code == ResultCode.BAD_FILE
    with pytest.raises(SingulationError, match="No space left"):
        recorder.close()
    with BagRecorder(tmp_path / "second") as good:
        good.write("/a", String(), 1)
    assert len(content(tmp_path / "second")) == 1


def test_several_threads_write_one_bag(tmp_path):
    with BagRecorder(tmp_path / "bag") as recorder:

        def write(name):
            for time in range(50):
                recorder.write(f"/{name}", String(data=name * 1000), time)

        threads = [threading.Thread(target=write, args=(name,)) for name in "abcd"]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(timeout=30)
    messages = content(tmp_path / "bag")
    assert len(messages) == 200
    assert {deserialize_message(raw, String).data for _, _, _, raw in messages} == {name * 1000 for name in "abcd"}


INTERRUPTED = """
import os, signal, sys
from std_msgs.msg import String
from singulation_perception.bag_writing import BagRecorder
recorder = BagRecorder(sys.argv[1])
for time in range(300):
    recorder.write("/a", String(data="x" * 20_000), time)
    if time == 200:
        {ending}
"""


@pytest.mark.parametrize(
    ("ending", "code"),
    [("os.kill(os.getpid(), signal.SIGINT)", -2), ("sys.exit(3)", 3), ("raise RuntimeError", 1)],
    ids=["ctrl-c", "exit", "error"],
)
def test_a_program_that_ends_without_closing_leaves_a_complete_bag(tmp_path, ending, code):
    program = INTERRUPTED.format(ending=ending).replace(
        "sys.argv[1])", f"__import__('pathlib').Path({str(tmp_path / 'bag')!r}))"
    )
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, timeout=60, check=False)
    assert ended.returncode == code, ended.stderr
    assert len(content(tmp_path / "bag")) == 201
