"""The parts of a motion, and the checks that stand between a plan and the controllers."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from singulation_core import InvalidInputError, ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.supervision.inputs import Sample
from yumi_push_executor.supervision.limits import SupervisionLimits
from yumi_push_executor.supervision.state_watch import JointRange
from yumi_push_executor.supervision.trajectory import Trajectory

_JOIN = 1e-3  # rad between the end of one segment and the start of the next of the same arm
_GRID = 0.01  # s between the checked points of a trajectory
_SPEED_SLACK = 1.01


class Phase(IntEnum):
    """Values are those of the feedback of ``singulation_msgs/action/ExecutePush``."""

    PLANNING = 0
    GRIPPER = 1
    APPROACH = 2
    DESCEND = 3
    PUSH = 4
    RETREAT = 5
    CLEAR_VIEW = 6
    STOPPING = 7


@dataclass(frozen=True, eq=False, slots=True)
class Segment:
    """One order: either a trajectory of an arm or an opening of its jaws.

    Args:
        phase: what it is for.
        arm: ``left`` or ``right``.
        trajectory: of the arm, from rest to rest.
        opening: of the jaws [m].

    Raises:
        InvalidInputError: another arm, or not exactly one of trajectory and opening.
    """

    phase: Phase
    arm: str
    trajectory: Trajectory | None = None
    opening: float | None = None

    def __post_init__(self) -> None:
        if self.arm not in ARMS:
            raise InvalidInputError(f"segment {self.phase.name}: arm {self.arm!r}, need one of {ARMS}")
        if (self.trajectory is None) == (self.opening is None):
            raise InvalidInputError(f"segment {self.phase.name}: need either a trajectory or a jaw opening")
        if self.opening is not None and not (0.0 <= self.opening < float("inf")):
            raise InvalidInputError(f"segment {self.phase.name}: jaw opening {self.opening} m, need 0 or more")


def check_segments(
    segments: Sequence[Segment],
    sample: Sample,
    ranges: dict[str, JointRange],
    speeds: dict[str, FloatArray],
    limits: SupervisionLimits,
) -> None:
    """Refuse a motion that does not start here, is not connected, or leaves the joints' range or speed.

    Args:
        segments: in order.
        sample: where the arms are.
        ranges: joint range per arm.
        speeds: (7,) fastest joint speeds per arm [rad/s].
        limits: of the supervision.

    Raises:
        SingulationError: ``START_TOO_FAR`` or ``INVALID_INPUT`` with the worst offender.
    """
    if not segments:
        raise InvalidInputError("motion: it has no segments")
    ends: dict[str, FloatArray] = {}
    for segment in segments:
        if segment.trajectory is None:
            continue
        if segment.arm in ends:
            _require_joined(segment, ends[segment.arm])
        else:
            _require_near(segment, sample.positions[segment.arm], limits.start_distance)
        _require_possible(segment, ranges[segment.arm], speeds[segment.arm])
        ends[segment.arm] = segment.trajectory.end


def _require_near(segment: Segment, measured: FloatArray, tolerance: float) -> None:
    assert segment.trajectory is not None  # for the type checker; the caller has looked
    distance = np.abs(segment.trajectory.start - measured)
    worst = int(distance.argmax())
    if not (distance[worst] <= tolerance):
        raise SingulationError(
            ResultCode.START_TOO_FAR,
            f"{segment.arm} joint {worst + 1} is {distance[worst]:.3f} rad away from where the motion starts, "
            f"tolerance {tolerance} rad",
        )


def _require_joined(segment: Segment, before: FloatArray) -> None:
    assert segment.trajectory is not None
    step = np.abs(segment.trajectory.start - before)
    worst = int(step.argmax())
    if not (step[worst] <= _JOIN):
        raise InvalidInputError(
            f"motion: {segment.phase.name} of the {segment.arm} arm starts {step[worst]:.4f} rad away from the end of "
            f"the segment before (joint {worst + 1}), need {_JOIN} rad"
        )


def _require_possible(segment: Segment, allowed: JointRange, fastest: FloatArray) -> None:
    trajectory = segment.trajectory
    assert trajectory is not None
    positions, velocities = trajectory.sample(np.arange(0.0, trajectory.duration + _GRID, _GRID))
    beyond = np.maximum(allowed.lower - positions, positions - allowed.upper).max(axis=0)
    ratio = np.abs(velocities).max(axis=0) / fastest
    name = f"motion: {segment.phase.name} of the {segment.arm} arm"
    if not (beyond.max() <= 1e-6):
        joint = int(beyond.argmax())
        raise InvalidInputError(f"{name}: joint {joint + 1} goes {beyond[joint]:.3f} rad beyond its limit")
    if not (ratio.max() <= _SPEED_SLACK):
        joint = int(ratio.argmax())
        raise InvalidInputError(f"{name}: joint {joint + 1} moves at {ratio[joint]:.2f} times its fastest speed")
