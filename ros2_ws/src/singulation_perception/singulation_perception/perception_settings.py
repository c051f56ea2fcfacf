"""Parameters of perception_node. Defaults are those of the library and of the cell."""

from dataclasses import dataclass

from singulation_core import CellGeometry, InvalidInputError
from singulation_core.polygon import FloatArray
from singulation_core.transforms import pose_matrix
from singulation_node.parameters import parameter
from singulation_perception.parameters import SegmentationParameters

_CELL = CellGeometry()
_LIBRARY = SegmentationParameters()

FROM_PARAMETERS, FROM_TF, FROM_PLANE = "parameters", "tf", "plane_fit"


@dataclass(frozen=True)
class PerceptionSettings:
    """All may be changed while the node runs, from the next cloud on."""

    camera_pose_source: str = parameter(
        FROM_PARAMETERS,
        "where the pose of the camera over the table comes from: camera_position and camera_quaternion; tf at the "
        "stamp of the cloud; or plane_fit: the largest plane is the table, seen from wherever the camera is",
        choices=(FROM_PARAMETERS, FROM_TF, FROM_PLANE),
    )
    camera_position: tuple[float, ...] = parameter(
        _CELL.camera_position, "position of the camera in the frame table [m]", low=-10.0, high=10.0
    )
    camera_quaternion: tuple[float, ...] = parameter(
        _CELL.camera_quaternion, "orientation of the camera in the frame table, x y z w", low=-1.0, high=1.0
    )
    table_frame: str = parameter("table", "frame of the table, used with camera_pose_source tf and for the results")
    tf_timeout: float = parameter(0.2, "longest wait for the transform of a cloud [s]", low=0.0, high=10.0)
    crop_to_workspace: bool = parameter(True, "ignore everything outside workspace")
    workspace: tuple[float, ...] = parameter(
        _CELL.workspace, "x_min, x_max, y_min, y_max in the frame table [m]", low=-10.0, high=10.0
    )
    automatic_tolerances: bool = parameter(
        True, "tolerance and outline_tolerance follow from the point spacing of the cloud; the two values are not used"
    )
    tolerance: float = parameter(
        0.003, "points closer than this belong to one object (Euclidean clustering) [m]", low=0.0001, high=0.1
    )
    outline_tolerance: float = parameter(0.002, "tolerance of Douglas-Peucker [m]", low=0.0001, high=0.1)
    min_size: int = parameter(_LIBRARY.min_size, "fewest points of an object", low=1, high=10_000_000)
    max_size: int = parameter(_LIBRARY.max_size, "most points of an object", low=1, high=100_000_000)
    min_height: float = parameter(_LIBRARY.min_height, "lowest top face above the table [m]", low=0.0001, high=1.0)
    max_height: float = parameter(
        _LIBRARY.max_height, "highest top face above the table [m]; what reaches above is dropped", low=0.001, high=2.0
    )
    split_touching: bool = parameter(_LIBRARY.split_touching, "cut merged blocks where the cloud shows a seam")
    max_points: int = parameter(_LIBRARY.max_points, "larger clouds are rejected", low=1, high=100_000_000)
    max_future: float = parameter(
        1.0, "how far ahead of this node's clock the stamp of a cloud may be [s]", low=0.0, high=3600.0
    )
    check_age: bool = parameter(False, "reject clouds older than max_age; not for replaying with original stamps")
    max_age: float = parameter(2.0, "oldest acceptable cloud [s], if check_age", low=0.001, high=86400.0)
    quiet_after: float = parameter(5.0, "without a cloud for so long the diagnostics warn [s]", low=0.1, high=86400.0)

    def __post_init__(self) -> None:
        if not self.table_frame:
            raise InvalidInputError("parameter table_frame is empty; need the name of a frame, such as table")
        self.segmentation(self.camera_pose)

    @property
    def camera_pose(self) -> FloatArray:
        """4x4 ``table_from_camera`` of the parameters.

        Raises:
            InvalidInputError: not three and four finite numbers, or no unit quaternion.
        """
        try:
            return pose_matrix(self.camera_position, self.camera_quaternion)
        except InvalidInputError as error:
            raise InvalidInputError(f"parameters camera_position, camera_quaternion: {error.message}") from None

    def segmentation(self, table_from_camera: FloatArray | None) -> SegmentationParameters:
        """What the library is called with; the pose is None with ``plane_fit``.

        Raises:
            InvalidInputError: parameters that contradict each other.
        """
        if len(self.workspace) != 4:
            raise InvalidInputError(f"parameter workspace has {len(self.workspace)} numbers, need 4")
        x_min, x_max, y_min, y_max = self.workspace
        automatic = self.automatic_tolerances
        return SegmentationParameters(
            table_from_camera=table_from_camera,
            workspace=(x_min, x_max, y_min, y_max) if self.crop_to_workspace else None,
            tolerance=None if automatic else self.tolerance,
            outline_tolerance=None if automatic else self.outline_tolerance,
            min_size=self.min_size,
            max_size=self.max_size,
            min_height=self.min_height,
            max_height=self.max_height,
            split_touching=self.split_touching,
            max_points=self.max_points,
        )
