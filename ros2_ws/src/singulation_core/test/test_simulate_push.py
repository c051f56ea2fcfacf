"""Pushes of arrangements: physics that is known, and independence of everything that must not matter."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from singulation_core import (
    Arrangement,
    ContactMode,
    PlanarObject,
    Push,
    PusherGeometry,
    ResultCode,
    SingulationError,
    singulation_distance,
    smallest_gap,
)
from singulation_core.push_world import Footprint, PushPhysics, PushWorld, simulate_push, simulate_pushes

JAWS = PusherGeometry(tip_radius=0.004, edge_width=0.016, edge_thickness=0.008)
MODES = (ContactMode.SINGLE_POINT, ContactMode.EDGE, ContactMode.TWO_POINT)
PRESETS = ("quasi_static", "fine", "fast")


def push(start, angle, length=0.06, mode=ContactMode.SINGLE_POINT):
    way = length * np.array((math.cos(angle), math.sin(angle)))
    return Push(start, np.asarray(start) + way, mode, 0.0 if mode is ContactMode.SINGLE_POINT else 0.016)


def around(scene, count=24, mode=ContactMode.SINGLE_POINT):
    """Pushes from all sides through the middle of the scene."""
    middle = scene.centroids.mean(axis=0)
    angles = 2.0 * np.pi * np.arange(count) / count
    return [push(middle - 0.11 * np.array((math.cos(a), math.sin(a))), a, 0.10, mode) for a in angles]


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("preset", PRESETS)
def test_a_block_ends_in_front_of_the_pusher(block, mode, preset):
    """Nothing of the travel is lost, whatever the step (a step lost is 6 to 40 % of the gain)."""
    after = simulate_push(
        Arrangement([block(0, (0.0, 0.0))]), push((-0.03, 0.0), 0.0, 0.07, mode), PushPhysics.named(preset), JAWS
    )
    front = 0.04 if mode is ContactMode.EDGE else 0.04 + JAWS.tip_radius
    assert after.objects[0].outline[:, 0].min() == pytest.approx(front, abs=1e-4)
    assert after.centroids[0, 1] == pytest.approx(0.0, abs=5e-4)


@pytest.mark.parametrize("preset", PRESETS)
def test_a_row_of_blocks_is_pushed_as_one(block, preset):
    side = 0.02 * math.sqrt(2.0)
    row = Arrangement([block(k, (k * side, 0.0)) for k in range(4)])
    after = simulate_push(row, push((-0.03, 0.0), 0.0, 0.05), PushPhysics.named(preset), JAWS)
    front = 0.02 + JAWS.tip_radius
    assert after.centroids[:, 0] == pytest.approx(front + side * (0.5 + np.arange(4)), abs=4e-4)


@given(offset=st.floats(-0.8, 0.8), friction=st.floats(0.0, 0.9))
@settings(max_examples=25, deadline=None)
def test_a_short_push_turns_a_block_as_quasi_static_mechanics_say(offset, friction):
    """Limit surface: with a sticking contact, force f at r moves the centre along f and turns it by (r x f) / c^2."""
    half = 0.02
    square = PlanarObject(0, np.array(((-half, -half), (half, -half), (half, half), (-half, half))))
    way, y = 2e-4, offset * half
    after = simulate_push(
        Arrangement([square]),
        push((-half - 0.004, y), 0.0, way),
        PushPhysics(friction=friction, step=2e-4, iterations=50, slop=1e-6),
        JAWS,
    )
    squared_gyration = 2.0 * half**2 / 3.0
    # Contact at r = (-half, y), velocity (1, 0) of the pusher; f normal to the face is inside the friction cone if the
    # tangential part that sticking needs is small enough, else the contact slips and the tangential part is limited.
    a, b = 1.0 + y * y / squared_gyration, half * y / squared_gyration
    d = 1.0 + half * half / squared_gyration
    fy_over_fx = -b / d
    if abs(fy_over_fx) > friction:
        fy_over_fx = math.copysign(friction, fy_over_fx)
    fx = 1.0 / (a + b * fy_over_fx)
    turn = (-half * fx * fy_over_fx - y * fx) / squared_gyration * way
    moved = after.objects[0]
    edge = moved.outline[1] - moved.outline[0]
    assert math.atan2(edge[1], edge[0]) == pytest.approx(turn, abs=0.02 * way / half)
    assert moved.centroid[0] == pytest.approx(fx * way, abs=0.02 * way)


@pytest.mark.parametrize("tilt", [10.0, 20.0, 24.0, 29.0, 33.0, 40.0])
def test_friction_of_a_contact_is_the_one_given(tilt):
    """A flat face pushed at an angle goes along below atan(0.5) = 26.6 degrees, and beyond it in that direction. Were
    both shapes' coefficients taken, or their root, the largest angle would be 14 or 35 degrees."""
    wide = PlanarObject(0, np.array(((0.0, -0.05), (0.03, -0.05), (0.03, 0.05), (0.0, 0.05))))
    angle = math.radians(tilt)
    world = PushWorld(Arrangement([wide]), replace(PushPhysics.fine(), friction=0.5))
    jaw = Footprint(polygons=(np.array(((-0.01, -0.04), (0.0, -0.04), (0.0, 0.04), (-0.01, 0.04))),))
    world.place("jaw", jaw, (-1e-3, 0.0, 0.0))
    world.approach("jaw", (0.0, 0.0, 0.0))
    before = world.poses()[0]
    world.move({"jaw": (0.02 * math.cos(angle), 0.02 * math.sin(angle), 0.0)})
    x, y, _ = world.poses()[0] - before
    assert y / x == pytest.approx(min(math.tan(angle), 0.5), abs=0.04)


@given(seed=st.integers(0, 30), angle=st.floats(-math.pi, math.pi), x=st.floats(-0.5, 0.5), y=st.floats(-0.5, 0.5))
@settings(max_examples=12, deadline=None)
def test_turning_and_moving_the_scene_turns_and_moves_the_outcome(scene_of, seed, angle, x, y):
    scene = scene_of(seed)
    one = around(scene)[seed % 24]
    turn = np.array(((math.cos(angle), math.sin(angle)), (-math.sin(angle), math.cos(angle))))
    there = Arrangement([PlanarObject(o.id, o.outline @ turn + (x, y)) for o in scene.objects])
    pushed = Push(one.start @ turn + (x, y), one.end @ turn + (x, y), one.contact_mode)
    plain, moved = simulate_push(scene, one, None, JAWS), simulate_push(there, pushed, None, JAWS)
    # The numbers inside differ by rounding alone, which a collision may blow up a little.
    assert np.median(np.abs(moved.centroids - (plain.centroids @ turn + (x, y)))) < 1e-6
    assert moved.centroids == pytest.approx(plain.centroids @ turn + (x, y), abs=2e-3)


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_scaling_the_scene_scales_the_outcome(scene_of, scale):
    """No length in metres is hidden in the physics (a contact slop of 0.1 in metres would let blocks sink)."""
    scene = scene_of(2)
    jaws = PusherGeometry(JAWS.tip_radius * scale, JAWS.edge_width * scale, JAWS.edge_thickness * scale)
    large = Arrangement([PlanarObject(o.id, o.outline * scale) for o in scene.objects])
    for one in around(scene, 6):
        plain = simulate_push(scene, one, None, JAWS)
        scaled = simulate_push(large, Push(one.start * scale, one.end * scale, one.contact_mode), None, jaws)
        assert scaled.centroids / scale == pytest.approx(plain.centroids, abs=1e-5)


def test_numbers_of_the_objects_do_not_matter(scene_of):
    scene = scene_of(3)
    renumbered = Arrangement([PlanarObject(90 - o.id, o.outline) for o in scene.objects])
    one = around(scene)[5]
    assert simulate_push(scene, one, None, JAWS).centroids == pytest.approx(
        simulate_push(renumbered, one, None, JAWS).centroids, abs=0.0
    )


@pytest.mark.parametrize("mode", MODES)
def test_many_pushes_give_bit_for_bit_the_results_of_single_ones(scene_of, mode):
    """Also in another order, and after other pushes: no impulse of an earlier push is left over."""
    scene = scene_of(4)
    pushes = around(scene, 12, mode)
    together = simulate_pushes(scene, pushes, None, JAWS)
    backwards = simulate_pushes(scene, pushes[::-1], None, JAWS)
    assert together.done.all()
    assert np.array_equal(together.poses, backwards.poses[::-1])
    alone = np.array([simulate_push(scene, one, None, JAWS).centroids for one in pushes])
    assert together.poses[..., :2] == pytest.approx(alone, abs=1e-12)


def test_pushes_with_other_jaws_in_between_change_nothing(scene_of):
    scene = scene_of(4)
    plain, edge = around(scene, 4), around(scene, 4, ContactMode.EDGE)
    mixed = simulate_pushes(scene, [plain[0], edge[1], plain[2], edge[3]], None, JAWS)
    assert np.array_equal(mixed.poses[2], simulate_pushes(scene, [plain[2]], None, JAWS).poses[0])
    assert np.array_equal(mixed.poses[3], simulate_pushes(scene, [edge[3]], None, JAWS).poses[0])


def test_gains_are_the_change_of_the_singulation_distance_in_any_unit(scene_of):
    scene = scene_of(5)
    outcomes = simulate_pushes(scene, around(scene, 6), None, JAWS)
    for unit in (1.0, 0.02):
        changes = [
            singulation_distance(outcomes.arrangement(k), unit) - singulation_distance(scene, unit) for k in range(6)
        ]
        assert outcomes.gains() == pytest.approx(changes, abs=1e-12)


def test_a_push_from_inside_a_block_is_refused_and_the_others_are_done(scene_of):
    scene = scene_of(6)
    inside = push(scene.centroids[2], 0.3)
    with pytest.raises(SingulationError, match=r"object\(s\) \[2\]") as caught:
        simulate_push(scene, inside, None, JAWS)
    assert caught.value.code is ResultCode.PATH_BLOCKED
    good = around(scene, 2)
    outcomes = simulate_pushes(scene, [good[0], inside, good[1]], None, JAWS)
    assert outcomes.codes == (ResultCode.OK, ResultCode.PATH_BLOCKED, ResultCode.OK)
    assert np.isnan(outcomes.gains()).tolist() == [False, True, False]
    with pytest.raises(SingulationError, match="push 1 was not simulated: its pusher would start on a block"):
        outcomes.arrangement(1)
    assert len(outcomes.arrangement(2)) == len(scene)


def test_one_block_has_no_gain_and_none_no_outcome(block):
    alone = simulate_pushes(Arrangement([block(0, (0.0, 0.0))]), [push((-0.05, 0.0), 0.0)])
    assert np.isnan(alone.gains()).all()
    assert alone.arrangement(0).centroids[0, 0] > 0.0
    assert simulate_pushes(Arrangement([block(0, (0.0, 0.0))]), []).gains().shape == (0,)


def test_blocks_do_not_overlap_after_a_push(scene_of):
    scene = scene_of(7)
    for one in around(scene, 12):
        assert smallest_gap(simulate_push(scene, one, None, JAWS)) > -2e-4


@pytest.mark.parametrize("preset", PRESETS)
def test_a_tip_whose_centre_passes_beside_a_block_still_pushes_it(preset):
    """Chipmunk does not see such a block ahead of a disc."""
    square = 0.02 * np.array(((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)))
    passing = push((-0.05, 0.022), 0.0)
    found = simulate_push(Arrangement([PlanarObject(0, square)]), passing, PushPhysics.named(preset), JAWS)
    assert found.centroids[0, 0] > 0.005
