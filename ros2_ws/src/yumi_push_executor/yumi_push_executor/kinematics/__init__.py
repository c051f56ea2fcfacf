"""The YuMi's two arms: model, forward and inverse kinematics."""

from yumi_push_executor.kinematics.arm import TIP_OFFSET, YumiArm
from yumi_push_executor.kinematics.postures import CLEAR_VIEW

__all__ = ["CLEAR_VIEW", "TIP_OFFSET", "YumiArm"]
