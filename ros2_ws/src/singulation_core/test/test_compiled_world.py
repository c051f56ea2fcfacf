"""The compiled solver of pushes: the same physics as pymunk's, and as deterministic."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from singulation_core import Arrangement, ContactMode, InvalidInputError, Push, PusherGeometry, ResultCode
from singulation_core.push_world import Footprint, PushPhysics, pusher_footprint, simulate_push, simulate_pushes
from singulation_core.push_world.compiled import BLOCKED, DIVERGED, DONE, CompiledWorld

JAWS = PusherGeometry(tip_radius=0.004, edge_width=0.016, edge_thickness=0.008)
FAST = PushPhysics.fast()
MODES = (ContactMode.SINGLE_POINT, ContactMode.EDGE, ContactMode.TWO_POINT)


def random_pushes(scene, count, mode, seed=0):
    """Through random blocks, on random lines, from the bounding circle."""
    random = np.random.default_rng(seed)
    pushes = []
    for _ in range(count):
        item = scene.objects[int(random.integers(len(scene)))]
        angle, offset = random.uniform(-np.pi, np.pi), random.uniform(-0.6, 0.6) * item.bounding_radius
        way = np.array((np.cos(angle), np.sin(angle)))
        start = item.centroid - way * (item.bounding_radius + 0.006) + offset * np.array((-way[1], way[0]))
        pushes.append(Push(start, start + 0.03 * way, mode, 0.0 if mode is ContactMode.SINGLE_POINT else 0.016))
    return pushes


@pytest.mark.parametrize("mode", MODES)
def test_both_engines_agree_on_random_pushes(scene_of, mode):
    ours, theirs, places = [], [], []
    for seed in range(8):
        scene = scene_of(seed, 8)
        pushes = random_pushes(scene, 40, mode, seed)
        fine = simulate_pushes(scene, pushes, replace(FAST, step=0.02, iterations=40), JAWS)
        reference = simulate_pushes(scene, pushes, PushPhysics.fine(), JAWS)
        assert fine.codes == reference.codes  # both refuse the same starts
        done = reference.done
        ours.append(fine.gains()[done])
        theirs.append(reference.gains()[done])
        places.append(np.abs(fine.poses[done] - reference.poses[done])[..., :2].max(axis=(1, 2)))
    ours, theirs, places = map(np.concatenate, (ours, theirs, places))
    assert len(ours) > 100
    assert np.corrcoef(ours, theirs)[0, 1] > 0.99
    assert np.median(places) < 0.01 * 0.02  # a hundredth of a bounding radius
    assert np.abs(ours).mean() == pytest.approx(np.abs(theirs).mean(), rel=0.04)


def test_pushes_do_not_influence_each_other(scene_of):
    scene = scene_of(3, 9)
    pushes = random_pushes(scene, 30, ContactMode.SINGLE_POINT)
    together = simulate_pushes(scene, pushes, FAST, JAWS)
    backwards = simulate_pushes(scene, pushes[::-1], FAST, JAWS)
    alone = [simulate_pushes(scene, [one], FAST, JAWS).poses[0] for one in pushes]
    assert np.array_equal(together.poses, backwards.poses[::-1], equal_nan=True)
    assert np.array_equal(together.poses, np.array(alone), equal_nan=True)


def test_different_jaws_in_one_call_keep_their_places(scene_of):
    scene = scene_of(3, 9)
    by_mode = [random_pushes(scene, 6, mode, 5) for mode in MODES]
    mixed = [one for group in zip(*by_mode, strict=True) for one in group]
    outcomes = simulate_pushes(scene, mixed, FAST, JAWS)
    for k, group in enumerate(by_mode):
        expected = simulate_pushes(scene, group, FAST, JAWS)
        assert np.array_equal(outcomes.poses[k::3], expected.poses, equal_nan=True)
        assert outcomes.codes[k::3] == expected.codes


def test_worlds_work_in_threads(scene_of):
    scene = scene_of(2, 9)
    pushes = random_pushes(scene, 200, ContactMode.SINGLE_POINT)
    starts, ends = np.array([one.start for one in pushes]), np.array([one.end for one in pushes])
    footprint = pusher_footprint(pushes[0], JAWS)

    def work(_):
        return CompiledWorld(scene, footprint, FAST, 0.02).roll_out(starts, ends)

    expected = work(0)
    with ThreadPoolExecutor(4) as threads:
        for poses, codes in threads.map(work, range(8)):
            assert np.array_equal(poses, expected[0], equal_nan=True)
            assert np.array_equal(codes, expected[1])


def test_codes_say_what_happened(block):
    scene = Arrangement([block(0, (0.0, 0.0)), block(1, (0.1, 0.0))])
    footprint = pusher_footprint(Push((0.0, 0.0), (0.1, 0.0), ContactMode.SINGLE_POINT), JAWS)
    world = CompiledWorld(scene, footprint, FAST, 0.02)
    poses, codes = world.roll_out(np.array(((-0.05, 0.0), (0.0, 0.0))), np.array(((0.0, 0.0), (0.1, 0.0))))
    assert codes.tolist() == [DONE, BLOCKED]
    assert np.isnan(poses[1]).all()
    assert poses[0, 0, 0] > 0.0
    assert DIVERGED not in codes


def test_a_push_that_is_refused_says_so(block):
    inside = Push((0.0, 0.0), (0.1, 0.0), ContactMode.SINGLE_POINT)
    scene = Arrangement([block(0, (0.0, 0.0))])
    outcomes = simulate_pushes(scene, [inside], FAST, JAWS)
    assert outcomes.codes == (ResultCode.PATH_BLOCKED,)
    good = Push((-0.05, 0.0), (0.0, 0.0), ContactMode.SINGLE_POINT)
    assert simulate_push(scene, good, FAST, JAWS).centroids[0, 0] > 0.0


def test_a_table_without_blocks_can_be_pushed_on():
    empty = simulate_pushes(Arrangement([]), [Push((0.0, 0.0), (0.1, 0.0), ContactMode.EDGE, 0.01)], FAST, JAWS)
    assert empty.codes == (ResultCode.OK,)
    assert empty.poses.shape == (1, 0, 3)


def test_a_pusher_of_several_polygons_is_refused(block):
    square = 0.01 * np.array(((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)))
    with pytest.raises(InvalidInputError, match="2 polygons"):
        CompiledWorld(Arrangement([block(0, (0.0, 0.0))]), Footprint(polygons=(square, square + 0.02)), FAST, 0.02)


def test_only_pymunk_lets_blocks_coast():
    with pytest.raises(InvalidInputError, match="velocity_kept"):
        replace(PushPhysics.authors(), engine="compiled")
    with pytest.raises(InvalidInputError, match="pymunk, compiled"):
        PushPhysics(engine="box2d")
    assert PushPhysics(engine="compiled").engine == "compiled"


def test_blocks_beside_the_push_are_not_moved_at_all(scene_of):
    scene = scene_of(1, 9)
    edge = Push(scene.centroids[0] - (0.03, 0.0), scene.centroids[0] - (0.02, 0.0), ContactMode.SINGLE_POINT)
    after = simulate_push(scene, edge, FAST, JAWS)
    assert after.objects[0] is not scene.objects[0]
    assert all(new is old for new, old in zip(after.objects[3:], scene.objects[3:], strict=True))
