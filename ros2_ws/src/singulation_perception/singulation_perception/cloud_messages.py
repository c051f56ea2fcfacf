"""Border between sensor_msgs/PointCloud2 and the library."""

from array import array
from typing import Any

from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Header

from singulation_perception.clouds import CloudData, CloudField, CloudLayout
from singulation_perception.decoding import Float32Array, decode_points


def points_from_msg(message: Any) -> Float32Array:
    """Points of a PointCloud2, a view of its data where that is possible; see ``decode_points``.

    Raises:
        SingulationError: ``NO_POINTS``, ``BAD_LAYOUT``.
    """
    return decode_points(message.data, layout_from_msg(message))


def layout_from_msg(message: Any) -> CloudLayout:
    """Layout of a PointCloud2, unchecked."""
    fields = tuple(CloudField(one.name, one.offset, one.datatype, one.count) for one in message.fields)
    return CloudLayout(
        message.height, message.width, message.point_step, message.row_step, fields, bool(message.is_bigendian)
    )


def cloud_message(data: CloudData, layout: CloudLayout, header: Header) -> PointCloud2:
    """PointCloud2 of bytes and their layout; one copy unless ``data`` is an ``array('B')`` already."""
    if not isinstance(data, array):
        source, data = memoryview(data), array("B")
        data.frombytes(source)
    fields = [
        PointField(name=one.name, offset=one.offset, datatype=int(one.datatype), count=one.count)
        for one in layout.fields
    ]
    return PointCloud2(
        header=header,
        height=layout.height,
        width=layout.width,
        fields=fields,
        is_bigendian=layout.is_bigendian,
        point_step=layout.point_step,
        row_step=layout.row_step,
        data=data,
        is_dense=False,
    )
