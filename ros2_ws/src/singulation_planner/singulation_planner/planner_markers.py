"""visualization_msgs of an arrangement and the push planned on it, for RViz."""

import math
from typing import Any

import numpy as np
from geometry_msgs.msg import Point
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

from singulation_core import Arrangement, ContactMode, PlanarObject, Push, PusherGeometry
from singulation_core.polygon import FloatArray
from singulation_planner.kernels.scoring import FIXED_DISC, cluster

_LINE = 0.0015  # m
_HEIGHT = 0.002  # m above the table, so that lines are not hidden by it
_CIRCLE = np.linspace(0.0, 2.0 * np.pi, 37)
# Colours that stay apart for colour-blind eyes (Okabe and Ito).
_CLUSTERS = ((0.0, 0.45, 0.70), (0.0, 0.62, 0.45), (0.80, 0.47, 0.65), (0.34, 0.71, 0.91), (0.94, 0.89, 0.26))
_TARGET, _PUSHER = (0.84, 0.37, 0.0), (0.90, 0.62, 0.0)


def planner_markers(arrangement: Arrangement, push: Push | None, pusher: PusherGeometry, header: Header) -> Any:
    """Outlines and bounding circles coloured by cluster, push object, arrow and jaws; replaces what was shown before.

    Clusters are those of ClusterPush around the push object.
    """
    markers = [Marker(header=header, action=Marker.DELETEALL)]
    target = None if push is None else push.target_id
    for item, colour in zip(arrangement.objects, _cluster_colours(arrangement, target), strict=True):
        is_target = item.id == target
        markers.append(
            _line(header, "outline", item.id, item.outline, _TARGET if is_target else colour, 2 if is_target else 1)
        )
        markers.append(
            _line(header, "bounding_circle", item.id, _circle(item.centroid, item.bounding_radius), colour, 0.5)
        )
        markers.append(_number(header, item, colour))
    if push is not None:
        markers.append(_arrow(header, push))
        for number, outline in enumerate(_jaws(push, pusher)):
            markers.append(_line(header, "contact", number, outline, _PUSHER, 1))
    return MarkerArray(markers=markers)


def _cluster_colours(arrangement: Arrangement, target: int | None) -> list[tuple[float, float, float]]:
    if target is None:
        return [_CLUSTERS[0]] * len(arrangement)
    seed = arrangement.index(target)
    labels = cluster(np.array(arrangement.centroids), np.array(arrangement.bounding_radii), seed, FIXED_DISC)
    return [_CLUSTERS[label % len(_CLUSTERS)] for label in labels.tolist()]


def _circle(centre: FloatArray, radius: float) -> FloatArray:
    return np.asarray(centre + radius * np.column_stack((np.cos(_CIRCLE), np.sin(_CIRCLE))))


def _jaws(push: Push, pusher: PusherGeometry) -> list[FloatArray]:
    """Footprint at the start: a disc, two discs, or a rectangle whose front lies on the start."""
    ahead = push.direction
    left = np.array((-ahead[1], ahead[0]))
    half = 0.5 * push.contact_width * left
    if push.contact_mode is ContactMode.EDGE:
        back = push.start - pusher.edge_thickness * ahead
        return [np.array((push.start + half, back + half, back - half, push.start - half))]
    centres = [push.start] if push.contact_mode is ContactMode.SINGLE_POINT else [push.start + half, push.start - half]
    return [_circle(centre, pusher.tip_radius) for centre in centres]


def _marker(header: Header, name: str, number: int, kind: int, colour: tuple[float, float, float]) -> Any:
    marker = Marker(header=header, ns=name, id=number % 2**31, type=kind, action=Marker.ADD)
    marker.color = ColorRGBA(r=colour[0], g=colour[1], b=colour[2], a=1.0)
    marker.pose.orientation.w = 1.0
    return marker


def _line(
    header: Header, name: str, number: int, points: FloatArray, colour: tuple[float, float, float], weight: float
) -> Any:
    marker = _marker(header, name, number, Marker.LINE_STRIP, colour)
    marker.scale.x = weight * _LINE
    marker.points = [Point(x=float(x), y=float(y), z=_HEIGHT) for x, y in (*points, points[0])]
    return marker


def _number(header: Header, item: PlanarObject, colour: tuple[float, float, float]) -> Any:
    marker = _marker(header, "id", item.id, Marker.TEXT_VIEW_FACING, colour)
    marker.scale.z = max(0.2 * item.bounding_radius, 0.004)
    marker.pose.position = Point(x=float(item.centroid[0]), y=float(item.centroid[1]), z=item.height + 0.01)
    marker.text = str(item.id)
    return marker


def _arrow(header: Header, push: Push) -> Any:
    marker = _marker(header, "push", 0, Marker.ARROW, _PUSHER)
    marker.points = [Point(x=float(x), y=float(y), z=_HEIGHT) for x, y in (push.start, push.end)]
    marker.scale.x, marker.scale.y, marker.scale.z = 2.0 * _LINE, 6.0 * _LINE, min(0.01, 0.4 * push.length)
    marker.text = push.policy if math.isnan(push.expected_gain) else f"{push.policy} {push.expected_gain:+.3f}"
    return marker
