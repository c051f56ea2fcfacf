"""What a closed-loop run depends on besides blocks, policy and contact mode."""

from dataclasses import dataclass, field

from singulation_core import CellGeometry, InvalidInputError, PusherGeometry
from singulation_core.push_world import PushPhysics
from singulation_perception import SegmentationParameters
from singulation_planner import Placement
from singulation_planner.plan import PUSH_DISTANCE_FACTOR
from singulation_sim.camera import PHOXI_FULL, PHOXI_SMALL, CameraModel, PhoxiCamera, SensorDefects
from singulation_sim.cell import SimulatedCell
from singulation_sim.driver import SimulatedDriver
from singulation_sim.scenes import random_scene
from yumi_push_executor import MotionParameters
from yumi_push_executor.supervision import SupervisionLimits

CAMERAS = {"small": PHOXI_SMALL, "full": PHOXI_FULL}
SAMPLED = "sampled"  # friction and density drawn for each set


@dataclass(frozen=True)
class CellSetting:
    """The nodes' own defaults, so that a run without ROS does what the nodes do.

    Args:
        push_distance_factor: travel after contact [mean bounding radii of the scene].
        physics: of the table: a preset of ``PushPhysics``, or ``sampled``: friction from N(0.5, 0.1) and density from
            N(1.0, 0.2) for each set, as in the paper's simulations (section V-A), which the planner does not know.
        fits: which jaws must be free at the start: those of the ``contact_mode``, or those of ``every_mode``, so that
            all modes do the same pushes.
        retreat: how far a blocked start may be moved back on its line [m]; 0: the policy's next push instead.
        camera: image size, ``small`` or ``full``.
        noise: of the camera along the ray [m].
        scan_time: from trigger to cloud [s].
        geometry: where table and camera stand.
        pusher: jaws that the planner reckons with.
        motion: speeds and heights.
        limits: of the supervision.

    Raises:
        InvalidInputError: unknown camera or physics.
    """

    push_distance_factor: float = PUSH_DISTANCE_FACTOR
    physics: str = SAMPLED
    fits: str = Placement().fits
    retreat: float = Placement().retreat
    camera: str = "small"
    noise: float = SensorDefects().noise
    scan_time: float = 0.25
    geometry: CellGeometry = field(default_factory=CellGeometry)
    pusher: PusherGeometry = field(default_factory=PusherGeometry)
    motion: MotionParameters = field(default_factory=MotionParameters)
    limits: SupervisionLimits = field(default_factory=SupervisionLimits)

    def __post_init__(self) -> None:
        if self.camera not in CAMERAS:
            raise InvalidInputError(f"closed loop: camera {self.camera!r}, need one of {', '.join(CAMERAS)}")
        _ = self.table_physics(0), self.placement

    @property
    def camera_model(self) -> CameraModel:
        """Image size and optics."""
        return CAMERAS[self.camera]

    @property
    def segmentation(self) -> SegmentationParameters:
        """As ``perception_node`` has them."""
        geometry = self.geometry
        return SegmentationParameters(table_from_camera=geometry.table_from_camera, workspace=geometry.workspace)

    @property
    def placement(self) -> Placement:
        """How starts are chosen."""
        return Placement(fits=self.fits, retreat=self.retreat)  # type: ignore[arg-type]  # it checks ``fits`` itself

    def table_physics(self, seed: int) -> PushPhysics:
        """Of the blocks that really lie there."""
        if self.physics == SAMPLED:
            return PushPhysics.quasi_static().sampled(seed)
        return PushPhysics.named(self.physics)

    def simulated_cell(self, kind: str, blocks: int, seed: int) -> SimulatedCell:
        """A cell with a random set of blocks on its table; the same seed gives the same cell.

        Raises:
            SingulationError: as ``random_scene``.
        """
        scene = random_scene(kind, blocks, seed, self.geometry)
        driver = SimulatedDriver(start=1.0, seed=seed)  # a stamp of 0 would mean "none"
        camera = PhoxiCamera(self.geometry, self.camera_model, SensorDefects(noise=self.noise), seed=seed)
        return SimulatedCell(scene, self.geometry, driver, camera, self.table_physics(seed))
