"""From a push to a checked motion."""

from yumi_push_executor.motion.motion import Motion
from yumi_push_executor.motion.parameters import MotionParameters
from yumi_push_executor.motion.plan import plan_clear_view, plan_motion

__all__ = ["Motion", "MotionParameters", "plan_clear_view", "plan_motion"]
