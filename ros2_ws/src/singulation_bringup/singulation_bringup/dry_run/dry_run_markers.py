"""visualization_msgs of a motion that is only shown."""

from typing import Any

import numpy as np
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

from singulation_bringup.dry_run.motion_report import PhaseReport

_LINE = 0.002  # m
# Colours that stay apart for colour-blind eyes (Okabe and Ito).
_COLOURS = {
    "APPROACH": (0.34, 0.71, 0.91),
    "DESCEND": (0.0, 0.45, 0.70),
    "PUSH": (0.84, 0.37, 0.0),
    "RETREAT": (0.0, 0.62, 0.45),
    "CLEAR_VIEW": (0.80, 0.47, 0.65),
}


def motion_markers(phases: list[PhaseReport], title: str, header: Any) -> Any:
    """The way of the tips, one colour for each phase; replaces what was shown before."""
    markers = [Marker(header=header, action=Marker.DELETEALL)]
    shown = [one for one in phases if len(one.path)]
    markers += [_line(header, number, one) for number, one in enumerate(shown)]
    if shown:
        markers.append(_title(header, title, shown[0].path[0]))
    return MarkerArray(markers=markers)


def no_markers(header: Any) -> Any:
    """Nothing is shown any more."""
    return MarkerArray(markers=[Marker(header=header, action=Marker.DELETEALL)])


def table_header(frame: str, stamp: Any) -> Any:
    """Header of markers in the frame of the table."""
    return Header(stamp=stamp, frame_id=frame)


def _line(header: Any, number: int, phase: PhaseReport) -> Any:
    red, green, blue = _COLOURS.get(phase.phase, (0.5, 0.5, 0.5))
    return Marker(
        header=header,
        ns="dry_run",
        id=number,
        type=Marker.LINE_STRIP,
        action=Marker.ADD,
        scale=Vector3(x=_LINE, y=0.0, z=0.0),
        color=ColorRGBA(r=red, g=green, b=blue, a=1.0),
        points=[_point(one) for one in phase.path],
        pose=Pose(orientation=Quaternion(w=1.0)),
    )


def _title(header: Any, text: str, place: Any) -> Any:
    return Marker(
        header=header,
        ns="dry_run_title",
        type=Marker.TEXT_VIEW_FACING,
        action=Marker.ADD,
        scale=Vector3(x=0.0, y=0.0, z=0.02),
        color=ColorRGBA(r=1.0, g=1.0, b=1.0, a=1.0),
        text=text,
        pose=Pose(position=_point(np.asarray(place) + (0.0, 0.0, 0.03)), orientation=Quaternion(w=1.0)),
    )


def _point(values: Any) -> Any:
    x, y, z = (float(value) for value in values)
    return Point(x=x, y=y, z=z)
