"""Settings of the push physics, and footprints of jaws."""

import math
from dataclasses import fields, replace

import numpy as np
import pytest

from singulation_core import ContactMode, InvalidInputError, Push, PusherGeometry
from singulation_core.push_world import Disc, Footprint, PushPhysics, pusher_footprint

PRESETS = ("quasi_static", "fine", "fast", "authors")
JAWS = PusherGeometry(tip_radius=0.005, edge_width=0.02, edge_thickness=0.01)


@pytest.mark.parametrize("name", PRESETS)
def test_presets_by_name(name):
    assert PushPhysics.named(name) == getattr(PushPhysics, name)()


def test_an_unknown_preset_is_refused_with_the_known_ones():
    with pytest.raises(InvalidInputError, match="quasi_static, fine, fast, authors"):
        PushPhysics.named("box2d")


@pytest.mark.parametrize("field", [one.name for one in fields(PushPhysics)])
@pytest.mark.parametrize("value", [math.nan, math.inf, -1.0])
def test_values_that_make_no_physics_are_refused_by_name(field, value):
    with pytest.raises(InvalidInputError, match=field):
        replace(PushPhysics(), **{field: value})
    assert replace(PushPhysics(), friction=0.3).friction == 0.3


def test_sampled_physics_follow_the_paper_and_their_seed():
    drawn = [PushPhysics().sampled(seed) for seed in range(400)]
    assert drawn[3] == PushPhysics().sampled(3)
    friction, density = np.array([(one.friction, one.density) for one in drawn]).T
    assert (friction.mean(), friction.std()) == (pytest.approx(0.5, abs=0.02), pytest.approx(0.1, abs=0.02))
    assert (density.mean(), density.std()) == (pytest.approx(1.0, abs=0.04), pytest.approx(0.2, abs=0.03))


def test_densities_of_single_blocks_follow_the_seed():
    even, uneven = PushPhysics(density=2.0), PushPhysics(density=2.0, density_spread=0.2, seed=4)
    assert even.densities(3) == [2.0, 2.0, 2.0]
    assert uneven.densities(3) == uneven.densities(3)
    assert len(set(uneven.densities(3))) == 3
    assert uneven.densities(3) != replace(uneven, seed=5).densities(3)


def test_footprints_of_the_three_contact_modes():
    start, end = (0.0, 0.0), (0.1, 0.0)
    point = pusher_footprint(Push(start, end, ContactMode.SINGLE_POINT), JAWS)
    assert point.discs == (Disc(0.0, 0.0, 0.005),)
    two = pusher_footprint(Push(start, end, ContactMode.TWO_POINT, 0.03), JAWS)
    assert two.discs == (Disc(0.0, -0.015, 0.005), Disc(0.0, 0.015, 0.005))
    (edge,) = pusher_footprint(Push(start, end, ContactMode.EDGE, 0.02), JAWS).polygons
    assert edge.max(axis=0) == pytest.approx((0.0, 0.01))  # the front edge goes through the point of the push
    assert edge.min(axis=0) == pytest.approx((-0.01, -0.01))


def test_reach_and_thickness_of_a_footprint():
    mixed = Footprint((Disc(0.02, 0.0, 0.005),), (np.array(((0.0, 0.0), (0.01, 0.0), (0.0, 0.004))),))
    assert mixed.reach == pytest.approx(0.025)
    assert mixed.thickness == pytest.approx(0.01)


@pytest.mark.parametrize(
    "make",
    [
        Footprint,
        lambda: Disc(math.nan, 0.0, 0.01),
        lambda: Disc(0.0, 0.0, 0.0),
        lambda: Footprint(polygons=(np.array(((0.0, 0.0), (0.0, 1.0), (1.0, 0.0))),)),
    ],
)
def test_malformed_footprints_are_refused(make):
    with pytest.raises(InvalidInputError, match=r"footprint|disc"):
        make()
    assert Footprint((Disc(0.0, 0.0, 0.01),)).reach == 0.01
