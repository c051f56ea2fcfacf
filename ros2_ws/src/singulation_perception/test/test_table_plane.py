"""Which plane counts as the table, and what is said about one that does not."""

from dataclasses import replace

import numpy as np
import pytest
from ros2_ws.src.singulation_perception.test.table_top import CELL, PARAMETERS, box, cloud

from singulation_core import ResultCode, SingulationError
from singulation_perception import segment_cloud
from singulation_perception.raster import raster_of
from singulation_perception.table_plane import find_table

BLOCKS = (box(0.0, 0.0, 0.05, 0.05), 0.03), (box(0.05, 0.09, 0.04, 0.03), 0.02)


@pytest.mark.parametrize(
    ("points", "words"),
    [(cloud(*BLOCKS, table=-0.015), r"-15\.0 mm"), (cloud(*BLOCKS, table=0.015), r"\+15\.0 mm"),
     (cloud(*BLOCKS, tilt=np.radians(4.0)), r"by 4\.0\d degrees")],
    ids=["floor of a bin", "lifted", "tilted"],
)  # fmt: skip
def test_a_plane_that_is_not_the_expected_one_is_named(points, words):
    with pytest.raises(SingulationError, match=words) as refusal:
        segment_cloud(points, PARAMETERS)
    assert refusal.value.code == ResultCode.WRONG_TABLE
    assert len(segment_cloud(cloud(*BLOCKS), PARAMETERS).arrangement) == 2


def test_a_cloud_without_a_plane_has_no_table():
    points = cloud(noise=0.03)
    with pytest.raises(SingulationError) as refusal:
        segment_cloud(points, PARAMETERS)
    assert refusal.value.code == ResultCode.NO_TABLE


def test_a_small_offset_and_tilt_are_fitted_and_reported():
    table = segment_cloud(cloud(*BLOCKS, table=0.004, tilt=np.radians(0.5)), PARAMETERS).table
    assert table.offset == pytest.approx(0.004, abs=0.0005)
    assert np.degrees(table.tilt) == pytest.approx(0.5, abs=0.05)
    assert table.noise == pytest.approx(0.0001, rel=0.3)


def test_without_an_expected_table_the_frame_comes_from_the_plane():
    seen = segment_cloud(cloud(*BLOCKS), replace(PARAMETERS, table_from_camera=None, workspace=None))
    assert len(seen.arrangement) == 2
    assert sorted(item.height for item in seen.arrangement.objects) == pytest.approx([0.02, 0.03], abs=0.0005)
    assert seen.table.table_from_camera[2, 3] == pytest.approx(CELL.table_from_camera[2, 3], abs=0.001)


def test_the_last_table_is_kept_where_it_holds_and_given_up_where_it_does_not():
    first = segment_cloud(cloud(*BLOCKS), PARAMETERS).table
    again = segment_cloud(cloud(*BLOCKS), PARAMETERS, first).table
    assert again.offset == pytest.approx(first.offset, abs=1e-5)
    moved = segment_cloud(cloud(*BLOCKS, table=0.006), PARAMETERS, first).table
    assert moved.offset == pytest.approx(0.006, abs=0.0005)


@pytest.mark.parametrize("layout", ["padded", "wide points", "backwards", "every second number"])
def test_any_strides_are_read_in_place(layout):
    points = cloud(*BLOCKS)
    height, width, _ = points.shape
    if layout == "padded":
        strange = np.zeros((height, width + 5, 3), dtype=np.float32)[:, :width]
    elif layout == "wide points":
        strange = np.zeros((height, width, 8), dtype=np.float32)[:, :, 1:4]
    elif layout == "backwards":
        strange = np.zeros((height, width, 3), dtype=np.float32)[:, ::-1]
    else:
        strange = np.zeros((height, width, 6), dtype=np.float32)[:, :, ::2]
    strange[...] = points
    expected, found = (find_table(raster_of(one), PARAMETERS).table_from_camera for one in (points, strange))
    assert np.array_equal(expected, found)
    assert len(segment_cloud(strange, PARAMETERS).arrangement) == 2
