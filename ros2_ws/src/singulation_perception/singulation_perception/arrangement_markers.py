"""visualization_msgs of an arrangement: outlines and numbers, for RViz."""

from typing import Any

from geometry_msgs.msg import Point
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

from singulation_core import Arrangement, PlanarObject

_LINE_WIDTH = 0.0015  # m
_TEXT_HEIGHT = 0.012  # m
_SURE, _DOUBTFUL = (0.1, 0.85, 0.3), (1.0, 0.65, 0.0)
_DOUBT = 0.7  # an object of less confidence is drawn in the other colour


def arrangement_markers(arrangement: Arrangement, header: Header) -> MarkerArray:
    """A closed outline at the height of the top face and the id of each object; replaces what was shown before."""
    markers = [Marker(header=header, action=Marker.DELETEALL)]
    for item in arrangement.objects:
        markers += [_outline(item, header), _number(item, header)]
    return MarkerArray(markers=markers)


def _outline(item: PlanarObject, header: Header) -> Any:
    marker = Marker(header=header, ns="outline", id=item.id % 2**31, type=Marker.LINE_STRIP, action=Marker.ADD)
    marker.scale.x = _LINE_WIDTH
    marker.color = _colour(item)
    marker.pose.orientation.w = 1.0
    closed = (*item.outline, item.outline[0])
    marker.points = [Point(x=float(x), y=float(y), z=float(item.height)) for x, y in closed]
    return marker


def _number(item: PlanarObject, header: Header) -> Any:
    marker = Marker(header=header, ns="id", id=item.id % 2**31, type=Marker.TEXT_VIEW_FACING, action=Marker.ADD)
    marker.scale.z = _TEXT_HEIGHT
    marker.color = _colour(item)
    marker.pose.orientation.w = 1.0
    x, y = item.centroid
    marker.pose.position = Point(x=float(x), y=float(y), z=float(item.height) + _TEXT_HEIGHT)
    marker.text = str(item.id)
    return marker


def _colour(item: PlanarObject) -> ColorRGBA:
    red, green, blue = _DOUBTFUL if item.confidence < _DOUBT else _SURE
    return ColorRGBA(r=red, g=green, b=blue, a=1.0)
