"""Result codes: one list for every outcome of the suite.

The same list as ``singulation_msgs/msg/ResultCode``; a test keeps the two equal.
"""

from enum import IntEnum


class ResultCode(IntEnum):
    """0 success, 1-99 common, 100s perception, 200s planner, 300s executor, 400s coordinator."""

    OK = 0

    REJECTED = 1
    TIMEOUT = 2
    CANCELLED = 3
    STALE_INPUT = 4
    INVALID_INPUT = 5
    NOT_READY = 6
    INTERNAL = 7
    BUSY = 8

    NO_POINTS = 100
    BAD_LAYOUT = 101
    NOT_METRES = 102
    NO_TABLE = 103
    WRONG_TABLE = 104
    CLOUD_TOO_LARGE = 105
    NO_TRANSFORM = 106
    BAD_FILE = 107

    NOTHING_TO_DO = 200
    NO_PUSH = 201
    UNKNOWN_POLICY = 202
    UNKNOWN_CONTACT_MODE = 203
    OUTSIDE_WORKSPACE = 204
    OVERLAPPING_OBJECTS = 205

    UNREACHABLE = 300
    PATH_BLOCKED = 301
    PUSH_OUTSIDE_WORKSPACE = 302
    CONTACT_WIDTH = 303
    START_TOO_FAR = 304
    STATE_LOST = 305
    NO_PROGRESS = 306
    PATH_TOLERANCE = 307
    GOAL_TOLERANCE = 308
    SAFETY_STOP = 309
    COLLISION_STOP = 310
    GRIPPER_NOT_CALIBRATED = 311
    GRIPPER_STUCK = 312
    HALTED = 313

    MAX_PUSHES_REACHED = 400
    NO_HELPFUL_PUSH = 401
    PUSH_FAILED = 402
    NO_FRESH_VIEW = 403
    OBJECT_LOST = 404
