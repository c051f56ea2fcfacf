import sys
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from std_msgs.msg import Header

from singulation_core import ResultCode, SingulationError
from singulation_core.transforms import pose_matrix
from singulation_perception.camera_pose import CameraPose
from singulation_perception.perception_settings import PerceptionSettings

HEADER = Header(stamp=Time(sec=12, nanosec=34), frame_id="camera")
FROM_TF = PerceptionSettings(camera_pose_source="tf", table_frame="desk")
HALF = 0.5**0.5


class FakeBuffer:
    """Stands in for tf2_ros.Buffer, which PyPI does not have: knows one transform."""

    quaternion = (0.0, 0.0, HALF, HALF)
    error = None
    asked: tuple = ()

    def lookup_transform(self, target, source, time, timeout):
        FakeBuffer.asked = (target, source, time.nanoseconds, timeout.nanoseconds)
        if FakeBuffer.error:
            raise FakeBuffer.error
        x, y, z, w = FakeBuffer.quaternion
        rotation = SimpleNamespace(x=x, y=y, z=z, w=w)
        return SimpleNamespace(
            transform=SimpleNamespace(translation=SimpleNamespace(x=1.0, y=2.0, z=3.0), rotation=rotation)
        )


class FakeListener:
    def __init__(self, buffer, node, spin_thread):
        self.open = True

    def unregister(self):
        self.open = False


@pytest.fixture
def tf(monkeypatch):
    module = ModuleType("tf2_ros")
    module.Buffer, module.TransformListener = FakeBuffer, FakeListener
    monkeypatch.setitem(sys.modules, "tf2_ros", module)
    monkeypatch.setattr(FakeBuffer, "error", None)
    monkeypatch.setattr(FakeBuffer, "quaternion", (0.0, 0.0, HALF, HALF))


def test_from_parameters_and_from_the_plane_tf_is_not_needed():
    camera = CameraPose(node=None)
    settings = PerceptionSettings(camera_position=(0.0, 0.1, 0.8), camera_quaternion=(1.0, 0.0, 0.0, 0.0))
    expected = pose_matrix((0.0, 0.1, 0.8), (1.0, 0.0, 0.0, 0.0))
    np.testing.assert_array_equal(camera.lookup(settings, HEADER), expected)
    assert camera.lookup(PerceptionSettings(camera_pose_source="plane_fit"), HEADER) is None
    camera.close()


def test_from_tf_at_the_stamp_of_the_cloud(tf):
    camera = CameraPose(node=None)
    camera.prepare("tf")
    np.testing.assert_allclose(camera.lookup(FROM_TF, HEADER), pose_matrix((1, 2, 3), (0, 0, HALF, HALF)))
    assert FakeBuffer.asked == ("desk", "camera", 12 * 10**9 + 34, 200_000_000)


@pytest.mark.parametrize("error", [LookupError("no such frame"), None], ids=["unknown", "no unit quaternion"])
def test_what_tf_cannot_say_is_no_transform_and_the_next_cloud_may_work(tf, error):
    camera = CameraPose(node=None)
    FakeBuffer.error = error
    if error is None:
        FakeBuffer.quaternion = (0.0, 0.0, 0.0, 2.0)
    with pytest.raises(SingulationError, match="from 'camera' to 'desk'") as caught:
        camera.lookup(FROM_TF, HEADER)
    assert caught.value.code == ResultCode.NO_TRANSFORM
    FakeBuffer.error, FakeBuffer.quaternion = None, (0.0, 0.0, 0.0, 1.0)
    assert camera.lookup(FROM_TF, HEADER).shape == (4, 4)


def test_without_tf2_ros_the_node_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "tf2_ros", None)
    with pytest.raises(SingulationError, match="ros-jazzy-tf2-ros-py") as caught:
        CameraPose(node=None).prepare("tf")
    assert caught.value.code == ResultCode.NO_TRANSFORM
    CameraPose(node=None).prepare("parameters")


def test_closing_stops_the_listener(tf):
    camera = CameraPose(node=None)
    camera.prepare("tf")
    listener = camera._listener
    camera.prepare("tf")
    assert camera._listener is listener
    camera.close()
    assert not listener.open
