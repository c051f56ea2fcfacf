"""Each policy on scenes where the paper's text says what it must do, and the readings of its open places."""

import numpy as np
import pytest

from singulation_core import Arrangement, PlanarObject, PusherGeometry, SingulationError
from singulation_planner import POLICIES, plan_push
from singulation_planner.candidates import Candidates, through_centroid
from singulation_planner.directions import away, fan
from singulation_planner.kernels import scoring
from singulation_planner.kernels.cluster_fans import _pushes_two
from singulation_planner.kernels.sweep import obstructed_widths
from singulation_planner.policies import find_policy
from singulation_planner.policies.center_object_removal import Options as RemovalOptions
from singulation_planner.policies.center_object_removal import _away_from_segment
from singulation_planner.policies.cluster_push import Options, _rules
from singulation_planner.policies.min_contact_range import _narrowest
from singulation_planner.policy import REGISTERED, NoOptions, policy
from singulation_planner.scene import Scene
from singulation_planner.selection import by_connectivity, by_removal, clusters_around_seeds
from singulation_planner.testing import clutter, squares

CROSS = squares([(0.0, 0.0), (0.03, 0.0), (-0.03, 0.001), (0.0, 0.0305), (0.001, -0.031)])


def plan(arrangement, name="cluster_push", **options):
    """With a pusher so thin that the first choice of the policy is nearly always free."""
    return plan_push(arrangement, name, pusher=PusherGeometry(0.0001, 0.0002, 0.0002), **options)


def angle_between(first, second):
    second = np.asarray(second) / np.hypot(*second)
    return np.degrees(np.arccos(np.clip(first @ second, -1.0, 1.0)))


def test_the_central_object_has_the_smallest_sums():
    scene = Scene.of(CROSS)
    assert scene.object_id(by_connectivity(scene)[0]) == 0
    assert scene.object_id(by_removal(scene)[0]) == 0
    sums = scoring.distance_sums(scene.centroids, False)
    expected = [sum(np.hypot(*(a - b)) for b in scene.centroids) for a in scene.centroids]
    np.testing.assert_allclose(sums, expected)


def test_removal_and_connectivity_differ_where_a_pair_is_close():
    """The middle object has the smallest sum of distances; the pair at the end is what holds the logarithms down."""
    row = Scene.of(squares([(0.0, 0.0), (0.0201, 0.0), (0.09, 0.0), (0.16, 0.0), (0.25, 0.0)]))
    assert row.object_id(by_connectivity(row)[0]) == 2
    assert row.object_id(by_removal(row)[0]) in (0, 1)


def test_clusters_of_the_paper():
    """Bounding circles of squares with half edges of 10 mm meet below a distance of 28.3 mm."""
    scene = Scene.of(squares([(0.0, 0.0), (0.027, 0.0), (0.054, 0.0), (0.2, 0.0), (0.227, 0.0)]))
    seed = scene.order.index(0)

    def groups(rule):
        labels = scoring.cluster(scene.centroids, scene.radii, seed, rule)
        return sorted(sorted(scene.object_id(k) for k in np.flatnonzero(labels == c)) for c in range(labels.max() + 1))

    assert groups(scoring.FIXED_DISC) == [[0, 1], [2], [3, 4]]
    assert groups(scoring.ANY_MEMBER) == [[0, 1, 2], [3, 4]]
    assert groups(scoring.GROWING_DISC) == [[0, 1, 2], [3, 4]]


def test_cluster_push_moves_one_object_of_a_small_cluster_away_from_the_rest():
    scene = squares([(0.0, 0.0), (0.021, 0.01), (-0.002, 0.022)])
    push = plan(scene)
    others = [item.centroid for item in scene.objects if item.id != push.target_id]
    outward = scene.objects[push.target_id].centroid - np.mean(others, axis=0)
    assert angle_between(push.direction, outward) < 60.0


def two_heaps():
    """Five squares in a cross, and one far to the left."""
    return squares([(0.0, 0.0), (0.0, 0.0205), (0.0, -0.0205), (0.0205, 0.0), (-0.0245, 0.0), (-0.14, 0.0)])


def test_cluster_push_takes_a_partner_along_out_of_a_large_cluster():
    """Case 1: from the gap at the left through the middle object towards its partner on the right."""
    scene = squares([(0.0, 0.0), (0.0, 0.0205), (0.0, -0.0205), (0.0205, 0.0), (-0.1, 0.0), (-0.12, 0.0)])
    push = plan(scene, push_object="distance")
    assert push.target_id == 0
    np.testing.assert_allclose(push.direction, (1.0, 0.0), atol=1e-9)
    assert plan(scene, push_object="distance", case_one="never").target_id == 0


@pytest.mark.parametrize("reading", ["away_from_all", "away_from_cluster", "away_from_clusters"])
def test_every_reading_of_case_one_leads_away_from_the_other_heap(reading):
    push = plan(two_heaps(), push_object="distance", case_one_direction=reading)
    assert push.target_id == 0
    np.testing.assert_allclose(push.direction, (1.0, 0.0), atol=1e-9)


def test_case_one_needs_what_its_reading_says():
    cases = {(4, 2): (True, True, True), (3, 1): (False, True, False), (4,): (False, False, True), (2, 3): (False,) * 3}
    for sizes, expected in cases.items():
        labels = np.repeat(np.arange(len(sizes)), sizes)
        readings = ("both", "largest", "more_than_three")
        assert tuple(_pushes_two(labels, _rules(Options(case_one=one))[1]) for one in readings) == expected
        assert not _pushes_two(labels, _rules(Options(case_one="never"))[1])


def test_distances_to_ray_segment_and_line():
    points = np.array(((0.0, 0.0), (-3.0, 4.0), (6.0, 2.0)))
    ahead = np.array(((1.0, 0.0),))

    def total(path, radii=(0.0, 0.0, 0.0)):
        return scoring.path_distance_sums(points, np.array(radii), 0, ahead, path, 3.0)[0]

    assert total(scoring.RAY) == pytest.approx(5.0 + 2.0)
    assert total(scoring.LINE) == pytest.approx(4.0 + 2.0)
    assert total(scoring.SEGMENT) == pytest.approx(5.0 + np.hypot(3.0, 2.0))
    assert total(scoring.RAY, (1.0, 1.0, 3.0)) == pytest.approx(4.0)


def test_boundary_shear_pushes_along_the_boundary_of_the_closest_pair():
    scene = squares([(0.0, 0.0), (0.0205, 0.0), (0.1, 0.1)])
    for boundary in ("perpendicular", "face"):
        push = plan(scene, "boundary_shear", boundary=boundary)
        assert push.target_id in (0, 1)
        np.testing.assert_allclose(np.abs(push.direction), (0.0, 1.0), atol=1e-9)


def test_boundary_shear_prefers_free_space():
    scene = squares([(0.0, 0.0), (0.0205, 0.0), (0.0, 0.06), (0.0205, 0.06), (0.0205, -0.045)])
    push = plan(scene, "boundary_shear")
    assert push.target_id in (0, 1, 2, 3)
    into = push.end + 0.03 * push.direction - np.array([item.centroid for item in scene.objects])
    assert np.hypot(*into.T).min() > 0.02


def test_boundary_shear_can_measure_closeness_between_circles():
    small = [PlanarObject(k, item.outline * 0.2) for k, item in enumerate(squares([(0.0, 0.0), (0.12, 0.0)]).objects)]
    large = [PlanarObject(k + 2, item.outline) for k, item in enumerate(squares([(0.1, 0.0), (0.13, 0.0)]).objects)]
    scene = Arrangement(small + large)
    assert plan(scene, "boundary_shear").target_id in (0, 1)
    assert plan(scene, "boundary_shear", closeness="circles").target_id in (2, 3)


def test_cluster_diffusion_pushes_outwards_where_there_is_room():
    ring = squares([(0.03 * np.cos(a), 0.03 * np.sin(a)) for a in (0.1, 1.4, 2.7, 4.0, 5.2)])
    push = plan(ring, "cluster_diffusion")
    outward = ring.objects[push.target_id].centroid - ring.centroids.mean(axis=0)
    assert angle_between(push.direction, outward) < 25.0


@pytest.mark.parametrize(("reading", "expected"), [("nearest", 0), ("farthest", 3)])
def test_cluster_diffusion_among_equally_free_objects(reading, expected):
    scene = squares([(0.02, -0.01), (-0.045, 0.03), (-0.045, -0.06), (0.07, 0.06)])
    assert plan(scene, "cluster_diffusion", equally_free=reading).target_id == expected


def test_cluster_diffusion_can_have_a_centre_for_every_three():
    scene = squares([(0.0, 0.0), (0.025, 0.0), (0.012, 0.03), (0.3, 0.0), (0.325, 0.0), (0.312, 0.03)])
    outward = [scene.centroids[k] - scene.centroids[:3].mean(axis=0) for k in range(3)]
    outward += [scene.centroids[k] - scene.centroids[3:].mean(axis=0) for k in range(3, 6)]
    push = plan(scene, "cluster_diffusion", centre="clusters")
    assert angle_between(push.direction, outward[push.target_id]) < 1e-3


@pytest.mark.parametrize("reading", ["perpendicular", "closest_point"])
def test_center_object_removal_goes_away_from_the_segment_of_the_two_nearest(reading):
    push = plan(squares([(0.0, 0.0), (0.04, 0.03), (-0.04, 0.03)]), "center_object_removal", direction=reading)
    assert push.target_id == 0
    np.testing.assert_allclose(push.direction, (0.0, -1.0), atol=1e-9)


@pytest.mark.parametrize(("reading", "expected"), [("perpendicular", (0.0, -1.0)), ("closest_point", (-1.0, -1.0))])
def test_beside_the_segment_its_closest_point_is_an_end(reading, expected):
    """The two nearest of the object at the origin lie above and to the right of it."""
    scene = Scene.of(squares([(0.0, 0.0), (0.02, 0.02), (0.05, 0.02)]))
    way = _away_from_segment(scene, scene.order.index(0), RemovalOptions(direction=reading))
    assert angle_between(way, expected) < 1e-3


def test_on_the_segment_the_side_away_from_all_others_is_taken():
    scene = Scene.of(squares([(0.0, 0.0), (0.025, 0.0), (-0.025, 0.0), (0.0, 0.1)]))
    way = _away_from_segment(scene, scene.order.index(0), RemovalOptions())
    np.testing.assert_allclose(way, (0.0, -1.0), atol=1e-12)


def test_min_contact_range_pushes_along_the_narrow_side():
    """A plank between two others, which lie to the right of it."""
    plank = PlanarObject(0, np.array(((-0.03, -0.006), (0.03, -0.006), (0.03, 0.006), (-0.03, 0.006))))
    beside = squares([(0.0, 0.9), (0.045, 0.02), (0.045, -0.02)]).objects[1:]
    scene = Scene.of(Arrangement([plank, *beside]))
    ways = _narrowest(scene, scene.order.index(0), fan(away(scene, scene.order.index(0))))
    np.testing.assert_allclose(ways[0], (-1.0, 0.0), atol=1e-9)
    np.testing.assert_allclose(ways[8], (1.0, 0.0), atol=1e-9)


def test_min_contact_range_can_mean_what_stands_in_the_way():
    """The square in the middle of a cross has its neighbours' full width ahead, on a diagonal only their corners."""
    packed = Scene.of(squares([(0.0, 0.0), (0.03, 0.0), (0.0, 0.03), (-0.03, 0.0), (0.0, -0.03), (0.04, 0.04)]))
    ways = fan(np.array((1.0, 0.0)))
    widths = obstructed_widths(packed.centroids, packed.vertices, packed.firsts, packed.order.index(0), ways, 0.2)
    assert widths[8] == pytest.approx(0.02)
    # Towards (-1, -1): two neighbours of width 28 mm, 21 mm to either side of a path of width 28 mm.
    assert widths[10] == pytest.approx(2.0 * (0.02 * np.sqrt(2.0) - 0.03 / np.sqrt(2.0)))
    assert widths[2] == pytest.approx(widths[10] + 0.02 * np.sqrt(2.0))


def test_min_contact_range_takes_the_clear_way_out():
    scene = squares([(0.0, 0.0), (0.03, 0.0), (0.0, 0.03), (-0.03, 0.0)])
    push = plan(scene, "min_contact_range", contact_range="obstructed")
    assert push.target_id == 0
    np.testing.assert_allclose(push.direction, (0.0, -1.0), atol=1e-9)


def test_min_overlap_keeps_away_from_everything():
    scene = squares([(0.0, 0.0), (0.04, 0.0), (0.0, 0.04), (-0.035, 0.03)])
    push = plan(scene, "min_overlap")
    assert push.target_id == 0
    assert angle_between(push.direction, -scene.centroids.sum(axis=0)) < 30.0


def test_two_cluster_separation_pushes_towards_the_cluster_it_is_not_in():
    scene = squares([(0.0, 0.0), (0.0, 0.0205), (0.0, -0.0205), (0.15, 0.0), (0.15, 0.0205)])
    labels = clusters_around_seeds(Scene.of(scene), 2)
    assert sorted(np.bincount(labels).tolist()) == [2, 3]
    push = plan(scene, "two_cluster_separation")
    other = scene.centroids[3:] if push.target_id < 3 else scene.centroids[:3]
    goal = other.mean(axis=0) - scene.objects[push.target_id].centroid
    assert angle_between(push.direction, goal) < 1e-3
    own = plan(scene, "two_cluster_separation", towards="own_cluster")
    assert own.target_id in (0, 1, 2)


def test_quasi_random_goes_through_centroids_and_reaches_all_objects():
    scene = clutter(5, 2)
    pushes = [plan(scene, "quasi_random", seed=seed) for seed in range(60)]
    assert {push.target_id for push in pushes} == {0, 1, 2, 3, 4}
    for push in pushes:
        to_centroid = scene.objects[push.target_id].centroid - push.start
        assert abs(to_centroid[0] * push.direction[1] - to_centroid[1] * push.direction[0]) < 1e-12


def test_a_blocked_best_push_is_replaced_by_the_next_one():
    alone = squares([(0.0, 0.0), (0.1, 0.03), (0.09, -0.05)])
    first = plan_push(alone)
    walled = squares([*alone.centroids.tolist(), (first.start - 0.012 * first.direction).tolist()])
    second = plan_push(walled)
    assert angle_between(second.direction, first.direction) > 10.0 or second.target_id != first.target_id
    assert np.hypot(*(second.start - walled.centroids[3])) > 0.01


def test_a_tenth_policy_is_one_registered_function():
    def rank(task, options):
        yield through_centroid(0, np.array(((0.6, 0.8),)))

    rank.__module__ = "singulation_planner.policies.tenth"
    try:
        policy(NoOptions)(rank)
        push = plan(squares([(0.0, 0.0), (0.1, 0.0)]), "tenth")
        np.testing.assert_allclose(push.direction, (0.6, 0.8))
        assert push.policy == "tenth"
    finally:
        REGISTERED.pop("tenth", None)
    with pytest.raises(SingulationError, match="tenth"):
        find_policy("tenth")


def test_candidates_of_several_objects():
    made = through_centroid(np.array((2, 0)), np.array(((1.0, 0.0), (0.0, 1.0))))
    assert isinstance(made, Candidates)
    assert made.offsets.tolist() == [0.0, 0.0]
    assert made.gains is None
    assert set(POLICIES) == set(REGISTERED)
