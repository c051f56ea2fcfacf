"""The YuMi's two arms: model, forward and inverse kinematics."""

from yumi_push_executor.kinematics.arm import TIP_OFFSET, YumiArm
from yumi_push_executor.kinematics.postures import BRANCHES, CLEAR_VIEW, FOLDED

__all__ = ["BRANCHES", "CLEAR_VIEW", "FOLDED", "TIP_OFFSET", "YumiArm"]
