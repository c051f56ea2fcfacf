"""Supervision of a motion: checked before it starts, watched while it runs, ended in exactly one coded outcome."""

from yumi_push_executor.supervision.holding import hold_arm
from yumi_push_executor.supervision.inputs import DriverMode, DriverStatus, Instant, Sample
from yumi_push_executor.supervision.limits import SupervisionLimits
from yumi_push_executor.supervision.orders import ArmOrder, JawOrder, Order, Outcome, Step
from yumi_push_executor.supervision.segment import Phase, Segment
from yumi_push_executor.supervision.state_watch import JointRange, StateWatch
from yumi_push_executor.supervision.supervisor import Supervisor
from yumi_push_executor.supervision.trajectory import Trajectory

__all__ = [
    "ArmOrder",
    "DriverMode",
    "DriverStatus",
    "Instant",
    "JawOrder",
    "JointRange",
    "Order",
    "Outcome",
    "Phase",
    "Sample",
    "Segment",
    "StateWatch",
    "Step",
    "SupervisionLimits",
    "Supervisor",
    "Trajectory",
    "hold_arm",
]
