"""What the robot controller reports of itself."""

from enum import IntEnum


class DriverMode(IntEnum):
    """Values are those of ``singulation_msgs/msg/DriverState``; a test keeps the two equal."""

    MOTORS_OFF = 0
    MOTORS_ON = 1
    GUARD_STOP = 2
    EMERGENCY_STOP = 3
    COLLISION_STOP = 4
    SYSTEM_FAILURE = 5
