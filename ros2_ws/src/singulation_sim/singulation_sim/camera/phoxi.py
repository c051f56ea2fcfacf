"""The camera: what is in front of it becomes an organized point cloud."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from singulation_core import Arrangement, CellGeometry
from singulation_core.polygon import FloatArray
from singulation_core.transforms import inverse, transform_points
from singulation_sim.camera import raycast
from singulation_sim.camera.defects import SensorDefects, add_defects
from singulation_sim.camera.model import PHOXI_SMALL, CameraModel, rays
from singulation_sim.camera.solid import Solid, block_solid, box_solid

_TABLE_THICKNESS = 0.03  # m
_BASELINE = 0.23  # m from camera to projector, along the image rows


class PhoxiCamera:
    """Organized clouds of a table scene, seeded: the n-th capture of a camera repeats exactly.

    Args:
        cell: where the camera hangs.
        model: image size and optics.
        defects: noise and losses.
        table_size: extent of the table top in x and y of ``table`` [m]; beyond it nothing is seen.
        invalid: value of all three coordinates of a pixel without measurement: 0 (official driver) or NaN.
        baseline: camera to projector, along the image rows [m].
        seed: of everything random.
    """

    def __init__(
        self,
        cell: CellGeometry | None = None,
        model: CameraModel = PHOXI_SMALL,
        defects: SensorDefects | None = None,
        *,
        table_size: tuple[float, float] = (0.8, 1.2),
        invalid: float = 0.0,
        baseline: float = _BASELINE,
        seed: int = 0,
    ) -> None:
        self.model = model
        self.defects = defects or SensorDefects()
        self._table_from_camera = (cell or CellGeometry()).table_from_camera
        self._camera_from_table = inverse(self._table_from_camera)
        self._projector = np.array((baseline, 0.0, 0.0))
        half = (table_size[0] / 2.0, table_size[1] / 2.0, _TABLE_THICKNESS / 2.0)
        self._table = box_solid(half, (0.0, 0.0, -_TABLE_THICKNESS / 2.0))
        self._invalid = np.float32(invalid)
        self._rng = np.random.default_rng(seed)

    def capture(self, arrangement: Arrangement, others: Sequence[Solid] = ()) -> NDArray[np.float32]:
        """(H, W, 3) points in ``phoxi_camera_sensor`` [m].

        Args:
            arrangement: blocks in ``table``.
            others: further solids in ``table``, such as the robot.
        """
        blocks = [block_solid(item) for item in arrangement.objects if item.height > 0.0]
        occluders = [solid.moved(self._camera_from_table) for solid in (*blocks, *others)]
        distance, cosine, lit = self._look([self._table.moved(self._camera_from_table)], occluders)
        measured = add_defects(distance, cosine, lit, self.defects, self._rng)
        points = rays(self.model) * measured[..., None]
        if self._invalid != 0.0:
            points[measured == 0.0] = self._invalid
        return points

    def _look(
        self, ground: Sequence[Solid], occluders: Sequence[Solid]
    ) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.bool_]]:
        """Distance, cosine of incidence and lit pixels, (H, W) each."""
        size = (self.model.height, self.model.width)
        directions = rays(self.model)
        distance, cosine = np.full(size, np.inf, dtype=np.float32), np.ones(size, dtype=np.float32)
        solids = [*ground, *occluders]
        raycast.cast(directions, _packed(solids, [self._window(one.corners) for one in solids]), distance, cosine)
        lit = np.isfinite(distance)
        if self.defects.shadows and occluders:
            shadows = _packed(occluders, [self._shadow_window(one.corners) for one in occluders])
            raycast.shade(directions, shadows, distance, self._projector, lit)
        return distance, cosine, lit

    def _window(self, corners: FloatArray) -> tuple[int, int, int, int]:
        """First and last + 1 row and column in which points of the convex hull of the corners can be seen."""
        model = self.model
        if not (corners[:, 2].min() > 1e-3):  # reaches behind the camera
            return (0, model.height, 0, model.width) if corners[:, 2].max() > 1e-3 else (0, 0, 0, 0)
        columns = corners[:, 0] / corners[:, 2] * model.focal + model.centre[0]
        rows = corners[:, 1] / corners[:, 2] * model.focal + model.centre[1]
        top, left = int(np.floor(rows.min())), int(np.floor(columns.min()))
        bottom, right = int(np.ceil(rows.max())) + 1, int(np.ceil(columns.max())) + 1
        clip = (max(top, 0), min(bottom, model.height), max(left, 0), min(right, model.width))
        return clip if clip[0] < clip[1] and clip[2] < clip[3] else (0, 0, 0, 0)

    def _shadow_window(self, corners: FloatArray) -> tuple[int, int, int, int]:
        """As ``_window``, of the solid and its shadow on the table."""
        projector = transform_points(self._table_from_camera, self._projector)
        above = transform_points(self._table_from_camera, corners)
        drop = projector[2] - above[:, 2]
        if not (drop.min() > 1e-3):  # reaches as high as the projector: the shadow may fall anywhere
            return 0, self.model.height, 0, self.model.width
        on_table = projector + (above - projector) * (projector[2] / drop)[:, None]
        return self._window(np.vstack((corners, transform_points(self._camera_from_table, on_table))))


def warm_up() -> None:
    """Load or compile the ray casting now rather than at the first cloud."""
    camera = PhoxiCamera(model=CameraModel(8, 6, 10.0, (4.0, 3.0)))
    camera.capture(Arrangement([]), [box_solid((0.01, 0.01, 0.01))])


def _packed(solids: Sequence[Solid], windows: Sequence[tuple[int, int, int, int]]) -> raycast.Solids:
    """Solids with the window that concerns each."""
    starts = np.cumsum([0, *(len(solid.offsets) for solid in solids)], dtype=np.int64)
    planes = np.vstack([np.column_stack((one.normals, one.offsets)) for one in solids])
    return raycast.Solids(planes, starts, np.array(windows, dtype=np.int64))
