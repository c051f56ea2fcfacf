"""Lifecycle node: ``points`` (sensor_msgs/PointCloud2) in, ``objects`` (singulation_msgs/Arrangement) out.

Every cloud ends in exactly one of: published, rejected with a code, superseded by a newer one. A rejected cloud
publishes nothing on ``objects``, because "could not see" is not "nothing is there"; the diagnostics say why.
"""

import sys
import time
import traceback
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from singulation_node.large_messages import prepare_for_large_messages  # before ROS: keeps memory

# isort: split
from rclpy.event_handler import SubscriptionEventCallbacks
from sensor_msgs.msg import PointCloud2
from singulation_msgs.msg import Arrangement
from std_msgs.msg import Header
from visualization_msgs.msg import MarkerArray

from singulation_core import ResultCode, SingulationError
from singulation_core.conversions import arrangement_to_msg
from singulation_node.guard import guarded
from singulation_node.main import run_node
from singulation_node.managed_node import ManagedNode
from singulation_node.qos import SENSOR_IN, STATE
from singulation_node.warming import warm
from singulation_perception import Segmentation, TablePlane, segment_cloud, warm_up
from singulation_perception.arrangement_markers import arrangement_markers
from singulation_perception.camera_pose import CameraPose
from singulation_perception.cloud_messages import cloud_message, points_from_msg
from singulation_perception.encoding import encode_coloured
from singulation_perception.frame_ledger import FrameLedger
from singulation_perception.latest_worker import LatestWorker
from singulation_perception.perception_diagnostics import first_words, report_clouds, report_table
from singulation_perception.perception_settings import PerceptionSettings
from singulation_perception.stamp_order import StampOrder

_REPORT_PERIOD = 1.0  # s
_STOP_TIMEOUT = 10.0  # s; the largest accepted cloud takes far less
_LOG_PERIOD = 5.0  # s between log lines about rejected clouds


@dataclass(slots=True)
class _Stream:
    """What is remembered from cloud to cloud, forgotten when the node is activated or the camera pose changes."""

    stamps: StampOrder
    camera: tuple[Any, ...] = ()
    table: TablePlane | None = None
    began: bool = False


class PerceptionNode(ManagedNode[PerceptionSettings]):
    """Segments the newest cloud; see the module."""

    def __init__(self, **options: Any) -> None:
        super().__init__("perception_node", PerceptionSettings, **options)
        self.ledger = FrameLedger()
        self._camera = CameraPose(self)
        self._stream = _Stream(StampOrder())
        self._worker: LatestWorker[Any] | None = None

    def configure(self) -> None:
        """Compile the library, listen to TF if needed, announce the results."""
        self._camera.prepare(self.settings.camera_pose_source)
        warm(self, warm_up, "up to a minute", "singulation_perception.warming")
        self._objects = self.create_publisher(Arrangement, "objects", STATE)
        self._markers = self.create_publisher(MarkerArray, "perception/markers", STATE)
        self._labels = self.create_publisher(PointCloud2, "perception/labels", 1)

    def activate(self) -> None:
        """Begin to take clouds."""
        self._stream = _Stream(StampOrder())
        self._worker = LatestWorker(self._process, lambda _: self.ledger.superseded(), "segmentation")
        events = SubscriptionEventCallbacks(message_lost=self._note_loss)
        self._points = self.create_subscription(PointCloud2, "points", self._take, SENSOR_IN, event_callbacks=events)
        self.create_timer(_REPORT_PERIOD, self._report)

    def deactivate(self) -> None:
        """Finish the present cloud, give up the waiting one.

        Raises:
            SingulationError: ``TIMEOUT``: the present cloud takes too long.
        """
        worker, self._worker = self._worker, None
        if worker is not None and not worker.stop(_STOP_TIMEOUT):
            raise SingulationError(ResultCode.TIMEOUT, f"a cloud is in work for more than {_STOP_TIMEOUT} s")
        self._report()

    def cleanup(self) -> None:
        """Stop listening to TF."""
        self._camera.close()

    def destroy_node(self) -> None:
        """End the worker too: its thread would keep an active node, and its place in the ROS domain, for ever."""
        worker, self._worker = self._worker, None
        if worker is not None:
            worker.stop(_STOP_TIMEOUT)
        super().destroy_node()

    @guarded
    def _take(self, message: PointCloud2) -> None:
        self.ledger.received(time.monotonic())
        worker = self._worker
        if worker is None:
            self.ledger.superseded()
        else:
            worker.offer(message)

    @guarded
    def _note_loss(self, event: Any) -> None:
        self.ledger.lost(event.total_count, time.monotonic())

    def _process(self, message: PointCloud2) -> None:
        """One cloud, one outcome. Runs in the worker's thread."""
        try:
            settings = self.settings
            started = time.perf_counter()
            result = self._segment(message, settings)
            segmented = time.perf_counter()
            self._publish(message, result, settings)
            published = time.perf_counter()
        except SingulationError as error:
            self._reject(error.code, error.message)
        except Exception as error:
            self._reject(ResultCode.INTERNAL, "".join(traceback.format_exception(error)))
        else:
            whole = {"segment": 1e3 * (segmented - started), "publish": 1e3 * (published - segmented)}
            self.ledger.published(self._age(message), {**result.milliseconds, **whole})
            self._tell(message, result, settings)

    def _segment(self, message: PointCloud2, settings: PerceptionSettings) -> Segmentation:
        stream, stamp = self._stream, message.header.stamp
        stream.stamps.check(
            stamp.sec * 1_000_000_000 + stamp.nanosec,
            self.get_clock().now().nanoseconds,
            settings.max_future,
            settings.max_age if settings.check_age else None,
        )
        points = points_from_msg(message)
        camera = (settings.camera_pose_source, settings.camera_position, settings.camera_quaternion)
        if stream.camera != camera:
            stream.camera, stream.table = camera, None
        parameters = settings.segmentation(self._camera.lookup(settings, message.header))
        try:
            result = segment_cloud(points, parameters, stream.table)
        except SingulationError:
            stream.table = None  # what was true of the last cloud need not be true of the next
            raise
        stream.table = result.table
        return result

    def _publish(self, message: PointCloud2, result: Segmentation, settings: PerceptionSettings) -> None:
        arrangement = arrangement_to_msg(result.arrangement, message.header.stamp)
        arrangement.header.frame_id = settings.table_frame
        self._objects.publish(arrangement)
        if self._markers.get_subscription_count() > 0:
            self._markers.publish(arrangement_markers(result.arrangement, arrangement.header))
        if self._labels.get_subscription_count() > 0:
            layout, data = encode_coloured(points_from_msg(message), result.labels)
            header = Header(stamp=message.header.stamp, frame_id=message.header.frame_id)
            self._labels.publish(cloud_message(data, layout, header))

    @guarded
    def _tell(self, message: PointCloud2, result: Segmentation, settings: PerceptionSettings) -> None:
        report_table(self.diagnostics, result)
        if not self._stream.began:
            self._stream.began = True
            self.get_logger().info(first_words(message, result, settings.table_frame))

    def _reject(self, code: ResultCode, text: str) -> None:
        self.ledger.rejected(code, text)
        self.get_logger().warning(
            f"cloud rejected: {code.name} ({int(code)}): {text}", throttle_duration_sec=_LOG_PERIOD
        )

    def _age(self, message: PointCloud2) -> float:
        stamp = message.header.stamp
        return 1e-9 * (self.get_clock().now().nanoseconds - stamp.sec * 1_000_000_000 - stamp.nanosec)

    @guarded
    def _report(self) -> None:
        state = self.ledger.state(time.monotonic())
        report_clouds(self.diagnostics, state, self.settings, self._points.get_publisher_count())


def main(args: Sequence[str] | None = None) -> int:
    """Entry point."""
    prepare_for_large_messages()
    return run_node(PerceptionNode, args)


if __name__ == "__main__":
    sys.exit(main())
