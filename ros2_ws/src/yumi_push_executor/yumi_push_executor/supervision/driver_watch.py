"""Whether the robot's controller lets the arm move."""

from singulation_core import ResultCode
from yumi_push_executor.supervision.faults import Fault
from yumi_push_executor.supervision.inputs import DriverMode, DriverStatus, Instant
from yumi_push_executor.supervision.limits import SupervisionLimits

_MEANING = {
    DriverMode.MOTORS_OFF: "the motors are off",
    DriverMode.GUARD_STOP: "guard stop",
    DriverMode.EMERGENCY_STOP: "emergency stop",
    DriverMode.COLLISION_STOP: "the controller stopped on a collision",
    DriverMode.SYSTEM_FAILURE: "system failure",
}


def driver_fault(status: DriverStatus | None, limits: SupervisionLimits, now: Instant) -> Fault | None:
    """Why the arm may not move, or None. A collision alone may be followed by a retreat."""
    if status is None:
        return Fault(ResultCode.NOT_READY, "no driver state has come yet")
    age, silent = now.time - status.seen.time, now.heard - status.seen.heard
    if not (min(age, silent) <= limits.driver_age) or not (silent <= limits.wall_silence):
        return Fault(
            ResultCode.STATE_LOST, f"the driver has said nothing for {silent:.2f} s, limit {limits.driver_age} s"
        )
    said = f" ({status.message})" if status.message else ""
    if status.mode is DriverMode.COLLISION_STOP:
        return Fault(ResultCode.COLLISION_STOP, f"{_MEANING[status.mode]}{said}", lift=True)
    if status.mode is not DriverMode.MOTORS_ON:
        return Fault(ResultCode.SAFETY_STOP, f"{_MEANING[status.mode]}{said}")
    if not status.motion_enabled:
        return Fault(ResultCode.SAFETY_STOP, f"the driver does not take motions{said}")
    return None


def may_lift(status: DriverStatus | None, limits: SupervisionLimits, now: Instant) -> bool:
    """Whether a retreat is allowed: as any motion, or after a collision as soon as the driver takes motions again."""
    fault = driver_fault(status, limits, now)
    if fault is None:
        return True
    return fault.code is ResultCode.COLLISION_STOP and status is not None and status.motion_enabled


def gripper_fault(status: DriverStatus | None, arm: str) -> Fault | None:
    """Whether the arm's gripper can be ordered; an uncalibrated hand ignores orders silently."""
    if status is not None and not status.calibrated.get(arm, False):
        return Fault(
            ResultCode.GRIPPER_NOT_CALIBRATED,
            f"the {arm} gripper is not calibrated; calibrate it, then ask again",
            lift=True,
        )
    return None
