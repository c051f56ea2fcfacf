"""Ways in which a simulator invents gain, each seen in measurements before (none may come back)."""

import numpy as np
import pytest

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
from singulation_core.push_world import Disc, Footprint, PushPhysics, PushWorld, simulate_push, simulate_pushes
from singulation_core.push_world.overlap import _clipped

SIDE = 0.02 * np.sqrt(2.0)  # of the square block
PRESETS = ("quasi_static", "fine", "fast", "authors")
JAWS = PusherGeometry(tip_radius=0.004, edge_width=0.016, edge_thickness=0.008)
AWAY = Push((0.5, 0.5), (0.55, 0.5), ContactMode.SINGLE_POINT)  # meets nothing


def gain(before, after):
    return singulation_distance(after, 0.02) - singulation_distance(before, 0.02)


@pytest.fixture
def heap(block):
    """Nine squares in contact, three by three."""
    return Arrangement([block(k, (SIDE * (k % 3), SIDE * (k // 3))) for k in range(9)])


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("gap", [0.0, 1e-5, 1e-4, 3e-4])
def test_touching_blocks_stay_where_they_are(block, preset, gap):
    """A polygon skin of 0.01 would spread blocks nearer than 0.015 bounding radii (3e-4 m here)."""
    close = Arrangement([block(k, ((SIDE + gap) * (k % 3), (SIDE + gap) * (k // 3))) for k in range(9)])
    after = simulate_push(close, AWAY, PushPhysics.named(preset), JAWS)
    assert gain(close, after) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("overlap", [1e-5, 1e-4, 1e-3, 4e-3])
def test_overlapping_blocks_are_not_pushed_apart(block, preset, overlap):
    """Perception noise of 0.1 to 0.2 bounding radii made up to 9 % of a good push out of nothing."""
    step = SIDE - overlap
    crowded = Arrangement([block(k, (step * (k % 3), step * (k // 3))) for k in range(9)])
    after = simulate_push(crowded, AWAY, PushPhysics.named(preset), JAWS)
    assert gain(crowded, after) == pytest.approx(0.0, abs=1e-9)


def test_noisy_poses_of_random_blocks_give_no_gain(scene_of):
    random = np.random.default_rng(5)
    for seed in range(10):
        scene = scene_of(seed)
        noisy = Arrangement([o.moved(random.normal(0.0, 0.003, 2), random.normal(0.0, 0.05)) for o in scene.objects])
        assert gain(noisy, simulate_push(noisy, AWAY, None, JAWS)) == pytest.approx(0.0, abs=1e-9)


def test_a_corner_on_the_border_of_an_overlap_is_there_once():
    diamond = np.array(((0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)))
    assert _clipped(diamond, diamond[:, 1]).tolist() == [[0.0, -1.0], [1.0, 0.0], [-1.0, 0.0]]


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("offset", [0.0, 0.004, 0.015])
def test_overlaps_that_no_noise_explains_are_refused(block, preset, offset):
    deep = Arrangement([block(0, (0.0, 0.0)), block(1, (offset, 0.0))])
    with pytest.raises(SingulationError, match=r"objects (0 and 1|1 and 0) overlap") as caught:
        simulate_push(deep, AWAY, PushPhysics.named(preset), JAWS)
    assert caught.value.code is ResultCode.OVERLAPPING_OBJECTS
    apart = Arrangement([block(0, (0.0, 0.0)), block(1, (SIDE, 0.0))])
    assert gain(apart, simulate_push(apart, AWAY, None, JAWS)) == 0.0


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("thickness", [0.001, 0.003])
def test_nothing_tunnels_through_a_thin_block(block, preset, thickness):
    """Steps of half a bounding radius lost half of the gain to tunnelling."""
    thin = PlanarObject(1, np.array(((0.0, -0.05), (thickness, -0.05), (thickness, 0.05), (0.0, 0.05))))
    scene = Arrangement([thin, block(2, (0.15, 0.0))])
    after = simulate_push(
        scene, Push((-0.02, 0.0), (0.05, 0.0), ContactMode.SINGLE_POINT), PushPhysics.named(preset), JAWS, unit=0.02
    )
    assert after.objects[0].outline[:, 0].max() > 0.05


def test_a_thin_fingertip_does_not_tunnel(block):
    world = PushWorld(Arrangement([block(0, (0.0, 0.0))]), PushPhysics.fast())
    world.place("tip", Footprint((Disc(0.0, 0.0, 2e-4),)), (-0.03, 0.001, 0.0))
    world.move({"tip": (0.05, 0.001, 0.0)})
    assert world.poses()[0, 0] > 0.05


def test_blocks_stop_when_the_pusher_stops(heap):
    """Without real table friction blocks coast, and a random push looks seven times as good."""
    world = PushWorld(heap)
    world.place("tip", Footprint((Disc(0.0, 0.0, 0.004),)), (-0.03, 0.01, 0.0))
    world.move({"tip": (0.02, 0.015, 0.0)})
    world.wait(20)
    at_rest = world.poses()
    world.wait(1000)
    assert world.poses() == pytest.approx(at_rest, abs=1e-4)


def test_presets_agree_on_the_gain_of_pushes(scene_of):
    """Too few iterations, a lost last step or a slop in metres each cost 2 to 40 % of the mean gain."""
    totals = dict.fromkeys(("quasi_static", "fast", "fine"), 0.0)
    for seed in range(6):
        scene = scene_of(seed, 9)
        middle = scene.centroids.mean(axis=0)
        angles = 2.0 * np.pi * np.arange(16) / 16
        ways = np.column_stack((np.cos(angles), np.sin(angles)))
        pushes = [Push(middle - 0.13 * w, middle - 0.02 * w, ContactMode.SINGLE_POINT) for w in ways]
        for name in totals:
            totals[name] += float(
                np.nansum(np.abs(simulate_pushes(scene, pushes, PushPhysics.named(name), JAWS).gains()))
            )
    for name in ("quasi_static", "fast"):
        assert totals[name] / totals["fine"] == pytest.approx(1.0, abs=0.06)


def test_a_reused_world_does_not_move_touching_blocks_by_itself(heap):
    """Impulses kept for a warm start would move them (7e-5 of gain without a push)."""
    strong = Push((-0.03, 0.028), (0.05, 0.03), ContactMode.SINGLE_POINT)
    outcomes = simulate_pushes(heap, [strong, AWAY, strong, AWAY], None, JAWS)
    assert outcomes.gains()[[1, 3]] == pytest.approx((0.0, 0.0), abs=1e-12)
    assert outcomes.gains()[0] == outcomes.gains()[2]


def test_overlaps_of_a_push_heal_so_that_gaps_can_be_judged(heap):
    for y in np.linspace(-0.01, 0.07, 9):
        after = simulate_push(heap, Push((-0.03, y), (0.04, y), ContactMode.SINGLE_POINT), None, JAWS)
        assert smallest_gap(after) > -2e-4  # one hundredth of a bounding radius
