"""The compiled pass over a cloud against the same said plainly, point by point."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from singulation_perception.point_collection import object_points
from singulation_perception.raster import raster_of

LOWEST, STEP = 0.004, 0.002
LEVELS = np.array((0.0, 0.001, 0.01, 0.0115, 0.014, 0.0161, 0.03, np.nan, np.inf, 200.0))
WORKSPACE = (-0.1, 0.15, -0.2, 0.1)


@st.composite
def clouds(draw):
    """(H, W, 3) of a camera that looks along the table's z, with a place that is seen by it, or not, at every pixel."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    height, width, extra = draw(st.integers(1, 9)), draw(st.integers(1, 90)), draw(st.sampled_from((0, 1, 4)))
    cloud = np.zeros((height, width, 3 + extra), dtype=np.float32)[..., :3]
    cloud[..., :2] = random.uniform(-0.25, 0.25, (height, width, 2)) * draw(st.sampled_from((0.1, 0.5, 1.0)))
    usual = np.full((height, width), draw(st.integers(0, len(LEVELS) - 1)))
    strange = random.random((height, width)) < draw(st.sampled_from((0.0, 0.1, 0.6)))
    cloud[..., 2] = LEVELS[np.where(strange, random.integers(0, len(LEVELS), (height, width)), usual)] + 0.5
    cloud[random.random((height, width)) < 0.02] = 0.0
    return cloud


def plainly(cloud, columns, pose, workspace):
    """Points, runs and how many points lie outside, one after the other."""
    points, runs, outside = [], [], 0
    for row, column in np.ndindex(cloud.shape[:2]):
        if not (columns[row, 0] <= column < columns[row, 1]):
            continue
        place = cloud[row, column].astype(np.float32)
        if not np.isfinite(place).all() or not place.any():
            continue
        x, y, z = (pose[:, :3] * place).sum(axis=1) + pose[:, 3]
        if not (LOWEST < z < 100.0):
            continue
        if workspace and not (workspace[0] <= x <= workspace[1] and workspace[2] <= y <= workspace[3]):
            outside += 1
            continue
        goes_on = runs and runs[-1][0] == row and runs[-1][2] == column and abs(points[-1][2] - z) <= STEP
        if goes_on:
            runs[-1][2] += 1
        else:
            runs.append([row, column, column + 1, len(points)])
        points.append((x, y, z))
    return np.array(points).reshape(-1, 3), np.array(runs).reshape(-1, 4), outside


@st.composite
def poses(draw):
    """(4, 4) of a camera half a metre away, turned about its line of sight and a little beside it."""
    spin, tilt, shift = draw(st.floats(-3.0, 3.0)), draw(st.sampled_from((0.0, 0.01))), draw(st.floats(-0.05, 0.05))
    turned, tilted = np.eye(3), np.eye(3)
    turned[:2, :2] = (np.cos(spin), -np.sin(spin)), (np.sin(spin), np.cos(spin))
    tilted[1:, 1:] = (np.cos(tilt), -np.sin(tilt)), (np.sin(tilt), np.cos(tilt))
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = tilted @ turned, (shift, -shift, -0.5)
    return pose


@st.composite
def limits(draw, cloud):
    """(H, 2) first column and column after the last to look at."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    columns = np.sort(random.integers(0, cloud.shape[1] + 1, (len(cloud), 2)), axis=1).astype(np.int32)
    return columns if draw(st.booleans()) else np.tile(np.array((0, cloud.shape[1]), dtype=np.int32), (len(cloud), 1))


@settings(max_examples=200)
@given(data=st.data(), cloud=clouds(), workspace=st.sampled_from((None, WORKSPACE)), pose=poses())
def test_points_runs_and_spans_are_those_found_one_by_one(data, cloud, workspace, pose):
    columns = data.draw(limits(cloud))
    seen = object_points(raster_of(cloud), pose, workspace, columns, LOWEST, STEP)
    points, runs, outside = plainly(cloud, columns, pose[:3].astype(np.float32), workspace)
    assert seen.outside == outside
    assert seen.runs.tolist() == runs.tolist()
    np.testing.assert_allclose(seen.xyz, points, atol=1e-6)
    for (_, start, stop, first), span in zip(runs, seen.spans, strict=True):
        heights = seen.xyz[first : first + stop - start, 2].astype(np.float64)
        np.testing.assert_allclose(span[:2], (heights.min(), heights.max()), rtol=0.0, atol=0.0)
        np.testing.assert_allclose(span[2:], (heights.sum(), (heights**2).sum()), rtol=1e-5)
