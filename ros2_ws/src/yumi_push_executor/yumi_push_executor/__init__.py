"""From a push to a supervised closed-jaw, jaw-side or open-jaw motion of an ABB YuMi."""

from yumi_push_executor.kinematics import YumiArm
from yumi_push_executor.motion import Motion, MotionParameters, plan_clear_view, plan_motion

__all__ = ["Motion", "MotionParameters", "YumiArm", "plan_clear_view", "plan_motion"]
