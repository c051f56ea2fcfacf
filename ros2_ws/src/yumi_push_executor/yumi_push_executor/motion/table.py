"""What a push means on the table: inside the workspace, which blocks it sweeps over, how high to pass over them."""

import numpy as np

from singulation_core import Arrangement, CellGeometry, Push, PusherGeometry, ResultCode, SingulationError
from singulation_core.polygon import contains, convex_hull, inward_half_planes, separation
from yumi_push_executor.motion.jaws import middle_line
from yumi_push_executor.motion.parameters import MotionParameters

_ON_THE_EDGE = 1e-6  # [m] that rounding may put an end outside


def require_inside(push: Push, cell: CellGeometry) -> None:
    """Refuse a push of which an end lies outside the workspace, which is convex.

    Raises:
        SingulationError: ``PUSH_OUTSIDE_WORKSPACE`` with the worse end and its distance.
    """
    ends = np.array((push.start, push.end))
    if contains(cell.workspace_polygon, ends, margin=-_ON_THE_EDGE).all():
        return
    normals, offsets = inward_half_planes(cell.workspace_polygon)
    outside = (offsets - ends @ normals.T).max(axis=1)
    worst = int(outside.argmax())
    raise SingulationError(
        ResultCode.PUSH_OUTSIDE_WORKSPACE,
        f"the {('start', 'end')[worst]} of the push, ({ends[worst][0]:.3f}, {ends[worst][1]:.3f}) m in table, lies "
        f"{outside[worst] * 1e3:.1f} mm outside the workspace {cell.workspace}",
    )


def swept_blocks(push: Push, arrangement: Arrangement, pusher: PusherGeometry) -> frozenset[int]:
    """Ids of the blocks that the jaws sweep over on their way from start to end."""
    reach = float(np.hypot(pusher.edge_width, pusher.edge_thickness)) / 2.0
    across = np.array((-push.direction[1], push.direction[0])) * (reach + 0.5 * push.contact_width)
    along = push.direction * reach
    line = middle_line(push, pusher)
    corners = [line.start - along, line.end + along]
    swept = convex_hull([corner + side for corner in corners for side in (across, -across)])
    return frozenset(item.id for item in arrangement.objects if separation(swept, item.outline) <= 0.0)


def travel_height(arrangement: Arrangement, parameters: MotionParameters) -> float:
    """Height of the tips above the table at which they pass over every block [m]."""
    tallest = max((item.height or parameters.unknown_height for item in arrangement.objects), default=0.0)
    return max(parameters.travel_height, tallest + parameters.travel_clearance)
