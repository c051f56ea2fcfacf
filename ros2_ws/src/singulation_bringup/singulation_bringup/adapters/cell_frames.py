"""Node: publishes on ``/tf_static`` where table and camera stand, for RViz and everything else that lives on TF.

It says the same as the parameters of the other nodes, because it reads the same file.
"""

import sys
from collections.abc import Sequence
from typing import Any

from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from std_msgs.msg import Header

from singulation_bringup.adapters.cell_frames_settings import CellFramesSettings
from singulation_bringup.adapters.driver_messages import driver_type
from singulation_node.main import run_node
from singulation_node.managed_node import ManagedNode
from singulation_node.qos import LATCHED


class CellFrames(ManagedNode[CellFramesSettings]):
    """See the module."""

    def __init__(self, **options: Any) -> None:
        super().__init__("cell_frames", CellFramesSettings, **options)

    def configure(self) -> None:
        """Find the message type and announce the topic.

        Raises:
            SingulationError: ``NOT_READY``: tf2_msgs is not installed.
        """
        self._type = driver_type("tf2_msgs", "msg", "TFMessage", "the package ros-jazzy-tf2-msgs")
        self._frames = self.create_publisher(self._type, "/tf_static", LATCHED)

    def activate(self) -> None:
        """Publish once; who comes later gets it, too."""
        self._frames.publish(self._type(transforms=self.transforms()))

    def transforms(self) -> list[Any]:
        """Table in the body, camera in the table (geometry_msgs/TransformStamped)."""
        settings, stamp = self.settings, self.get_clock().now().to_msg()
        places = (
            (settings.body_frame, settings.table_frame, settings.table_position, settings.table_quaternion),
            (settings.table_frame, settings.camera_frame, settings.camera_position, settings.camera_quaternion),
        )
        return [
            TransformStamped(
                header=Header(stamp=stamp, frame_id=parent),
                child_frame_id=child,
                transform=Transform(
                    translation=Vector3(**dict(zip("xyz", position, strict=True))),
                    rotation=Quaternion(**dict(zip("xyzw", quaternion, strict=True))),
                ),
            )
            for parent, child, position, quaternion in places
        ]


def main(args: Sequence[str] | None = None) -> int:
    """Entry point."""
    return run_node(CellFrames, args)


if __name__ == "__main__":
    sys.exit(main())
