"""The order that holds an arm where it is."""

import numpy as np

from singulation_core import ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from yumi_push_executor.supervision.limits import SupervisionLimits
from yumi_push_executor.supervision.orders import ArmOrder
from yumi_push_executor.supervision.state_watch import StateWatch
from yumi_push_executor.supervision.stops import hold_at


def hold_arm(arm: str, watch: StateWatch, limits: SupervisionLimits, commanded: FloatArray | None = None) -> ArmOrder:
    """Hold an arm where it was last measured.

    Args:
        arm: ``left`` or ``right``.
        watch: the stream of states.
        limits: of the supervision.
        commanded: (7,) where the controller was ordered to be by now [rad], None if that is where the arm is.

    Raises:
        SingulationError: ``NOT_READY``; it has never been measured.
    """
    latest = watch.latest
    if latest is None:
        raise SingulationError(ResultCode.NOT_READY, f"where the {arm} arm is has never been reported; cannot hold it")
    position = latest.positions[arm]
    where = position if commanded is None else commanded
    return ArmOrder(arm, hold_at(position, np.nan_to_num(watch.speed(arm)), where, limits, watch.ranges[arm]))
