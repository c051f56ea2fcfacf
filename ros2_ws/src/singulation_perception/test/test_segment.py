"""From cloud to polygons, on blocks whose place is known."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from singulation_core import CellGeometry, ResultCode, SingulationError
from singulation_core.transforms import inverse, transform_points
from singulation_perception import SegmentationParameters, segment

CELL = CellGeometry()
PARAMETERS = SegmentationParameters(table_from_camera=CELL.table_from_camera, workspace=CELL.workspace)
PITCH = 0.001


def cloud(*blocks, noise=0.0001, table=0.0):
    """(H, W, 3) camera points of a table with upright square blocks (x, y, side, height), seen from straight above."""
    rng = np.random.default_rng(1)
    x, y = np.meshgrid(np.arange(-0.2, 0.2, PITCH), np.arange(-0.25, 0.25, PITCH))
    z = np.full(x.shape, table)
    for centre_x, centre_y, side, height in blocks:
        z[(abs(x - centre_x) <= side / 2) & (abs(y - centre_y) <= side / 2)] = table + height
    points = np.stack((x, y, z + rng.normal(0.0, noise, x.shape)), axis=-1)
    return transform_points(inverse(CELL.table_from_camera), points).astype(np.float32)


BLOCKS = ((0.05, 0.0, 0.04, 0.03), (-0.05, 0.08, 0.05, 0.02), (-0.03, -0.1, 0.03, 0.04))


def expect_blocks(seen, blocks):
    assert len(seen) == len(blocks)
    for x, y, side, height in blocks:
        item = min(seen.objects, key=lambda item: np.hypot(*(item.centroid - (x, y))))
        assert np.hypot(*(item.centroid - (x, y))) < 0.0015
        assert item.area == pytest.approx(side**2, rel=0.12)
        assert item.height == pytest.approx(height, abs=0.001)
        assert len(item.outline) == 4


@pytest.mark.parametrize("flat", [False, True], ids=["organized", "flat"])
def test_blocks_are_where_they_are(flat):
    points = cloud(*BLOCKS)
    expect_blocks(segment(points.reshape(-1, 3) if flat else points, PARAMETERS), BLOCKS)


@pytest.mark.parametrize("invalid", [np.nan, np.inf, 0.0])
def test_invalid_points_do_not_matter(invalid):
    points = cloud(*BLOCKS)
    points[np.random.default_rng(2).random(points.shape[:2]) < 0.03] = invalid
    expect_blocks(segment(points, PARAMETERS), BLOCKS)


@pytest.mark.parametrize("room", [8, 3000], ids=["no room for runs", "no room for points"])
def test_more_points_than_usual_change_nothing(monkeypatch, room):
    """What is set aside for points and runs at first is too small; all of it is collected again with room for all."""
    points = cloud(*BLOCKS)
    usual = segment(points, PARAMETERS)
    monkeypatch.setattr("singulation_perception.point_collection._ROOM", room)
    crowded = segment(points, PARAMETERS)
    assert [one.point_count for one in crowded.objects] == [one.point_count for one in usual.objects]
    for one, other in zip(crowded.objects, usual.objects, strict=True):
        np.testing.assert_array_equal(one.outline, other.outline)
    expect_blocks(crowded, BLOCKS)


def test_a_bare_table_is_no_objects_and_no_error():
    assert len(segment(cloud(), PARAMETERS)) == 0


def test_what_lies_outside_the_workspace_is_left_out():
    assert len(segment(cloud((0.05, 0.0, 0.04, 0.03), (0.05, 0.235, 0.02, 0.03)), PARAMETERS)) == 1


@pytest.mark.parametrize(
    ("points", "codes"),
    [
        (np.full((40, 50, 3), np.nan, dtype=np.float32), {ResultCode.NO_POINTS}),
        (np.zeros((40, 50, 3), dtype=np.float32), {ResultCode.NO_POINTS}),
        (np.zeros((0, 3), dtype=np.float32), {ResultCode.NO_POINTS}),
        (1000.0 * cloud(*BLOCKS), {ResultCode.NOT_METRES}),
        (cloud(*BLOCKS, table=-0.3), {ResultCode.NO_TABLE, ResultCode.WRONG_TABLE}),
        (np.full((40, 50, 3), (0.0, 0.0, 0.905), dtype=np.float32), {ResultCode.NO_TABLE, ResultCode.WRONG_TABLE}),
    ],
    ids=["all NaN", "all zero", "empty", "millimetres", "table too low", "one point"],
)
def test_what_cannot_be_a_table_scene_is_refused_and_the_next_good_one_read(points, codes):
    with pytest.raises(SingulationError) as refusal:
        segment(points, PARAMETERS)
    assert refusal.value.code in codes
    assert refusal.value.message
    expect_blocks(segment(cloud(*BLOCKS), PARAMETERS), BLOCKS)


@given(st.integers(0, 10**6))
@settings(max_examples=15, deadline=None)
def test_noise_without_order_never_throws_anything_uncoded(seed):
    points = np.random.default_rng(seed).normal(0.0, 1.0, (30, 40, 3)).astype(np.float32)
    try:
        segment(points, PARAMETERS)
    except SingulationError as error:
        assert error.message
