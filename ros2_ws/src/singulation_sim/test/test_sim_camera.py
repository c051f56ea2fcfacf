"""The simulated camera against what geometry says."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from singulation_core import Arrangement, CellGeometry, PlanarObject
from singulation_core.polygon import contains, convex_hull, separation
from singulation_core.transforms import inverse, transform_points
from singulation_sim.camera import PHOXI_FULL, PHOXI_SMALL, CameraModel, PhoxiCamera, RobotShape, SensorDefects
from singulation_sim.camera.model import rays
from yumi_push_executor.kinematics import YumiArm

CELL = CellGeometry()
TINY = CameraModel(129, 97, 140.0, (64.0, 48.0))
PERFECT = SensorDefects.none()
SQUARE = np.array(((-0.03, -0.03), (0.03, -0.03), (0.03, 0.03), (-0.03, 0.03)))
BLOCK = PlanarObject(1, SQUARE, 0.04)
EMPTY = Arrangement([])


def in_table(points: NDArray[np.float32]) -> NDArray[np.float64]:
    """(M, 3) measured points in the table frame."""
    measured = points[points[..., 2] > 0.0].astype(np.float64)
    return transform_points(CELL.table_from_camera, measured)


@pytest.mark.parametrize("model", [PHOXI_SMALL, PHOXI_FULL])
def test_size_and_optics(model: CameraModel) -> None:
    points = PhoxiCamera(CELL, model, PERFECT).capture(EMPTY)
    assert points.shape == (model.height, model.width, 3)
    assert points.dtype == np.float32
    row, column = 100, 900
    x, y, z = points[row, column]
    assert x / z * model.focal + model.centre[0] == pytest.approx(column, abs=1e-3)
    assert y / z * model.focal + model.centre[1] == pytest.approx(row, abs=1e-3)


def test_the_table_is_where_the_cell_says() -> None:
    points = in_table(PhoxiCamera(CELL, TINY, PERFECT).capture(EMPTY))
    assert np.abs(points[:, 2]).max() < 1e-6
    # The optical axis meets the table below the camera, leant by its tilt.
    centre = PhoxiCamera(CELL, TINY, PERFECT).capture(EMPTY)[48, 64]
    assert np.linalg.norm(centre) == pytest.approx(0.9 / np.cos(np.deg2rad(6.0)), abs=1e-5)


def test_the_table_ends_somewhere() -> None:
    camera = PhoxiCamera(CELL, TINY, PERFECT, table_size=(0.2, 0.3))
    points = in_table(camera.capture(EMPTY))
    top = points[points[:, 2] > -1e-5]
    assert np.abs(top[:, :2]).max(axis=0) == pytest.approx([0.1, 0.15], abs=0.01)


def test_a_block_has_its_height_and_its_outline() -> None:
    points = in_table(PhoxiCamera(CELL, PHOXI_SMALL, PERFECT).capture(Arrangement([BLOCK])))
    top = points[points[:, 2] > 0.04 - 1e-5]
    assert top[:, 2] == pytest.approx(0.04, abs=1e-6)
    pitch = 0.87 / 1122.0
    assert np.ptp(top[:, :2], axis=0) == pytest.approx([0.06, 0.06], abs=1.5 * pitch)
    assert len(top) == pytest.approx((0.06 / pitch) ** 2, rel=0.03)


@st.composite
def blocks(draw: st.DrawFn) -> PlanarObject:
    """A random convex block that fits on the table."""
    seed = draw(st.integers(0, 10**6))
    rng = np.random.default_rng(seed)
    outline = convex_hull(rng.uniform(-0.06, 0.06, (draw(st.integers(3, 9)), 2)))
    area_ok = len(outline) >= 3 and np.ptp(outline, axis=0).min() > 0.01
    return PlanarObject(1, (outline if area_ok else SQUARE) + rng.uniform(-0.1, 0.1, 2), rng.uniform(0.005, 0.08))


@settings(max_examples=60, deadline=None)
@given(blocks())
def test_every_point_is_on_a_surface(block: PlanarObject) -> None:
    points = in_table(PhoxiCamera(CELL, TINY, PERFECT).capture(Arrangement([block])))
    on_table = np.abs(points[:, 2]) < 1e-6
    on_top = np.abs(points[:, 2] - block.height) < 1e-6
    assert not contains(block.outline, points[on_table][:, :2], margin=1e-6).any()
    assert contains(block.outline, points[on_top][:, :2], margin=-1e-6).all()
    walls = points[~on_table & ~on_top]
    assert ((walls[:, 2] > 0.0) & (walls[:, 2] < block.height)).all()
    assert contains(block.outline, walls[:, :2], margin=-1e-6).all()
    assert not contains(block.outline, walls[:, :2], margin=1e-6).any()


@settings(max_examples=30, deadline=None)
@given(blocks())
def test_nothing_is_seen_through_a_block(block: PlanarObject) -> None:
    camera = inverse(CELL.table_from_camera)
    cloud = PhoxiCamera(CELL, TINY, PERFECT).capture(Arrangement([block]))
    directions = rays(TINY).astype(np.float64)
    # Where the ray passes through the interior of the top face, the top face is what is measured.
    normal, offset = camera[:3, 2], float(camera[:3, 2] @ camera[:3, 3]) + block.height
    at = directions * (offset / (directions @ normal))[..., None]
    through = contains(block.outline, transform_points(CELL.table_from_camera, at).reshape(-1, 3)[:, :2], margin=1e-5)
    difference = np.abs(cloud.reshape(-1, 3) - at.reshape(-1, 3)).max(axis=1)
    assert (difference[through] < 1e-5).all()


def test_noise_is_along_the_ray_and_as_large_as_told() -> None:
    defects = SensorDefects(noise=2e-4, edge_loss=0.0, flying=0.0, random_loss=0.0, grazing=0.0, shadows=False)
    noisy = PhoxiCamera(CELL, PHOXI_SMALL, defects).capture(EMPTY)
    clean = PhoxiCamera(CELL, PHOXI_SMALL, PERFECT).capture(EMPTY)
    error = noisy - clean
    along = (error * rays(PHOXI_SMALL)).sum(axis=-1)
    assert along.std() == pytest.approx(2e-4, rel=0.02)
    assert along.mean() == pytest.approx(0.0, abs=2e-6)
    assert np.abs(error - along[..., None] * rays(PHOXI_SMALL)).max() < 1e-6


def test_the_same_seed_gives_the_same_clouds_in_turn() -> None:
    def two(seed: int) -> NDArray[np.float32]:
        camera = PhoxiCamera(CELL, TINY, seed=seed)
        return np.stack([camera.capture(Arrangement([BLOCK])) for _ in range(2)])

    first = two(3)
    assert (two(3) == first).all()
    assert (two(4) != first).any()
    assert (first[0] != first[1]).any()


def test_random_loss_has_its_share() -> None:
    defects = SensorDefects(random_loss=0.1, edge_loss=0.0, flying=0.0)
    points = PhoxiCamera(CELL, PHOXI_SMALL, defects).capture(EMPTY)
    assert (points[..., 2] == 0.0).mean() == pytest.approx(0.1, abs=0.005)


def test_the_shadow_lies_where_the_projector_does_not_reach() -> None:
    only_shadows = SensorDefects(noise=0.0, edge_loss=0.0, flying=0.0, random_loss=0.0, grazing=0.0)
    lit = PhoxiCamera(CELL, PHOXI_SMALL, only_shadows).capture(Arrangement([BLOCK]))
    seen = PhoxiCamera(CELL, PHOXI_SMALL, PERFECT).capture(Arrangement([BLOCK]))
    dark = (lit[..., 2] == 0.0) & (seen[..., 2] > 0.0)
    points = transform_points(CELL.table_from_camera, seen[dark].astype(np.float64))
    on_table = points[points[:, 2] < 1e-5]
    # The projector is 0.23 m along the image rows (table -y) and 0.9 m high: a top edge of 40 mm at y = 0.03 throws
    # its shadow to y = 0.03 + 0.04 * (0.03 + 0.23) / (0.9 - 0.04).
    assert on_table[:, 1].max() == pytest.approx(0.03 + 0.04 * 0.26 / 0.86, abs=1e-3)
    assert on_table[:, 1].min() > 0.03 - 1e-3
    assert len(on_table) > 500


def test_lost_and_flying_pixels_are_at_edges() -> None:
    all_lost = SensorDefects(noise=0.0, edge_loss=1.0, flying=0.0, random_loss=0.0, grazing=0.0, shadows=False)
    points = PhoxiCamera(CELL, PHOXI_SMALL, all_lost).capture(Arrangement([BLOCK]))
    assert 300 < (points[..., 2] == 0.0).sum() < 3000
    all_fly = SensorDefects(noise=0.0, edge_loss=0.0, flying=1.0, random_loss=0.0, grazing=0.0, shadows=False)
    flying = in_table(PhoxiCamera(CELL, PHOXI_SMALL, all_fly).capture(Arrangement([BLOCK])))
    between = flying[(flying[:, 2] > 0.001) & (flying[:, 2] < 0.039)]
    assert len(between) > 300
    spread = [separation(np.vstack((p, p + (1e-5, 0.0), p + (0.0, 1e-5))), SQUARE) for p in between[::10, :2]]
    assert max(spread) < 0.006


def test_grazing_walls_are_lost() -> None:
    walls_seen = in_table(PhoxiCamera(CELL, PHOXI_SMALL, PERFECT).capture(Arrangement([BLOCK])))
    strict = SensorDefects(noise=0.0, edge_loss=0.0, flying=0.0, random_loss=0.0, grazing=0.3, shadows=False)
    walls_lost = in_table(PhoxiCamera(CELL, PHOXI_SMALL, strict).capture(Arrangement([BLOCK])))
    middle = [((item[:, 2] > 0.005) & (item[:, 2] < 0.035)).sum() for item in (walls_seen, walls_lost)]
    assert middle[0] > 100
    assert middle[1] == 0


def test_invalid_pixels_are_zero_or_nan() -> None:
    zeros = PhoxiCamera(CELL, TINY, seed=1).capture(Arrangement([BLOCK]))
    nans = PhoxiCamera(CELL, TINY, seed=1, invalid=float("nan")).capture(Arrangement([BLOCK]))
    lost = (zeros == 0.0).all(axis=-1)
    assert lost.any()
    assert (np.isnan(nans).all(axis=-1) == lost).all()
    assert (nans[~lost] == zeros[~lost]).all()


def test_an_arm_over_the_table_hides_it_and_at_home_it_does_not() -> None:
    shape = RobotShape()
    body_to_table = inverse(CELL.body_from_table)

    def cloud(left: NDArray[np.float64]) -> NDArray[np.float64]:
        joints = {"left": left, "right": YumiArm("right").clear_view}
        robot = [solid.moved(body_to_table) for solid in shape.solids(joints, {"left": 0.0, "right": 0.02})]
        return in_table(PhoxiCamera(CELL, PHOXI_SMALL, PERFECT).capture(Arrangement([BLOCK]), robot))

    home, over = (
        cloud(YumiArm("left").clear_view),
        cloud(np.deg2rad([-62.62, -20.31, 36.71, 44.91, 78.61, 74.79, -90.07])),
    )
    inside = [
        points[(np.abs(points[:, 0]) < 0.16) & (np.abs(points[:, 1]) < 0.21) & (points[:, 2] > 0.05)]
        for points in (home, over)
    ]
    assert len(inside[0]) == 0
    assert len(inside[1]) > 10_000


def test_fingertips_of_the_shape_are_where_the_kinematics_say() -> None:
    arm = YumiArm("left")
    joints = {name: YumiArm(name).clear_view for name in ("left", "right")}
    corners = {opening: _fingers(RobotShape(), joints, opening) for opening in (0.0, 0.05)}
    tip = arm.tip(joints["left"])
    for opening, points in corners.items():
        local = transform_points(inverse(tip), points)
        assert local[:, 2].max() == pytest.approx(0.0, abs=5e-4)
        assert np.ptp(local[np.abs(local[:, 2]) < 1e-3][:, 0]) == pytest.approx(opening + 0.0124, abs=1e-3)


def _fingers(shape: RobotShape, joints: dict[str, NDArray[np.float64]], opening: float) -> NDArray[np.float64]:
    """Corners of the left fingers' solids in ``yumi_body``: those that end near the tips."""
    solids = shape.solids(joints, {"left": opening, "right": 0.0})
    left = YumiArm("left").tip(joints["left"])[:3, 3]
    near = [one.corners for one in solids if np.linalg.norm(one.corners - left, axis=1).min() < 0.035]
    return np.vstack(near)
