"""Where a push starts, and what is not pushed because it might leave the table."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from singulation_core import Arrangement, ContactMode, PlanarObject, PusherGeometry, ResultCode, SingulationError
from singulation_core.polygon import inward_half_planes, separation
from singulation_core.push_world import simulate_push
from singulation_planner import Placement, plan_push
from singulation_planner.candidates import Candidates
from singulation_planner.placer import make_placer
from singulation_planner.scene import Scene
from singulation_planner.testing import clutter, squares
from singulation_planner.workspace import workspace_walls

PUSHER = PusherGeometry(0.006, 0.0124, 0.012)
CLEARANCE = PUSHER.tip_radius / 6.0
RIGHT, LEFT, UP = (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0)


def placer(arrangement, mode=ContactMode.SINGLE_POINT, placement=None, workspace=None, travel=0.02):
    scene = Scene.of(arrangement)
    return make_placer(scene, mode, travel, PUSHER, placement or Placement(), workspace_walls(workspace, scene))


def candidate(made, object_id, direction, offset=0.0):
    index = next(k for k in range(len(made.scene)) if made.scene.object_id(k) == object_id)
    return Candidates(np.array([index]), np.array([direction]), np.array([offset]))


def start(made, object_id, direction, offset=0.0):
    found = made.first_feasible(candidate(made, object_id, direction, offset))
    return None if found is None else found[1]


def far_apart():
    return squares([(0.0, 0.0), (0.5, 0.5)])


def test_a_disc_starts_just_off_the_face():
    np.testing.assert_allclose(start(placer(far_apart()), 0, RIGHT), (-0.01 - PUSHER.tip_radius - CLEARANCE, 0.0))


def test_a_disc_beside_a_corner_reaches_past_it():
    got = start(placer(far_apart()), 0, RIGHT, offset=0.012)
    radius = PUSHER.tip_radius + CLEARANCE
    np.testing.assert_allclose(got, (-0.01 - np.sqrt(radius**2 - 0.002**2), 0.012))


def test_a_line_that_passes_the_object_is_counted_as_such():
    made = placer(far_apart())
    assert start(made, 0, RIGHT, offset=0.0175) is None
    assert "1 pass beside the object" in made.why_none()


def test_an_edge_starts_with_its_front_off_the_face():
    made = placer(far_apart(), ContactMode.EDGE)
    np.testing.assert_allclose(start(made, 0, RIGHT), (-0.01 - CLEARANCE, 0.0))


def test_an_edge_meets_the_corner_of_a_turned_square():
    diamond = PlanarObject(0, 0.01 * np.array(((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))))
    made = placer(Arrangement([diamond, *squares([(0.0, 0.0), (0.5, 0.5)]).objects[1:]]), ContactMode.EDGE)
    np.testing.assert_allclose(start(made, 0, RIGHT), (-0.01 - CLEARANCE, 0.0))
    # Beside the corner it meets the slope: half of its width reaches over the corner's height.
    half = 0.5 * PUSHER.edge_width + CLEARANCE
    np.testing.assert_allclose(start(made, 0, RIGHT, offset=0.009), (-0.01 + 0.009 - half - CLEARANCE, 0.009))


def test_two_points_stand_on_both_sides_of_the_line():
    diamond = PlanarObject(0, 0.01 * np.array(((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))))
    made = placer(Arrangement([diamond, *squares([(0.0, 0.0), (0.5, 0.5)]).objects[1:]]), ContactMode.TWO_POINT)
    x, y = start(made, 0, RIGHT)
    radius, half = PUSHER.tip_radius + CLEARANCE, 0.5 * 0.6 * 0.01
    assert y == 0.0
    assert x == pytest.approx(-0.01 - np.sqrt(radius**2 - half**2))  # each rests against the corner between them


def test_a_neighbour_in_the_way_blocks_the_start():
    made = placer(squares([(0.0, 0.0), (-0.025, 0.0)]))
    assert start(made, 0, RIGHT) is None
    assert "1 start where another object is in the way" in made.why_none()
    assert start(made, 0, LEFT) is not None


@pytest.mark.parametrize(("gap", "mode", "free"), [
    (0.0135, ContactMode.SINGLE_POINT, False),
    (0.0145, ContactMode.SINGLE_POINT, True),
    (0.0135, ContactMode.EDGE, False),
    (0.0145, ContactMode.EDGE, True),
    (0.0145, ContactMode.TWO_POINT, True),
])  # fmt: skip
def test_the_gap_must_hold_the_jaws_and_the_clearance_on_both_sides(gap, mode, free):
    got = start(placer(squares([(0.0, 0.0), (-0.02 - gap, 0.0)]), mode), 0, RIGHT)
    assert (got is not None) == free


def test_a_wide_pusher_needs_a_wide_gap():
    """A slot above and below the push line that one tip fits in, two do not."""
    slot = squares([(0.0, 0.0), (-0.022, 0.0205), (-0.022, -0.0205)])
    assert start(placer(slot), 0, RIGHT) is not None
    assert start(placer(slot, ContactMode.TWO_POINT), 0, RIGHT) is None
    every = Placement(fits="every_mode")
    assert start(placer(slot, placement=every), 0, RIGHT) is None
    assert start(placer(far_apart(), placement=every), 0, RIGHT) is not None


def test_the_bounding_circle_is_further_out():
    outline, circle = placer(far_apart()), placer(far_apart(), placement=Placement(start="bounding_circle"))
    radius = 0.01 * np.sqrt(2.0)
    np.testing.assert_allclose(start(circle, 0, RIGHT), (-radius - PUSHER.tip_radius - CLEARANCE, 0.0))
    assert start(circle, 0, RIGHT)[0] < start(outline, 0, RIGHT)[0]


def test_a_blocked_start_moves_back_only_when_told_so():
    crowd = squares([(0.0, 0.0), (-0.03, 0.0)])
    assert start(placer(crowd), 0, RIGHT) is None
    moved = start(placer(crowd, placement=Placement(retreat=0.06, retreat_step=0.001)), 0, RIGHT)
    assert -0.04 - 2.0 * PUSHER.tip_radius < moved[0] < -0.04 - PUSHER.tip_radius - 0.999 * CLEARANCE
    assert start(placer(crowd, placement=Placement(retreat=0.01)), 0, RIGHT) is None


@settings(max_examples=60, deadline=None)
@example(clutter(6, 73135), ContactMode.EDGE, 0.0, -0.875)  # past a corner, 1.2 clearances away
@given(
    st.builds(clutter, st.integers(2, 8), st.integers(0, 10**5)),
    st.sampled_from(list(ContactMode)),
    st.floats(-np.pi, np.pi),
    st.floats(-0.9, 0.9),
)
def test_free_and_blocked_starts_are_told_apart(arrangement, mode, angle, share):
    """Against the same question asked of outlines by the separating axes of singulation_core."""
    made = placer(arrangement, mode)
    direction = np.array((np.cos(angle), np.sin(angle)))
    one = Candidates(np.array([0]), direction[None], np.array([share * made.scene.radii[0]]))
    starts, status = made._blank(1)
    made._place(one, 0, True, starts, status)
    if status[0] == 1:  # passes beside
        return
    jaws = _jaws_and_clearance(starts[0], direction, made)
    target = made.scene.order[0]
    gaps = [
        min(separation(part, item.outline) for part in jaws)
        for position, item in enumerate(arrangement.objects)
        if position != target
    ]
    if abs(min(gaps)) > 2e-4:  # round jaws are polygons here
        assert (status[0] == 0) == (min(gaps) > 0.0)


def _jaws_and_clearance(at, direction, made):
    """The jaws, larger by the clearance; an edge keeps its square corners."""
    left = np.array((-direction[1], direction[0]))
    if made.mode is ContactMode.EDGE:
        half, front = (0.5 * PUSHER.edge_width + CLEARANCE) * left, at + CLEARANCE * direction
        back = at - (PUSHER.edge_thickness + CLEARANCE) * direction
        return [np.array((front - half, front + half, back + half, back - half))]
    angles = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    disc = (PUSHER.tip_radius + CLEARANCE) * np.column_stack((np.cos(angles), np.sin(angles)))
    half = 0.5 * made.contact_width(0) * left
    return [at + side + disc for side in (half, -half)]


BIN = np.array(((-0.05, -0.05), (0.05, -0.05), (0.05, 0.05), (-0.05, 0.05)))


@pytest.mark.parametrize(
    ("where", "direction", "reason"),
    [
        ((0.03, 0.0), LEFT, "start or end outside the workspace"),  # no room for the pusher behind it
        ((0.03, 0.0), RIGHT, "over the edge"),
        ((0.0, 0.0), UP, None),
    ],
)
def test_pusher_and_object_stay_inside(where, direction, reason):
    pair = squares([where, (-0.03, -0.03)])
    made = placer(pair, workspace=BIN)
    assert (start(made, 0, direction) is None) == (reason is not None)
    assert reason is None or reason in made.why_none()


def test_what_a_block_pushes_stays_inside_too():
    alone = placer(squares([(0.0, 0.0), (-0.03, -0.03)]), workspace=BIN, travel=0.025)
    assert start(alone, 0, RIGHT) is not None
    row = placer(squares([(0.0, 0.0), (0.0205, 0.0), (-0.03, -0.03)]), workspace=BIN, travel=0.025)
    assert start(row, 0, RIGHT) is None
    assert "over the edge" in row.why_none()


def test_a_block_that_sticks_out_is_pushed_inwards():
    made = placer(squares([(0.044, 0.0), (-0.03, -0.03)]), workspace=3.0 * BIN, travel=0.02)
    assert start(made, 0, RIGHT) is not None
    tight = np.array(((-0.1, -0.1), (0.05, -0.1), (0.05, 0.1), (-0.1, 0.1)))
    edge = placer(squares([(0.044, 0.0), (-0.03, -0.03)]), workspace=tight)
    assert start(edge, 0, UP) is None
    assert start(edge, 0, (-np.sqrt(0.5), -np.sqrt(0.5))) is None  # the pusher itself would stand outside


@pytest.mark.parametrize("policy", ["cluster_push", "cluster_diffusion", "quasi_random"])
def test_no_simulated_push_carries_a_block_off_the_table(policy):
    table = np.array(((-0.16, -0.21), (0.16, -0.21), (0.16, 0.21), (-0.16, 0.21)))
    normals, limits = inward_half_planes(table)
    done = 0
    for seed in range(25):
        moved = [item.moved(_corner(seed)) for item in clutter(6, seed).objects]
        inside = [item for item in moved if (item.outline @ normals.T - limits).min() > 0.0]
        if len(inside) < 2:
            continue
        arrangement = Arrangement(inside)
        try:
            push = plan_push(arrangement, policy, seed % 3, workspace=table, seed=seed, push_distance_factor=2.0)
        except SingulationError as error:
            assert error.code is ResultCode.NO_PUSH
            continue
        after = simulate_push(arrangement, push)
        done += 1
        outside = min(float((item.outline @ normals.T - limits).min()) for item in after.objects)
        assert outside > -0.1 * arrangement.bounding_radii.max()
    assert done > 10


def _corner(seed):
    return np.array((0.11, 0.15)) * np.array(((1, 1), (1, -1), (-1, 1), (-1, -1), (1, 0)))[seed % 5]
