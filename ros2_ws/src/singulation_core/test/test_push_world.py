"""A table that lives on while pushers move over it."""

import math

import numpy as np
import pytest

from singulation_core import Arrangement, InvalidInputError, ResultCode, SingulationError, smallest_gap
from singulation_core.push_world import Disc, Footprint, PushPhysics, PushWorld

TIP = Footprint((Disc(0.0, 0.0, 0.005),))
JAW = Footprint(polygons=(np.array(((-0.003, -0.006), (0.003, -0.006), (0.003, 0.006), (-0.003, 0.006))),))
HALF = 0.02 / math.sqrt(2.0)  # half the side of the square block


@pytest.fixture
def world(block):
    return PushWorld(Arrangement([block(4, (0.0, 0.0)), block(9, (0.1, 0.0))], stamp=2.0))


def test_blocks_move_with_the_pusher_and_only_then(world):
    world.place("left", TIP, (-0.03, 0.0, 0.0))
    world.move({"left": (-0.005, 0.0, 0.0)})
    seen = world.arrangement()
    assert seen.centroids[0] == pytest.approx((HALF, 0.0), abs=1e-4)
    assert seen.objects[1].outline == pytest.approx(world.arrangement().objects[1].outline)
    world.wait(50)
    assert world.arrangement().centroids == pytest.approx(seen.centroids, abs=5e-5)


def test_a_block_that_did_not_move_is_the_same_object(world, block):
    before = world.arrangement()
    world.place("left", TIP, (-0.03, 0.0, 0.0))
    world.move({"left": (0.0, 0.0, 0.0)})
    assert world.arrangement().objects[1] is before.objects[1]
    assert world.arrangement().objects[0] is not before.objects[0]


def test_stamp_and_frame_are_kept_unless_given(world):
    assert (world.arrangement().stamp, world.arrangement().frame) == (2.0, "table")
    assert world.arrangement(stamp=7.5).stamp == 7.5


@pytest.mark.parametrize("moves", [2, 10, 60])
def test_many_small_moves_do_what_one_long_move_does(world, moves):
    world.place("left", TIP, (-0.03, 0.004, 0.0))
    for k in range(1, moves + 1):
        world.move({"left": (-0.03 + 0.04 * k / moves, 0.004, 0.0)})
    several = world.poses()
    world.restore()
    world.place("left", TIP, (-0.03, 0.004, 0.0))
    world.move({"left": (0.01, 0.004, 0.0)})
    assert several == pytest.approx(world.poses(), abs=2.5e-3)


def test_two_pushers_can_close_on_a_block_and_turn_it(world):
    world.place("one", TIP, (-0.03, 0.01, 0.0))
    world.place("two", TIP, (0.03, -0.01, 0.0))
    world.move({"one": (-0.0175, 0.01, 0.0), "two": (0.0175, -0.01, 0.0)})
    x, y, turn = world.poses()[0]
    assert (x, y) == (pytest.approx(0.0, abs=5e-4), pytest.approx(0.0, abs=5e-4))
    assert turn < -0.03  # pushed to the right above, to the left below: clockwise


def test_a_pusher_that_turns_takes_blocks_along(world):
    world.place(
        "bar",
        Footprint(polygons=(np.array(((0.0, -0.002), (0.06, -0.002), (0.06, 0.002), (0.0, 0.002))),)),
        (-0.02, -0.035, 0.0),
    )
    world.move({"bar": (-0.02, -0.035, math.pi / 3)})
    assert world.poses()[0, 1] > 0.005
    assert world.poses()[1] == pytest.approx((0.1, 0.0, 0.0), abs=1e-12)


def test_a_lifted_pusher_moves_nothing(world):
    world.place("left", TIP, (-0.03, 0.0, 0.0))
    assert world.is_down("left")
    world.lift("left")
    world.lift("left")
    assert not world.is_down("left")
    with pytest.raises(InvalidInputError, match="'left' is not down"):
        world.move({"left": (0.0, 0.0, 0.0)})
    world.place("left", TIP, (-0.04, 0.0, 0.0))
    world.move({"left": (-0.03, 0.0, 0.0)})
    assert world.poses()[0] == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


def test_coming_down_on_a_block_is_refused_with_its_id(world):
    assert world.covered(TIP, (0.1, 0.0, 0.0)) == [9]
    assert world.covered(TIP, (0.05, 0.0, 0.0)) == []
    with pytest.raises(SingulationError, match=r"object\(s\) \[9\]") as caught:
        world.place("left", TIP, (0.1, 0.005, 0.0))
    assert caught.value.code is ResultCode.PATH_BLOCKED
    assert not world.is_down("left")
    world.place("left", TIP, (0.05, 0.0, 0.0))
    assert world.is_down("left")


def test_touching_a_block_is_not_coming_down_on_it(world):
    assert world.covered(TIP, (-HALF - 0.005, 0.0, 0.0)) == []


@pytest.mark.parametrize("pose", [(0.0, 0.0), (math.nan, 0.0, 0.0), (0.0, 0.0, math.inf)])
def test_malformed_poses_are_refused(world, pose):
    world.place("left", TIP, (-0.05, 0.0, 0.0))
    for act in (lambda: world.move({"left": pose}), lambda: world.place("right", TIP, pose)):
        with pytest.raises(InvalidInputError, match="pose"):
            act()
    world.move({"left": (-0.04, 0.0, 0.0)})


def test_a_tip_between_two_blocks_at_rest_squeezes_without_blowing_up(block):
    """A pusher driven into blocks that cannot give way must not make numbers that are not finite."""
    world = PushWorld(Arrangement([block(0, (0.0, 0.0))]))
    world.place("wall", JAW, (0.02, 0.0, 0.0))
    world.place("tip", TIP, (-0.03, 0.0, 0.0))
    world.move({"tip": (0.0, 0.0, 0.0)})
    assert np.isfinite(world.poses()).all()
    assert np.abs(world.poses()[:, :2]).max() < 0.2


def test_restore_is_a_new_world(scene_of):
    scene = scene_of(1)
    used, fresh = PushWorld(scene), PushWorld(scene)
    for world in (used, used, fresh):
        world.restore()
        world.place("tip", TIP, (-0.04, 0.02, 0.0))
        world.move({"tip": (0.03, 0.025, 0.3)})
    assert np.array_equal(used.poses(), fresh.poses())


def test_an_empty_table_is_a_world_too():
    empty = PushWorld(Arrangement([]))
    empty.place("tip", TIP, (0.0, 0.0, 0.0))
    empty.move({"tip": (0.1, 0.0, 0.0)})
    assert len(empty.arrangement()) == 0


@pytest.mark.parametrize("unit", [0.0, -1.0, math.nan, math.inf])
def test_a_unit_without_length_is_refused(block, unit):
    with pytest.raises(InvalidInputError, match="unit"):
        PushWorld(Arrangement([block(0, (0.0, 0.0))]), unit=unit)


def test_a_thousand_blocks_are_pushed_like_a_few(block):
    grid = [block(k, (0.05 * (k % 40), 0.05 * (k // 40))) for k in range(1000)]
    world = PushWorld(Arrangement(grid))
    world.place("tip", TIP, (-0.03, 0.0, 0.0))
    world.move({"tip": (-0.005, 0.0, 0.0)})
    moved = np.flatnonzero(np.abs(world.poses()[:, :2] - Arrangement(grid).centroids).max(axis=1) > 1e-9)
    assert moved.tolist() == [0]
    assert smallest_gap(world.arrangement()) > 0.0


def test_the_authors_preset_coasts(block):
    world = PushWorld(Arrangement([block(0, (0.0, 0.0))]), PushPhysics.authors(), unit=0.02)
    world.place("tip", TIP, (-0.03, 0.0, 0.0))
    world.move({"tip": (-0.005, 0.0, 0.0)})
    at_stop = world.poses()[0, 0]
    world.wait(100)
    # 5/6 of the velocity is kept in each step of 0.1 s: 0.02 m/s * 0.1 s * (5/6) / (1 - 5/6) = 0.01 m.
    assert world.poses()[0, 0] - at_stop == pytest.approx(0.01, rel=0.05)
