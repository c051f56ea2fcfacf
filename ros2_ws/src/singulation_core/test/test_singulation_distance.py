"""The metric of the paper and the smallest gap."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from singulation_core import Arrangement, InvalidInputError, PlanarObject, singulation_distance, smallest_gap
from singulation_core.polygon import separation

SIDE = 0.02
SQUARE = np.array(((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))) * SIDE / 2


def scene(*centres):
    return Arrangement([PlanarObject(k, SQUARE + centre) for k, centre in enumerate(centres)])


CENTRES = st.lists(st.tuples(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3)), min_size=2, max_size=8)


def test_is_the_mean_logarithm_over_pairs():
    three = scene((0.0, 0.0), (0.1, 0.0), (0.0, 0.2))
    wanted = (math.log(0.1) + math.log(0.2) + math.log(math.hypot(0.1, 0.2))) / 3
    assert singulation_distance(three, unit=1.0) == pytest.approx(wanted)


def test_the_default_unit_is_the_mean_bounding_radius():
    two = scene((0.0, 0.0), (0.1, 0.0))
    assert singulation_distance(two) == pytest.approx(math.log(0.1 / (SIDE / math.sqrt(2.0))))


@given(CENTRES, st.floats(1e-3, 1e3))
def test_another_unit_adds_a_constant(centres, unit):
    before = scene(*centres)
    assert singulation_distance(before, unit) == pytest.approx(
        singulation_distance(before, 1.0) - math.log(unit), abs=1e-9
    )


@given(CENTRES)
def test_order_does_not_matter(centres):
    assert singulation_distance(scene(*centres), 1.0) == pytest.approx(singulation_distance(scene(*centres[::-1]), 1.0))


def test_coincident_centroids_are_not_infinitely_close():
    assert math.isfinite(singulation_distance(scene((0.0, 0.0), (0.0, 0.0))))


@pytest.mark.parametrize("count", [0, 1])
def test_without_a_pair_it_is_not_a_number(count):
    few = scene(*[(0.0, 0.0)] * count)
    assert math.isnan(singulation_distance(few))
    assert smallest_gap(few) == math.inf


@pytest.mark.parametrize("unit", [0.0, -1.0, math.nan, math.inf])
def test_a_unit_without_length_is_refused(unit):
    two = scene((0.0, 0.0), (0.1, 0.0))
    with pytest.raises(InvalidInputError, match="unit"):
        singulation_distance(two, unit)
    assert math.isfinite(singulation_distance(two))


@settings(max_examples=40)
@given(CENTRES)
def test_smallest_gap_is_the_smallest_over_all_pairs(centres):
    blocks = scene(*centres).objects
    gaps = [separation(a.outline, b.outline) for k, a in enumerate(blocks) for b in blocks[k + 1 :]]
    assert smallest_gap(scene(*centres)) == pytest.approx(min(gaps), abs=1e-12)


def test_smallest_gap_is_negative_where_blocks_overlap():
    assert smallest_gap(scene((0.0, 0.0), (0.015, 0.0), (0.3, 0.0))) == pytest.approx(-0.005)
