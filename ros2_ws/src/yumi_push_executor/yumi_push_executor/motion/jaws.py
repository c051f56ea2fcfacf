"""How the jaws stand for a push: opening and the headings at which they touch as the contact mode asks."""

from dataclasses import replace

import numpy as np

from singulation_core import ContactMode, Push, PusherGeometry, ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from yumi_push_executor.motion.parameters import MAX_OPENING

_HEADINGS = 12  # for a single point: every 30 degrees


def opening(push: Push, pusher: PusherGeometry) -> float:
    """Distance between the jaws during the push [m].

    The contacts of a two-point push are the middles of the fingertips, as the push physics has them: between the jaws
    there is one finger's thickness less.

    Raises:
        SingulationError: ``CONTACT_WIDTH`` if the jaws are not that wide or do not open that far.
    """
    if push.contact_mode is ContactMode.EDGE and not (push.contact_width <= pusher.edge_width + 1e-6):
        raise SingulationError(
            ResultCode.CONTACT_WIDTH,
            f"edge push: contact width {push.contact_width * 1e3:.1f} mm, the closed jaws' side is "
            f"{pusher.edge_width * 1e3:.1f} mm wide",
        )
    if push.contact_mode is not ContactMode.TWO_POINT:
        return 0.0
    finger = 0.5 * pusher.edge_width
    if not (push.contact_width <= MAX_OPENING + finger + 1e-9):
        raise SingulationError(
            ResultCode.CONTACT_WIDTH,
            f"two-point push: contact width {push.contact_width * 1e3:.1f} mm, the middles of the opened fingers are "
            f"{(MAX_OPENING + finger) * 1e3:.1f} mm apart at most",
        )
    return max(push.contact_width - finger, 0.0)


def middle_line(push: Push, pusher: PusherGeometry) -> Push:
    """The way of the point midway between the tips.

    P and Q of an edge push are on the jaws' front side. Those of a two-point push are between two discs, as the planner
    and the push physics have the fingertips, which are flatter: their front goes where the front of the discs would be.
    """
    half = 0.5 * pusher.edge_thickness
    forward = {ContactMode.EDGE: -half, ContactMode.TWO_POINT: max(pusher.tip_radius - half, 0.0)}
    shift = forward.get(push.contact_mode, 0.0) * push.direction
    return replace(push, start=push.start + shift, end=push.end + shift)


def headings(push: Push) -> FloatArray:
    """Allowed angles of the jaws' closing direction about the table's normal, (k,) in ``table`` [rad].

    Edge and two points: perpendicular to the push, in two equivalent ways. Single point: all around.
    """
    along = float(np.arctan2(push.direction[1], push.direction[0]))
    if push.contact_mode is ContactMode.SINGLE_POINT:
        return np.asarray(along + np.arange(_HEADINGS) * (2.0 * np.pi / _HEADINGS))
    return np.asarray(along + np.array((0.5, -0.5)) * np.pi)


def tool_pose(body_from_table: FloatArray, point: FloatArray, height: float, heading: float, tip: float) -> FloatArray:
    """4x4 pose of ``tool0`` in ``yumi_body`` with the jaws straight down on the table.

    Args:
        body_from_table: 4x4.
        point: (2,) below the middle of the tips, in ``table`` [m].
        height: of the tips above the table [m].
        heading: of the closing direction (x of ``tool0``) in ``table`` [rad].
        tip: distance of the tips from ``tool0`` [m].
    """
    cosine, sine = np.cos(heading), np.sin(heading)
    pose = np.eye(4)
    pose[:3, 0] = (cosine, sine, 0.0)
    pose[:3, 1] = (sine, -cosine, 0.0)
    pose[:3, 2] = (0.0, 0.0, -1.0)
    pose[:3, 3] = (point[0], point[1], height + tip)
    return np.asarray(body_from_table @ pose)
