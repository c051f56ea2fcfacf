"""Parameters of the executor node."""

import dataclasses
from dataclasses import dataclass

from singulation_core import CellGeometry, InvalidInputError
from singulation_node.parameters import parameter
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.motion import MotionParameters
from yumi_push_executor.motion.parameters import REDUCED_SPEED
from yumi_push_executor.supervision import SupervisionLimits
from yumi_push_executor.wire import JointNames

_CELL = CellGeometry()
_MOTION = MotionParameters()
_LIMITS = SupervisionLimits()


def _names(prefix: str) -> tuple[str, ...]:
    return tuple(f"{prefix}_joint_{number}" for number in range(1, 8))


@dataclass(frozen=True, slots=True)
class ExecutorSettings:
    """Where the table stands, what joints are called, when a push is too old, when a motion is stopped."""

    auto_execute: bool = parameter(False, "execute what arrives on the topic push without being asked")
    left_arm_joints: tuple[str, ...] = parameter(
        _names("yumi_robl"), "left arm's joints from shoulder to flange (ABB axes 1, 2, 7, 3, 4, 5, 6)", read_only=True
    )
    right_arm_joints: tuple[str, ...] = parameter(
        _names("yumi_robr"), "right arm's joints from shoulder to flange", read_only=True
    )
    left_finger_joint: str = parameter(
        "gripper_l_joint", "joint of one left finger, 0 to 0.025 m; the jaws open by twice its position", read_only=True
    )
    right_finger_joint: str = parameter("gripper_r_joint", "joint of one right finger", read_only=True)

    table_frame: str = parameter("table", "frame of arrangements and pushes", read_only=True)
    table_position: tuple[float, ...] = parameter(
        _CELL.table_position, "origin of the table frame in yumi_body, x, y, z [m]", read_only=True
    )
    table_quaternion: tuple[float, ...] = parameter(
        _CELL.table_quaternion, "orientation of the table frame in yumi_body, x, y, z, w", read_only=True
    )
    workspace: tuple[float, ...] = parameter(
        _CELL.workspace, "where pushes may lie, x_min, x_max, y_min, y_max in the table frame [m]", read_only=True
    )

    camera_position: tuple[float, ...] = parameter(
        _CELL.camera_position, "camera in the table frame, x, y, z [m]; the arm ends outside its view", read_only=True
    )
    camera_quaternion: tuple[float, ...] = parameter(
        _CELL.camera_quaternion, "orientation of the camera in the table frame, x, y, z, w", read_only=True
    )

    arms: str = parameter("both", "arms that may push", choices=("both", *ARMS))
    approach_speed: float = parameter(
        _MOTION.approach_speed, "of the tips while they travel [m/s]", low=0.001, high=REDUCED_SPEED
    )
    vertical_speed: float = parameter(
        _MOTION.vertical_speed, "of the tips going down and up [m/s]", low=0.001, high=REDUCED_SPEED
    )
    push_speed: float = parameter(
        _MOTION.push_speed, "of the tips while they push [m/s]", low=0.001, high=REDUCED_SPEED
    )
    tip_height: float = parameter(
        _MOTION.tip_height, "of the tips above the table while they push [m]", low=0.001, high=0.05
    )
    travel_height: float = parameter(
        _MOTION.travel_height, "of the tips above the table while they travel, at least [m]", low=0.01, high=0.3
    )

    max_push_age: float = parameter(
        30.0, "age of the view a push was planned on [s]", low=0.1, high=3600.0, read_only=True
    )
    max_push_skew: float = parameter(
        0.5, "how far a push may be stamped in the future [s]", low=0.0, high=60.0, read_only=True
    )
    need_objects: bool = parameter(True, "refuse pushes until an arrangement has come to keep clear of", read_only=True)
    result_timeout: float = parameter(60.0, "how long a result is kept for its client [s]", low=1.0, read_only=True)
    lift_height: float = parameter(0.05, "retreat upwards after a fault [m]", low=0.01, high=0.3)
    lift_speed: float = parameter(0.1, "speed of that retreat [m/s]", low=0.005, high=0.25)

    state_age: float = parameter(_LIMITS.state_age, "joint states older than this are lost [s]", low=0.01, high=10.0)
    driver_age: float = parameter(_LIMITS.driver_age, "a driver silent for longer is lost [s]", low=0.02, high=60.0)
    state_delay: float = parameter(
        _LIMITS.state_delay, "largest difference of stamp and arrival of joint states [s]", low=0.01, high=10.0
    )
    wall_silence: float = parameter(
        _LIMITS.wall_silence, "longest silence on the steady clock, whatever the ROS clock says [s]", low=0.1, high=60.0
    )
    blind_time: float = parameter(
        _LIMITS.blind_time, "longest gap between two steps of the supervision [s]", low=0.05, high=10.0
    )
    start_distance: float = parameter(
        _LIMITS.start_distance, "joint distance of measured and planned start [rad]", low=0.001, high=0.5
    )
    clock_skew: float = parameter(
        _LIMITS.clock_skew, "difference of the stamps' clock and this machine's [s]", low=0.001, high=1.0
    )
    start_latency: float = parameter(
        _LIMITS.start_latency, "until an ordered motion is seen to begin [s]", low=0.02, high=10.0
    )
    path_tolerance: float = parameter(
        _LIMITS.path_tolerance, "joint distance from the commanded path [rad]", low=0.001, high=0.5
    )
    lag: float = parameter(_LIMITS.lag, "how far the arm may run behind the command [s]", low=0.01, high=10.0)
    progress_window: float = parameter(
        _LIMITS.progress_window, "no movement for this long is no progress [s]", low=0.02, high=10.0
    )
    goal_tolerance: float = parameter(
        _LIMITS.goal_tolerance, "joint distance at the end of a segment [rad]", low=0.0001, high=0.5
    )
    goal_time: float = parameter(_LIMITS.goal_time, "to settle at the end of a segment [s]", low=0.02, high=60.0)
    stopped_speed: float = parameter(
        _LIMITS.stopped_speed, "joint speed that counts as standing [rad/s]", low=0.0001, high=0.2
    )
    stop_duration: float = parameter(_LIMITS.stop_duration, "duration of a stop, at least [s]", low=0.01, high=2.0)
    stop_deceleration: float = parameter(
        _LIMITS.stop_deceleration, "of the joints, at the beginning of a stop [rad/s^2]", low=0.5, high=200.0
    )
    stop_speed: float = parameter(
        _LIMITS.stop_speed,
        "joint speed of the way back from the command to a measured position [rad/s]",
        low=0.05,
        high=3.0,
    )
    stop_timeout: float = parameter(_LIMITS.stop_timeout, "until standstill must be seen [s]", low=0.1, high=30.0)
    lift_wait: float = parameter(
        _LIMITS.lift_wait, "for the driver to allow a retreat after a collision [s]", low=0.01, high=60.0
    )
    opening_tolerance: float = parameter(
        _LIMITS.opening_tolerance, "jaw opening against the order [m]", low=0.0001, high=0.02
    )
    opening_drift: float = parameter(
        _LIMITS.opening_drift, "change of the jaw opening during a motion [m]", low=0.0001, high=0.05
    )
    gripper_speed: float = parameter(_LIMITS.gripper_speed, "speed of the jaw opening [m/s]", low=0.001, high=1.0)
    gripper_time: float = parameter(
        _LIMITS.gripper_time, "for the jaws beyond what their speed explains [s]", low=0.05, high=60.0
    )

    def __post_init__(self) -> None:
        # The rules between the values are those of what they make up.
        for part in (
            self.cell.body_from_table,
            self.cell.table_from_camera,
            self.motion,
            self.limits,
            self.joint_names,
        ):
            assert part is not None

    @property
    def cell(self) -> CellGeometry:
        """Where table, workspace and camera are."""
        return CellGeometry(
            _triple(self.table_position),
            _quadruple(self.table_quaternion),
            _quadruple(self.workspace),
            _triple(self.camera_position),
            _quadruple(self.camera_quaternion),
        )

    @property
    def motion(self) -> MotionParameters:
        """Speeds and heights of a push."""
        return MotionParameters(
            approach_speed=self.approach_speed,
            vertical_speed=self.vertical_speed,
            push_speed=self.push_speed,
            tip_height=self.tip_height,
            travel_height=self.travel_height,
        )

    @property
    def limits(self) -> SupervisionLimits:
        """Of the supervision."""
        return SupervisionLimits(**{item.name: getattr(self, item.name) for item in dataclasses.fields(_LIMITS)})

    @property
    def joint_names(self) -> JointNames:
        """On the wire."""
        return JointNames(
            {"left": self.left_arm_joints, "right": self.right_arm_joints},
            {"left": self.left_finger_joint, "right": self.right_finger_joint},
        )


def _triple(values: tuple[float, ...]) -> tuple[float, float, float]:
    if len(values) != 3:
        raise InvalidInputError(f"a position has {len(values)} numbers, need x, y, z")
    return values[0], values[1], values[2]


def _quadruple(values: tuple[float, ...]) -> tuple[float, float, float, float]:
    if len(values) != 4:
        raise InvalidInputError(f"a quaternion or workspace has {len(values)} numbers, need 4")
    return values[0], values[1], values[2], values[3]
