import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from singulation_core import InvalidInputError
from singulation_perception.clustering import euclidean_clusters


def partition(labels):
    """Sets of indices, whatever the numbers of the labels."""
    return {frozenset(np.flatnonzero(labels == label).tolist()) for label in np.unique(labels) if label >= 0}


def reference(points, tolerance):
    """Connected components of all pairs nearer than the tolerance, in single precision as PCL reckons: points in rows
    may be exactly that far apart.
    """
    pairs = cKDTree(points.astype(np.float64)).query_pairs(1.001 * tolerance, output_type="ndarray")
    x, y, z = (points[pairs[:, 0]] - points[pairs[:, 1]]).T
    pairs = pairs[x * x + y * y + z * z < np.float32(tolerance * tolerance)]
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(points),) * 2)
    return partition(connected_components(graph, directed=False)[1])


@given(st.integers(0, 10**6), st.integers(1, 300), st.floats(0.002, 0.05))
@settings(max_examples=60, deadline=None)
def test_the_partition_is_that_of_the_tolerance_graph(seed, count, tolerance):
    points = np.random.default_rng(seed).uniform(-0.1, 0.1, (count, 3)).astype(np.float32)
    labels = euclidean_clusters(points, tolerance, 1, count)
    assert labels.shape == (count,)
    assert labels.dtype == np.int32
    assert partition(labels) == reference(points, tolerance)


def test_it_agrees_with_open3d():
    from open3d.geometry import PointCloud
    from open3d.utility import Vector3dVector

    points = np.random.default_rng(3).normal(0.0, 0.05, (2000, 3)).astype(np.float32)
    theirs = np.asarray(PointCloud(Vector3dVector(points.astype(np.float64))).cluster_dbscan(0.006, 1))
    assert partition(euclidean_clusters(points, 0.006, 1, 2000)) == partition(theirs)


@pytest.mark.parametrize(("smallest", "largest", "sizes"), [(1, 99, [1, 3, 5]), (2, 99, [3, 5]), (1, 4, [1, 3])])
def test_too_small_and_too_large_clusters_are_left_out(smallest, largest, sizes):
    groups = [np.full((size, 3), place, dtype=np.float32) for place, size in ((0.0, 1), (1.0, 3), (2.0, 5))]
    labels = euclidean_clusters(np.concatenate(groups), 0.01, smallest, largest)
    assert sorted(len(part) for part in partition(labels)) == sizes
    assert (labels == -1).sum() == 9 - sum(sizes)


@given(st.integers(0, 10**6), st.floats(0.001, 0.02))
@settings(max_examples=30, deadline=None)
@example(222, 0.001)
@example(222, 0.0012)
def test_points_in_rows_as_a_camera_sends_them(seed, tolerance):
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(0.0, 0.06, 0.001), np.arange(0.0, 0.05, 0.0012))
    z = 0.02 * random.integers(0, 3, (8, 8)).repeat(6, axis=0).repeat(8, axis=1)[: x.shape[0], : x.shape[1]]
    points = np.stack((x, y, z + random.normal(0.0, 0.0004, x.shape)), axis=-1).reshape(-1, 3).astype(np.float32)
    points = points[random.uniform(size=len(points)) < 0.8]
    assert partition(euclidean_clusters(points, tolerance)) == reference(points, tolerance)


def test_labels_follow_the_size_and_then_the_first_point():
    places = np.array((5, 2, 2, 0, 0, 5, 9, 7, 7), dtype=np.float32)
    labels = euclidean_clusters(np.column_stack((places, -places, places)), 0.01)
    np.testing.assert_array_equal(labels, (0, 1, 1, 2, 2, 0, 4, 3, 3))


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("at", [0, 50, 199])
def test_points_that_are_none_belong_to_no_cluster(bad, at):
    points = np.random.default_rng(0).uniform(0.0, 0.05, (200, 3)).astype(np.float32)
    points[at, 1] = bad
    labels = euclidean_clusters(points, 0.005)
    assert labels[at] == -1
    others = np.delete(points, at, axis=0)
    assert partition(np.delete(labels, at)) == reference(others, 0.005)
    assert (euclidean_clusters(np.full((9, 3), bad, dtype=np.float32), 0.005) == -1).all()


def test_a_cloud_too_wide_for_a_table_of_columns():
    points = np.random.default_rng(1).uniform(0.0, 20.0, (3000, 3)).astype(np.float32)
    points[1500:] = points[:1500] + np.float32(0.002)
    assert partition(euclidean_clusters(points, 0.005)) == reference(points, 0.005)


@given(st.integers(0, 10**6), st.floats(0.0012, 0.0025))
@settings(max_examples=30, deadline=None)
def test_a_tall_volume_is_cut_into_layers(seed, tolerance):
    points = np.random.default_rng(seed).uniform(0.0, (0.01, 0.01, 0.1), (6000, 3)).astype(np.float32)
    assert partition(euclidean_clusters(points, tolerance)) == reference(points, tolerance)


@given(st.integers(0, 10**6), st.permutations(range(3)), st.booleans(), st.booleans())
@settings(max_examples=30, deadline=None)
def test_the_order_of_the_points_and_the_axes_does_not_matter(seed, axes, backwards, shuffled):
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(0.0, 0.04, 0.0004), np.arange(0.0, 0.03, 0.0004))
    z = np.where(x < 0.02, 0.0, 0.004) + 0.2 * y + random.normal(0.0, 0.0002, x.shape)
    points = np.stack((x, y, z), axis=-1)[random.uniform(size=x.shape) < 0.9][:, axes].astype(np.float32)
    points = random.permutation(points) if shuffled else points[::-1] if backwards else points
    assert partition(euclidean_clusters(points, 0.002)) == reference(points, 0.002)


@pytest.mark.parametrize("count", [1, 7, 8, 9, 511, 512, 513, 2000])
def test_many_points_in_one_place(count):
    points = np.repeat(np.array(((0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.1, 0.1, 0.1)), dtype=np.float32), count, axis=0)
    np.testing.assert_array_equal(euclidean_clusters(points, 0.01), np.repeat((0, 1, 2), count))


def test_a_tolerance_too_small_to_number_cells_is_refused_and_a_larger_one_works():
    points = np.array(((0.0, 0.0, 0.0), (1000.0, 0.0, 0.0)), dtype=np.float32)
    with pytest.raises(InvalidInputError, match=r"tolerance: 1e-07 m is too small for a cloud 1e\+03 m wide"):
        euclidean_clusters(points, 1e-7)
    assert euclidean_clusters(points, 0.01).tolist() == [0, 1]
