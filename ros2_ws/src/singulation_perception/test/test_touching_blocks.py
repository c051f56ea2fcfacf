"""Blocks that touch, overlap in the image or hide something: what the cloud shows of them, and what it does not."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ros2_ws.src.singulation_perception.test.table_top import PARAMETERS, box, cloud, turned

from singulation_perception import segment, segment_cloud
from singulation_perception.shapes import shared_area


def expect(seen, *blocks, doubt=0.0):
    """One object for each block and no other, with the height of its top and four fifths of its outline in common.

    An outline may be worse where its confidence is below ``doubt``.
    """
    assert len(seen) == len(blocks)
    for outline, height in blocks:
        middle = np.mean(outline, axis=0)
        item = min(seen.objects, key=lambda item: np.hypot(*(item.centroid - middle)))
        shared, seen_area, true_area = shared_area(np.ascontiguousarray(item.outline), np.ascontiguousarray(outline))
        assert shared > 0.8 * (seen_area + true_area - shared) or item.confidence < doubt
        assert item.height == pytest.approx(height, abs=0.001)


def pair(angle, offset, second_height=0.03):
    """A block with a smaller one flush against its side, turned by ``angle`` and shifted along by ``offset``."""
    first, second = box(0.0, 0.0, 0.05, 0.05), box(0.025 + 0.016, offset, 0.032, 0.03)
    return (turned(first, angle), 0.03), (turned(second, angle), second_height)


@pytest.mark.parametrize("angle", [0.0, 0.3, 0.8, 1.2])
def test_touching_blocks_of_one_height_are_told_apart_by_their_corners(angle):
    blocks = pair(angle, 0.003)
    expect(segment(cloud(*blocks), PARAMETERS), *blocks)


@pytest.mark.parametrize("angle", [0.0, 0.3, 0.8, 2.0])
def test_a_seam_with_a_corner_at_either_end_leaves_no_doubt(angle):
    assert all(item.confidence > 0.9 for item in segment(cloud(*pair(angle, 0.004)), PARAMETERS).objects)


@pytest.mark.parametrize("angle", [0.0, 0.3, 0.8, 2.0])
def test_blocks_that_are_flush_at_one_end_are_doubted_because_nothing_shows_where_their_seam_ends(angle):
    seen = segment(cloud(*pair(angle, 0.010)), PARAMETERS)
    assert all(item.confidence < 0.5 for item in seen.objects)


@given(st.floats(0.0, 3.1), st.floats(-0.006, 0.006))
@settings(max_examples=12, deadline=None)
def test_touching_blocks_of_one_height_are_drawn_well_or_doubted(angle, offset):
    blocks = pair(angle, offset)
    expect(segment(cloud(*blocks), PARAMETERS), *blocks, doubt=0.5)


@given(st.floats(0.0, 3.1), st.floats(-0.01, 0.01), st.sampled_from([0.02, 0.025, 0.035]))
@settings(max_examples=12, deadline=None)
def test_touching_blocks_of_two_heights_are_told_apart_by_the_step(angle, offset, height):
    blocks = pair(angle, offset, height)
    expect(segment(cloud(*blocks), PARAMETERS), *blocks)


def test_flush_blocks_of_nearly_one_height_are_told_apart_by_a_step_of_half_a_millimetre():
    blocks = (box(-0.02, 0.0, 0.04, 0.05), 0.03), (box(0.02, 0.0, 0.04, 0.05), 0.0305)
    expect(segment(cloud(*blocks), PARAMETERS), *blocks)


def test_flush_blocks_are_told_apart_by_a_groove():
    flush = (box(-0.02, 0.0, 0.04, 0.05), 0.03), (box(0.0205, 0.0, 0.041, 0.05), 0.03)
    others = (box(0.0, 0.1, 0.05, 0.05), 0.03), (box(0.0, -0.1, 0.05, 0.05), 0.03)
    points = cloud(*flush, *others)
    column = points.shape[1] // 2
    points[155:205:2, column] = np.nan
    points[156:205:3, column] = np.nan
    expect(segment(points, PARAMETERS), *flush, *others)


def test_two_blocks_without_any_trace_between_them_are_one_that_is_doubted():
    singles = [(box(x, y, 0.03, 0.03), 0.03) for x in (-0.09, 0.09) for y in (-0.1, 0.0, 0.1)]
    seen = segment(cloud(*singles, (box(0.0, 0.0, 0.03, 0.07), 0.03)), PARAMETERS)
    assert len(seen) == len(singles) + 1
    longest = max(seen.objects, key=lambda item: item.bounding_radius)
    assert longest.confidence < 0.5
    assert all(item.confidence > 0.8 for item in seen.objects if item is not longest)


def test_with_splitting_turned_off_a_merged_outline_is_one_object_that_is_doubted():
    seen = segment(cloud(*pair(0.3, 0.0)), replace(PARAMETERS, split_touching=False))
    assert len(seen) == 1
    assert seen.objects[0].confidence <= 0.5


def test_a_block_on_another_makes_one_pile_with_little_confidence():
    seen = segment_cloud(cloud((box(0.0, 0.0, 0.06, 0.06), 0.02), (box(0.0, 0.0, 0.03, 0.03), 0.045)), PARAMETERS)
    assert len(seen.arrangement) == 1
    pile = seen.arrangement.objects[0]
    assert pile.height == pytest.approx(0.045, abs=0.001)
    assert pile.area == pytest.approx(0.06**2, rel=0.1)
    assert pile.confidence < 0.5
    assert seen.dropped["stacked"] == 1


def test_missing_points_inside_a_face_leave_the_outline_and_lower_the_confidence():
    points = cloud((box(0.0, 0.0, 0.05, 0.05), 0.03), (box(0.0, 0.09, 0.05, 0.05), 0.03))
    points[165:195, 128:152] = np.nan
    seen = segment(points, PARAMETERS)
    expect(seen, (box(0.0, 0.0, 0.05, 0.05), 0.03), (box(0.0, 0.09, 0.05, 0.05), 0.03))
    holed, whole = sorted(seen.objects, key=lambda item: abs(item.centroid[1]))
    assert holed.confidence < whole.confidence


@pytest.mark.parametrize(
    ("outline", "height", "reason"),
    [(box(0.0, 0.0, 0.004, 0.08), 0.03, "sliver"), (box(0.0, 0.0, 0.06, 0.06), 0.15, "tall"),
     (box(0.0, 0.0, 0.005, 0.005), 0.03, "small")],
    ids=["a thin wall", "an arm", "a crumb"],
)  # fmt: skip
def test_what_cannot_be_a_block_is_counted_and_left_out(outline, height, reason):
    block = (box(0.0, 0.1, 0.04, 0.04), 0.03)
    seen = segment_cloud(cloud(block, (outline, height)), PARAMETERS)
    expect(seen.arrangement, block)
    assert seen.dropped[reason] > 0


def test_every_point_of_a_block_has_its_label_and_the_table_has_none():
    blocks = pair(0.4, 0.003)
    points = cloud(*blocks)
    seen = segment_cloud(points, PARAMETERS)
    assert seen.labels.shape == points.shape[:2]
    for item in seen.arrangement.objects:
        assert np.count_nonzero(seen.labels == item.id) == pytest.approx(item.area / 1e-6, rel=0.1)
    assert np.count_nonzero(seen.labels < 0) > 0.9 * seen.labels.size
