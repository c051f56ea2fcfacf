"""Settings of a motion. Every default stands here."""

import math
from dataclasses import dataclass, field

from singulation_core import InvalidInputError
from yumi_push_executor.clearance import Margins

MAX_OPENING = 0.050  # [m]: two fingers of 25 mm travel each (ABB's SmartGripper module)
REDUCED_SPEED = 0.25  # [m/s]: ISO 10218-1, reduced speed of the tool


@dataclass(frozen=True)
class MotionParameters:
    """Speeds, heights and margins of a push.

    Args:
        approach_speed: of the tips while they travel [m/s], at most the reduced speed of ISO 10218-1.
        vertical_speed: of the tips going down and up [m/s].
        push_speed: of the tips between start and end [m/s].
        linear_acceleration: of the tips on straight lines [m/s^2].
        velocity_share: largest share of the joints' velocity limits.
        joint_acceleration: of the joints from the shoulder to the flange [rad/s^2]. ABB publishes none; these
            reach the full joint speed in about 0.8 s.
        tip_height: of the tips above the table while they push [m]. The fingers get wider 35 mm above their tips, so
            that the default lets them down beside blocks of 42 mm.
        travel_clearance: of the tips above the tallest block while they travel [m].
        travel_height: of the tips above the table while they travel, at least [m].
        limit_margin: kept from every joint limit [rad].
        straightness: largest deviation of the tips from a straight line [m].
        unknown_height: taken for blocks whose height is not known [m].
        margins: distances to keep from everything.

    Raises:
        InvalidInputError: naming the field, its value and its range.
    """

    approach_speed: float = 0.25
    vertical_speed: float = 0.10
    push_speed: float = 0.05
    linear_acceleration: float = 0.5
    velocity_share: float = 0.5
    joint_acceleration: tuple[float, ...] = (4.0, 4.0, 4.0, 4.0, 8.0, 8.0, 8.0)
    tip_height: float = 0.008
    travel_clearance: float = 0.02
    travel_height: float = 0.06
    limit_margin: float = 0.02
    straightness: float = 0.0005
    unknown_height: float = 0.05
    margins: Margins = field(default_factory=Margins)

    def __post_init__(self) -> None:
        _check("approach_speed", self.approach_speed, 0.001, REDUCED_SPEED)
        _check("vertical_speed", self.vertical_speed, 0.001, REDUCED_SPEED)
        _check("push_speed", self.push_speed, 0.001, REDUCED_SPEED)
        _check("linear_acceleration", self.linear_acceleration, 0.01, 10.0)
        _check("velocity_share", self.velocity_share, 0.01, 1.0)
        _check("tip_height", self.tip_height, self.margins.finger_table + 1e-4, 0.05)
        _check("travel_clearance", self.travel_clearance, self.margins.block, 0.3)
        _check("travel_height", self.travel_height, self.margins.finger_travel, 0.3)
        _check("limit_margin", self.limit_margin, 0.0, 0.5)
        _check("straightness", self.straightness, 1e-5, 0.01)
        _check("unknown_height", self.unknown_height, 0.0, 0.2)
        if len(self.joint_acceleration) != 7:
            raise InvalidInputError(f"motion: joint_acceleration has {len(self.joint_acceleration)} entries, need 7")
        for value in self.joint_acceleration:
            _check("joint_acceleration", value, 0.01, 100.0)


def _check(name: str, value: float, low: float, high: float) -> None:
    if not (math.isfinite(value) and low <= value <= high):
        raise InvalidInputError(f"motion: {name} {value}, need {low:g} to {high:g}")
