"""The robot description, read once: the URDF in this package is the only place that holds the YuMi's numbers."""

from dataclasses import dataclass
from functools import cache
from importlib.resources import as_file, files
from typing import Any

import numpy as np
import pinocchio as pin

from singulation_core import InvalidInputError
from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics.chain import Chain

ARMS = ("left", "right")
JOINTS = 7


@dataclass(frozen=True, eq=False)
class ArmModel:
    """Constants of one arm; joints from the shoulder to the flange (ABB axes 1, 2, 7, 3, 4, 5, 6).

    Args:
        chain: geometry and joint limits.
        velocity: (7,) [rad/s].
        positions: where the arm's joints stand in the configuration vector of the whole robot, (7,).
        fingers: where its two finger joints stand, (2,).
    """

    chain: Chain
    velocity: FloatArray
    positions: tuple[int, ...]
    fingers: tuple[int, ...]


def require_arm(name: str) -> None:
    """Refuse anything but ``left`` and ``right``.

    Raises:
        InvalidInputError: the name is neither.
    """
    if name not in ARMS:
        raise InvalidInputError(f"arm {name!r}: the YuMi has {' and '.join(ARMS)}")


@cache
def robot() -> Any:
    """Pinocchio model of body, both arms and grippers."""
    with as_file(urdf_resource()) as path:
        return pin.buildModelFromUrdf(str(path))


def urdf_resource() -> Any:
    """The URDF as a package resource; works from a source tree and when installed."""
    return files("yumi_push_executor") / "urdf" / "yumi.urdf"


@cache
def arm_model(name: str) -> ArmModel:
    """Constants of the arm ``left`` or ``right``."""
    require_arm(name)
    model = robot()
    joints = [model.getJointId(f"yumi_rob{name[0]}_joint_{number}") for number in range(1, JOINTS + 1)]
    fingers = [model.getJointId(f"{name}_finger_{number}_joint") for number in (1, 2)]
    positions = [model.joints[joint].idx_q for joint in joints]
    tool = model.frames[model.getFrameId(f"{name}_tool0")].placement
    placements = [*(model.jointPlacements[joint] for joint in joints), tool]
    return ArmModel(
        chain=Chain(
            frames=_frozen([placement.homogeneous[:3] for placement in placements]),
            limits=_frozen((model.lowerPositionLimit[positions], model.upperPositionLimit[positions])),
        ),
        velocity=_frozen(model.velocityLimit[positions]),
        positions=tuple(positions),
        fingers=tuple(model.joints[joint].idx_q for joint in fingers),
    )


def _frozen(value: Any) -> FloatArray:
    array = np.ascontiguousarray(value, dtype=np.float64)
    array.setflags(write=False)
    return array
