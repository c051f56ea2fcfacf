"""Pose of the camera over the table at the time of a cloud: from parameters, TF, or left to the plane fit."""

from typing import Any

from singulation_core import ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from singulation_core.transforms import pose_matrix
from singulation_perception.perception_settings import FROM_PARAMETERS, FROM_TF, PerceptionSettings


class CameraPose:
    """Gives ``table_from_camera`` for each cloud; listens to TF only from the moment it is asked to.

    Args:
        node: whose clock, logger and subscriptions TF uses.
    """

    def __init__(self, node: Any) -> None:
        self._node = node
        self._buffer: Any = None
        self._listener: Any = None

    def prepare(self, source: str) -> None:
        """Begin to listen if ``source`` needs TF.

        Raises:
            SingulationError: ``NO_TRANSFORM``: tf2_ros is not installed.
        """
        if source != FROM_TF or self._buffer is not None:
            return
        try:
            from tf2_ros import Buffer, TransformListener  # noqa: PLC0415  # not to be had from PyPI
        except ImportError as error:
            raise SingulationError(
                ResultCode.NO_TRANSFORM,
                f"camera_pose_source is tf, but tf2_ros cannot be imported ({error}); install ros-jazzy-tf2-ros-py "
                "or use camera_pose_source parameters",
            ) from None
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self._node, spin_thread=False)

    def close(self) -> None:
        """Stop listening."""
        if self._listener is not None:
            self._listener.unregister()
        self._buffer = self._listener = None

    def lookup(self, settings: PerceptionSettings, header: Any) -> FloatArray | None:
        """4x4 ``table_from_camera`` at the stamp of the cloud; None leaves it to the plane fit.

        Raises:
            SingulationError: ``NO_TRANSFORM`` with what TF says.
        """
        if settings.camera_pose_source == FROM_PARAMETERS:
            return settings.camera_pose
        if settings.camera_pose_source == FROM_TF:
            self.prepare(FROM_TF)
            return self._from_tf(settings, header)
        return None

    def _from_tf(self, settings: PerceptionSettings, header: Any) -> FloatArray:
        from rclpy.duration import Duration  # noqa: PLC0415
        from rclpy.time import Time  # noqa: PLC0415

        try:
            found = self._buffer.lookup_transform(
                settings.table_frame,
                header.frame_id,
                Time.from_msg(header.stamp),
                timeout=Duration(seconds=settings.tf_timeout),
            ).transform
            shift, turn = found.translation, found.rotation
            return pose_matrix((shift.x, shift.y, shift.z), (turn.x, turn.y, turn.z, turn.w))
        except Exception as error:  # tf2 has several, and its base class is not importable without it
            raise SingulationError(
                ResultCode.NO_TRANSFORM, f"from {header.frame_id!r} to {settings.table_frame!r}: {error}"
            ) from None
