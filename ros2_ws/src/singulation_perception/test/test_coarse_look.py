"""Every few rows are read first; what belongs to blocks must be found as if every row had been read."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from ros2_ws.src.singulation_perception.test.table_top import PARAMETERS, box, cloud

from singulation_perception.coarse_look import BLOCK, marked_blocks, rows_between
from singulation_perception.point_collection import object_points
from singulation_perception.raster import raster_of
from singulation_perception.table_plane import find_table

_LOWEST, _STEP = 0.004, 0.0015

places = st.floats(-0.08, 0.08)
sides = st.floats(0.006, 0.05)
blocks = st.tuples(places, places, sides, sides, st.floats(0.0, np.pi), st.floats(0.008, 0.05))


def collected(points, stride):
    raster = raster_of(points)
    table = find_table(raster, PARAMETERS)
    return object_points(raster, table.table_from_camera, PARAMETERS.workspace, table.columns, _LOWEST, _STEP, stride)


@settings(deadline=None, max_examples=60)
@given(st.lists(blocks, min_size=1, max_size=4), st.integers(2, 6))
def test_no_point_of_a_block_is_missed(described, stride):
    points = cloud(*((box(x, y, width, depth, turn), top) for x, y, width, depth, turn, top in described))
    every, found = collected(points, 1), collected(points, stride)
    assert len(every.xyz) > 0
    np.testing.assert_array_equal(found.xyz, every.xyz)
    np.testing.assert_array_equal(found.runs, every.runs)
    np.testing.assert_allclose(found.spans, every.spans)


def test_points_that_drivers_send_as_zeros_are_nowhere():
    points = cloud((box(0.0, 0.0, 0.04, 0.04), 0.03))
    holed = points.copy()
    holed[:60] = 0.0
    holed[::7, ::5] = 0.0
    gone = points.copy()
    gone[:60] = np.nan
    gone[::7, ::5] = np.nan
    zeros, nothing = collected(holed, 4), collected(gone, 4)
    np.testing.assert_array_equal(zeros.xyz, nothing.xyz)
    assert zeros.outside == nothing.outside == 0


def test_bare_table_is_not_read_again():
    raster = raster_of(cloud((box(0.0, 0.0, 0.03, 0.03), 0.03)))
    table = find_table(raster, PARAMETERS)
    marks = marked_blocks(raster, table.columns, table.table_from_camera[:3].astype(np.float32), _LOWEST, 5)
    shown = 30 / raster.width * 30 / raster.height
    assert marks.shape == (-(-raster.height // 5), -(-raster.width // BLOCK))
    assert shown < marks.mean() < 6.0 * shown


def test_rows_are_nearer_than_the_narrowest_block_is_wide():
    raster = raster_of(cloud())
    pitch = find_table(raster, PARAMETERS).pitch
    assert 0.00098 < pitch < 0.0012  # the camera of ``table_top`` sees a point every millimetre
    for width in (0.0005, 0.003, 0.006, 0.1):
        rows = rows_between(raster, pitch, width)
        assert rows == 1 or rows * pitch < width
    assert rows_between(raster, 0.0, 0.006) == 1
    assert rows_between(raster_of(cloud().reshape(1, -1, 3)), pitch, 0.006) == 1


def test_rows_in_which_no_two_neighbours_hang_together_fit():
    """Every point is a run of its own then."""
    points = cloud((box(0.0, 0.0, 0.2, 0.2), 0.03))
    spikes = points.copy()
    spikes[:, ::2, 2] -= 0.01
    found = collected(spikes, 1)
    assert len(found.runs) > 0.9 * len(found.xyz) > 30_000
