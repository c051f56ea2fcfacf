"""From a push to a supervised closed-jaw, jaw-side or open-jaw motion of an ABB YuMi."""

from yumi_push_executor.kinematics import YumiArm

__all__ = ["YumiArm"]
