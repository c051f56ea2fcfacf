"""The only border between messages and the libraries: ``x_to_msg`` and ``x_from_msg``.

What comes in is validated here and refused with a coded error; what goes out is built new, never aliased.
"""

import array
import math
from typing import Any

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point, Point32, Polygon
from numpy.typing import NDArray
from sensor_msgs.msg import PointCloud2, PointField
from singulation_msgs import msg as messages
from std_msgs.msg import Header

from singulation_core.arrangement import Arrangement
from singulation_core.contact_mode import ContactMode, contact_mode
from singulation_core.errors import InvalidInputError
from singulation_core.planar_object import PlanarObject
from singulation_core.polygon import FloatArray
from singulation_core.push import Push


def seconds_of(stamp: Any) -> float:
    """Seconds of a builtin_interfaces/Time (resolution about 0.2 microseconds for today's dates)."""
    return float(stamp.sec) + 1e-9 * float(stamp.nanosec)


def stamp_of(seconds: float) -> Any:
    """builtin_interfaces/Time of a time in seconds.

    Raises:
        InvalidInputError: negative, not finite, or beyond what the message holds.
    """
    if not (0.0 <= seconds < 2**31):
        raise InvalidInputError(f"stamp {seconds} s, need 0 <= stamp < 2**31")
    nanoseconds = round(seconds * 1e9)
    return Time(sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9)


def point_to_msg(point: FloatArray) -> Any:
    """geometry_msgs/Point of a (2,) or (3,) point [m]; z = 0 if it has none."""
    x, y, z = (*point.tolist(), 0.0) if len(point) == 2 else point.tolist()
    return Point(x=x, y=y, z=z)


def planar_point_from_msg(message: Any) -> FloatArray:
    """(2,) x, y of a geometry_msgs/Point [m]."""
    return np.array((message.x, message.y))


def object_to_msg(item: PlanarObject) -> Any:
    """singulation_msgs/PlanarObject of an object."""
    corners = [Point32(x=x, y=y, z=0.0) for x, y in item.outline.tolist()]
    return messages.PlanarObject(
        id=item.id,
        outline=Polygon(points=corners),
        centroid=point_to_msg(item.centroid),
        bounding_radius=item.bounding_radius,
        height=float(item.height),
        point_count=item.point_count,
        confidence=float(item.confidence),
    )


def object_from_msg(message: Any) -> PlanarObject:
    """Object of a singulation_msgs/PlanarObject; centroid and radius are derived from the outline anew.

    Raises:
        InvalidInputError: an outline that is not convex, counter-clockwise and finite; the text names the object.
    """
    corners = [(point.x, point.y) for point in message.outline.points]
    # Vertices closer than float32 can tell apart arrive as one point twice.
    if len(corners) > 3:
        corners = [corner for corner, last in zip(corners, corners[-1:] + corners[:-1], strict=True) if corner != last]
    outline = np.array(corners, dtype=np.float64).reshape(-1, 2)
    return PlanarObject(
        int(message.id), outline, float(message.height), int(message.point_count), float(message.confidence)
    )


def arrangement_to_msg(arrangement: Arrangement, stamp: Any | None = None) -> Any:
    """singulation_msgs/Arrangement; ``stamp`` (builtin_interfaces/Time) keeps nanoseconds that a float cannot."""
    header = Header(stamp=stamp_of(arrangement.stamp) if stamp is None else stamp, frame_id=arrangement.frame)
    return messages.Arrangement(header=header, objects=[object_to_msg(item) for item in arrangement.objects])


def arrangement_from_msg(message: Any) -> Arrangement:
    """Arrangement of a singulation_msgs/Arrangement.

    Raises:
        InvalidInputError: an object that is malformed, or two with one id.
    """
    objects = [object_from_msg(item) for item in message.objects]
    return Arrangement(objects, message.header.frame_id, seconds_of(message.header.stamp))


def contact_mode_to_msg(mode: ContactMode) -> Any:
    """singulation_msgs/ContactMode."""
    return messages.ContactMode(value=int(mode))


def contact_mode_from_msg(message: Any) -> ContactMode:
    """Contact mode of a singulation_msgs/ContactMode.

    Raises:
        SingulationError: ``UNKNOWN_CONTACT_MODE``.
    """
    return contact_mode(int(message.value))


def push_to_msg(push: Push, header: Any) -> Any:
    """singulation_msgs/PushTrajectory; ``header`` is that of the arrangement it was planned on."""
    return messages.PushTrajectory(
        header=Header(stamp=header.stamp, frame_id=header.frame_id),
        contact_mode=contact_mode_to_msg(push.contact_mode),
        start=point_to_msg(push.start),
        end=point_to_msg(push.end),
        contact_width=float(push.contact_width),
        target_id=0 if push.target_id is None else push.target_id,
        policy=push.policy,
        expected_gain=float(push.expected_gain),
    )


def push_from_msg(message: Any) -> Push:
    """Push of a singulation_msgs/PushTrajectory.

    Raises:
        SingulationError: ``UNKNOWN_CONTACT_MODE``; or ``INVALID_INPUT`` for a push without length, with numbers that
            are not finite, off the table plane, or with a contact width that does not fit its mode.
    """
    for name, point in (("start", message.start), ("end", message.end)):
        if not (abs(point.z) <= 1e-6):
            raise InvalidInputError(f"push: {name}.z is {point.z} m, a push lies in the table plane (0)")
    return Push(
        planar_point_from_msg(message.start),
        planar_point_from_msg(message.end),
        contact_mode_from_msg(message.contact_mode),
        float(message.contact_width),
        int(message.target_id),
        message.policy,
        float(message.expected_gain) if math.isfinite(message.expected_gain) else math.nan,
    )


def cloud_to_msg(points: NDArray[np.float32], header: Any) -> Any:
    """Organized sensor_msgs/PointCloud2 with fields x, y, z of (H, W, 3) float32 points [m]; one copy of the data."""
    height, width, _ = points.shape
    data = array.array("B")
    data.frombytes(np.ascontiguousarray(points, dtype="<f4").reshape(-1).view(np.uint8).data)
    fields = [
        PointField(name=name, offset=4 * index, datatype=PointField.FLOAT32, count=1)
        for index, name in enumerate("xyz")
    ]
    return PointCloud2(
        header=header,
        height=height,
        width=width,
        fields=fields,
        is_bigendian=False,
        point_step=12,
        row_step=12 * width,
        data=data,
        is_dense=False,
    )
