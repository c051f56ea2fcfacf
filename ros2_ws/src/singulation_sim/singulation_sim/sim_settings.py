"""Parameters of ``sim_cell``, and the simulated cell they describe."""

from dataclasses import dataclass

from singulation_core import Arrangement, CellGeometry, InvalidInputError
from singulation_core.push_world import PushPhysics
from singulation_node.parameters import parameter
from singulation_sim.camera import PHOXI_FULL, PHOXI_SMALL, PhoxiCamera, SensorDefects
from singulation_sim.cell import SimulatedCell
from singulation_sim.driver import DriverSettings, SimulatedDriver
from singulation_sim.scenes import SCENES, random_scene

_CELL = CellGeometry()
_DRIVER = DriverSettings()
_DEFECTS = SensorDefects()
_CAMERAS = {"small": PHOXI_SMALL, "full": PHOXI_FULL}


@dataclass(frozen=True)
class SimSettings:
    """Parameters; those of the scene may change at any time and put new blocks down."""

    speed: float = parameter(
        1.0, "simulated seconds per second; other than 1: own time on /clock", low=0.05, high=100.0, read_only=True
    )
    publish_clock: bool = parameter(False, "own time on /clock also at speed 1", read_only=True)
    seed: int = parameter(0, "seed of scene and noise", low=0, high=2**31 - 1)
    scene: str = parameter("mixed", "kinds of blocks", choices=tuple(SCENES))
    objects: int = parameter(0, "number of blocks, 0 for a random one from 3 to 7", low=0, high=40)
    smallest_gap: float = parameter(0.002, "between a block and the one it is put beside [m]", low=0.0, high=0.1)
    largest_gap: float = parameter(0.006, "likewise, at most [m]", low=0.0, high=0.1)
    physics: str = parameter("quasi_static", "preset of the push physics", read_only=True)

    state_rate: float = parameter(100.0, "joint states per simulated second [Hz]", low=1.0, high=250.0, read_only=True)
    frame_period: float = parameter(
        0.0, "free run: seconds between clouds, 0 for clouds on trigger only", low=0.0, read_only=True
    )
    scan_time: float = parameter(0.25, "from trigger to cloud [s]", low=0.0, high=10.0)
    resolution: str = parameter("small", "1032x772 or 2064x1544", choices=tuple(_CAMERAS), read_only=True)
    invalid_points: str = parameter("zero", "pixels without measurement", choices=("zero", "nan"), read_only=True)
    camera_frame: str = parameter("phoxi_camera_sensor", "frame of the clouds", read_only=True)
    noise: float = parameter(_DEFECTS.noise, "camera noise along the ray [m]", low=0.0, high=0.01, read_only=True)
    edge_loss: float = parameter(
        _DEFECTS.edge_loss, "share of pixels lost at depth edges", low=0.0, high=1.0, read_only=True
    )
    flying: float = parameter(_DEFECTS.flying, "share of flying pixels there", low=0.0, high=1.0, read_only=True)
    random_loss: float = parameter(
        _DEFECTS.random_loss, "share of pixels lost anywhere", low=0.0, high=1.0, read_only=True
    )
    shadows: bool = parameter(_DEFECTS.shadows, "whether what the projector does not light is lost", read_only=True)

    table_position: tuple[float, ...] = parameter(
        _CELL.table_position, "x, y, z of the table frame in yumi_body [m]", read_only=True
    )
    table_quaternion: tuple[float, ...] = parameter(
        _CELL.table_quaternion, "x, y, z, w of the table frame in yumi_body", read_only=True
    )
    camera_position: tuple[float, ...] = parameter(
        _CELL.camera_position, "x, y, z of the camera in the table frame [m]", read_only=True
    )
    camera_quaternion: tuple[float, ...] = parameter(
        _CELL.camera_quaternion, "x, y, z, w of the camera in the table frame", read_only=True
    )
    workspace: tuple[float, ...] = parameter(
        _CELL.workspace, "x_min, x_max, y_min, y_max of the table frame [m]", read_only=True
    )

    left_arm_joints: tuple[str, ...] = parameter(_DRIVER.joints["left"], "shoulder to flange", read_only=True)
    right_arm_joints: tuple[str, ...] = parameter(_DRIVER.joints["right"], "shoulder to flange", read_only=True)
    left_finger_joint: str = parameter(_DRIVER.finger_joints["left"], "joint of the left fingers", read_only=True)
    right_finger_joint: str = parameter(_DRIVER.finger_joints["right"], "joint of the right fingers", read_only=True)
    lag: float = parameter(_DRIVER.lag, "time constant of the joints [s]", low=0.0, high=1.0, read_only=True)
    position_noise: float = parameter(
        _DRIVER.position_noise, "noise of joint positions [rad]", low=0.0, high=0.01, read_only=True
    )
    velocity_noise: float = parameter(
        _DRIVER.velocity_noise, "noise of joint velocities [rad/s]", low=0.0, high=0.1, read_only=True
    )
    braking: float = parameter(_DRIVER.braking, "deceleration of a stop [rad/s^2]", low=0.1, high=1e3, read_only=True)
    back_off: float = parameter(
        _DRIVER.back_off, "way back after a collision, in joint space [rad]", low=0.0, high=0.2, read_only=True
    )
    collision_handler_time: float = parameter(
        _DRIVER.collision_handler_time,
        "after a collision, until motion is taken again [s]; negative: not before a reset",
        low=-1.0,
        high=60.0,
        read_only=True,
    )
    egm_timeout: float = parameter(
        _DRIVER.egm_timeout, "how long the robot moves on without data [s]", low=0.01, high=60.0, read_only=True
    )
    grippers_calibrated: bool = parameter(True, "at the start and after a reset", read_only=True)

    def __post_init__(self) -> None:
        names = (*self.left_arm_joints, *self.right_arm_joints, self.left_finger_joint, self.right_finger_joint)
        if (len(self.left_arm_joints), len(self.right_arm_joints)) != (7, 7):
            raise InvalidInputError("left_arm_joints and right_arm_joints need 7 names each")
        if len(set(names)) != len(names):
            raise InvalidInputError(f"joint names {sorted(names)}: each may occur once")
        if len(self.workspace) != 4 or not (
            self.workspace[0] < self.workspace[1] and self.workspace[2] < self.workspace[3]
        ):
            raise InvalidInputError(f"workspace {self.workspace}, need x_min < x_max, y_min < y_max")
        if not (self.smallest_gap <= self.largest_gap):
            raise InvalidInputError(
                f"smallest_gap {self.smallest_gap} m is larger than largest_gap {self.largest_gap} m"
            )
        PushPhysics.named(self.physics)
        _ = self.geometry.body_from_table, self.geometry.table_from_camera

    @property
    def own_time(self) -> bool:
        """Whether the cell makes the time, on /clock."""
        return self.publish_clock or self.speed != 1.0

    @property
    def scene_key(self) -> tuple[object, ...]:
        """What a scene is made from."""
        return self.scene, self.objects, self.seed, self.smallest_gap, self.largest_gap

    def new_scene(self) -> Arrangement:
        """Blocks on the table."""
        gaps = (self.smallest_gap, self.largest_gap)
        return random_scene(self.scene, self.objects, self.seed, self.geometry, gaps=gaps)

    @property
    def geometry(self) -> CellGeometry:
        """Where table and camera are."""
        return CellGeometry(
            self.table_position,  # type: ignore[arg-type]  # lengths are checked where the poses are built
            self.table_quaternion,  # type: ignore[arg-type]
            self.workspace,  # type: ignore[arg-type]
            self.camera_position,  # type: ignore[arg-type]
            self.camera_quaternion,  # type: ignore[arg-type]
        )

    @property
    def driver(self) -> DriverSettings:
        """Properties of the simulated robot."""
        return DriverSettings(
            {"left": self.left_arm_joints, "right": self.right_arm_joints},
            {"left": self.left_finger_joint, "right": self.right_finger_joint},
            self.lag,
            self.position_noise,
            self.velocity_noise,
            self.braking,
            self.back_off,
            self.collision_handler_time,
            self.egm_timeout,
            self.grippers_calibrated,
        )

    @property
    def camera(self) -> PhoxiCamera:
        """A new camera."""
        return PhoxiCamera(
            self.geometry,
            _CAMERAS[self.resolution],
            SensorDefects(self.noise, self.edge_loss, self.flying, self.random_loss, shadows=self.shadows),
            invalid=0.0 if self.invalid_points == "zero" else float("nan"),
            seed=self.seed,
        )

    def new_cell(self, start: float) -> SimulatedCell:
        """The cell at the time ``start`` [s], both arms in their clear-view posture, blocks on the table."""
        driver = SimulatedDriver(self.driver, start, self.seed)
        return SimulatedCell(self.new_scene(), self.geometry, driver, self.camera, PushPhysics.named(self.physics))
