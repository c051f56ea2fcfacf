"""Input of every kind, each with its code, and what every push must keep to."""

import math
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from singulation_core import (
    Arrangement,
    CellGeometry,
    ContactMode,
    InvalidInputError,
    PlanarObject,
    PusherGeometry,
    ResultCode,
    SingulationError,
)
from singulation_core.polygon import contains, separation
from singulation_planner import POLICIES, Placement, plan_push
from singulation_planner.testing import clutter, squares

NAMES = sorted(POLICIES)
GEOMETRIC = sorted(set(POLICIES) - {"brute_force"})
CELL = CellGeometry().workspace_polygon
GOOD = squares([(0.0, 0.0), (0.025, 0.0), (0.01, 0.03)])
scenes = st.builds(clutter, st.integers(2, 12), st.integers(0, 10**6))


def code_of(*arguments, **options):
    with pytest.raises(SingulationError) as caught:
        plan_push(*arguments, **options)
    assert plan_push(GOOD).policy == "cluster_push"
    return caught.value.code, caught.value.message


def test_the_paper_has_nine_policies():
    paper = {
        "cluster_push",
        "brute_force",
        "quasi_random",
        "boundary_shear",
        "cluster_diffusion",
        "center_object_removal",
        "min_contact_range",
        "min_overlap",
        "two_cluster_separation",
    }
    assert paper <= set(POLICIES)
    assert all(policy.name == name and policy.summary for name, policy in POLICIES.items())


@pytest.mark.parametrize("count", [0, 1])
@pytest.mark.parametrize("policy", NAMES)
def test_fewer_than_two_objects_are_nothing_to_do(policy, count):
    code, text = code_of(Arrangement(GOOD.objects[:count]), policy)
    assert code is ResultCode.NOTHING_TO_DO
    assert f"{count} object" in text


@pytest.mark.parametrize("mode", list(ContactMode))
@pytest.mark.parametrize("policy", NAMES)
def test_two_objects_are_enough(policy, mode):
    assert plan_push(
        clutter(2, 4), policy, mode, **({"directions": 4} if policy == "brute_force" else {})
    ).target_id in (0, 1)


@pytest.mark.parametrize("policy", NAMES)
def test_a_row_of_blocks_has_a_push(policy):
    push = plan_push(squares([(0.022 * k, 0.0) for k in range(4)]), policy)
    assert math.isfinite(push.length)


@pytest.mark.parametrize("policy", NAMES)
def test_coincident_blocks_are_an_error_of_perception(policy):
    code, text = code_of(squares([(0.0, 0.0), (0.0, 0.0), (0.05, 0.0)]), policy)
    assert code is ResultCode.OVERLAPPING_OBJECTS
    assert "0 and 1" in text


def test_a_needle_within_a_block_is_an_overlap_however_thin():
    needle = PlanarObject(9, np.array(((-0.01, -0.0001), (0.01, -0.0001), (0.01, 0.0001), (-0.01, 0.0001))))
    code, _ = code_of(Arrangement([*squares([(0.0, 0.0)]).objects, needle]))
    assert code is ResultCode.OVERLAPPING_OBJECTS


def test_a_little_overlap_is_noise():
    assert plan_push(squares([(0.0, 0.0), (0.0195, 0.0)])).target_id in (0, 1)
    code, text = code_of(squares([(0.0, 0.0), (0.0170, 0.0)]))
    assert code is ResultCode.OVERLAPPING_OBJECTS
    assert "0.003 m" in text


def test_how_much_is_noise_can_be_said():
    pair = squares([(0.0, 0.0), (0.0170, 0.0)])
    assert plan_push(pair, overlap_tolerance=0.25).target_id in (0, 1)
    assert code_of(squares([(0.0, 0.0), (0.0195, 0.0)]), overlap_tolerance=0.01)[0] is ResultCode.OVERLAPPING_OBJECTS


def test_separated_objects_are_nothing_to_do_if_told_so():
    pair = squares([(0.0, 0.0), (0.05, 0.0)])
    assert plan_push(pair, min_gap=0.031).target_id in (0, 1)
    code, text = code_of(pair, min_gap=0.029)
    assert code is ResultCode.NOTHING_TO_DO
    assert "0.03 m apart" in text


@pytest.mark.parametrize(
    ("outline", "word"),
    [
        ([(0.0, 0.0), (0.01, 0.0), (float("nan"), 0.01)], "finite"),
        ([(0.0, 0.0), (0.01, 0.0), (0.02, 0.0)], "one line"),
        ([(0.0, 0.0), (0.0, 0.01), (0.01, 0.0)], "clockwise"),
        ([(0.0, 0.0), (0.01, 0.01), (0.01, 0.0), (0.0, 0.01)], "vertices lie on one line|crosses|convex"),
        ([(0.0, 0.0), (0.02, 0.0), (0.02, 0.02), (0.01, 0.005)], "convex"),
    ],
)
def test_malformed_outlines_do_not_become_objects(outline, word):
    with pytest.raises(InvalidInputError, match=word) as caught:
        PlanarObject(5, np.array(outline))
    assert caught.value.code is ResultCode.INVALID_INPUT
    assert "object 5" in caught.value.message


@pytest.mark.parametrize("policy", NAMES)
def test_a_block_outside_the_workspace_is_refused(policy):
    code, text = code_of(squares([(0.0, 0.0), (0.025, 0.0), (0.5, 0.0)]), policy, workspace=CELL)
    assert code is ResultCode.OUTSIDE_WORKSPACE
    assert "object 2" in text


@pytest.mark.parametrize("policy", NAMES)
def test_without_a_reachable_start_the_reasons_are_counted(policy):
    crowded = squares([(0.0201 * column, 0.0201 * row) for column in range(2) for row in range(2)])
    tight = np.array(((-0.0102, -0.0102), (0.0303, -0.0102), (0.0303, 0.0303), (-0.0102, 0.0303)))
    code, text = code_of(crowded, policy, workspace=tight)
    assert code is ResultCode.NO_PUSH
    assert "outside the workspace" in text
    assert "another object is in the way" in text
    number = int(text.split("of ")[1].split()[0])
    parts = [int(word) for word in text.split("pushes ")[1].replace(",", "").split() if word.isdigit()]
    assert number == sum(parts)


def test_unknown_names_are_answered_with_the_known_ones():
    code, text = code_of(GOOD, "cluster_pull")
    assert code is ResultCode.UNKNOWN_POLICY
    assert all(name in text for name in NAMES)
    code, text = code_of(GOOD, contact_mode="fist")
    assert code is ResultCode.UNKNOWN_CONTACT_MODE
    assert "two_point" in text
    assert code_of(GOOD, contact_mode=9)[0] is ResultCode.UNKNOWN_CONTACT_MODE


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"case_one": "sometimes"}, "'both'"),
        ({"case_three": 1}, "case_one"),
        ({"push_distance": 0.0}, "0.0 m"),
        ({"push_distance": float("nan")}, "nan"),
        ({"push_distance_factor": float("inf")}, "inf"),
        ({"workspace": [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0)]}, "clockwise"),
        ({"workspace": [(0.0, 0.0), (1.0, 0.0)]}, "shape"),
        ({"workspace": [(0.0, 0.0), (1.0, 0.0), (1.0,)]}, "workspace"),
        ({"policy": "brute_force", "offsets": 0}, "positive int"),
        ({"policy": "brute_force", "max_objects": 2}, "3 objects"),
        ({"policy": "quasi_random", "case_one": "both"}, "none"),
    ],
)
def test_bad_arguments_are_refused_with_what_would_be_right(options, words):
    code, text = code_of(GOOD, **options)
    assert code is ResultCode.INVALID_INPUT
    assert words in text


@pytest.mark.parametrize(
    "options",
    [{"start": "inside"}, {"fits": "nothing"}, {"clearance": -1.0}, {"retreat": float("nan")}, {"widest_jaw": 0.0}],
)
def test_a_bad_placement_is_refused(options):
    with pytest.raises(InvalidInputError, match=next(iter(options))):
        Placement(**options)


@pytest.fixture(scope="module")
def thousand():
    """Rows and columns with so little room between them that only the blocks at the rim can be pushed."""
    return squares([(0.0205 * column, 0.0207 * row) for column in range(40) for row in range(25)])


@pytest.mark.parametrize("policy", GEOMETRIC)
def test_a_thousand_objects_are_planned(policy, thousand):
    assert plan_push(thousand, policy).policy == policy


def test_brute_force_of_a_thousand_objects_is_refused(thousand):
    code, text = code_of(thousand, "brute_force")
    assert code is ResultCode.INVALID_INPUT
    assert "max_objects" in text


def footprint(push, pusher):
    """Convex parts of the jaws at the start of a push; discs as 64-gons around them."""
    left = np.array((-push.direction[1], push.direction[0]))
    half = 0.5 * push.contact_width * left
    if push.contact_mode is ContactMode.EDGE:
        back = push.start - pusher.edge_thickness * push.direction
        return [np.array((push.start - half, push.start + half, back + half, back - half))]
    angles = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
    disc = pusher.tip_radius / np.cos(np.pi / 64) * np.column_stack((np.cos(angles), np.sin(angles)))
    return [push.start + side + disc for side in ((half, -half) if push.contact_width else (half,))]


@pytest.mark.parametrize("policy", GEOMETRIC)
@settings(max_examples=20, deadline=None)
@given(scenes, st.sampled_from(list(ContactMode)), st.floats(0.3, 4.0))
def test_the_pusher_starts_free_close_to_its_object_and_inside(policy, arrangement, mode, factor):
    pusher = PusherGeometry()
    wide = 0.25 * np.array(((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)))
    push = plan_push(arrangement, policy, mode, workspace=wide, push_distance_factor=factor)
    clearance, scale = pusher.tip_radius / 6.0, float(arrangement.bounding_radii.mean())
    assert push.length == pytest.approx(clearance + factor * scale)
    for item in arrangement.objects:
        gap = min(separation(part, item.outline) for part in footprint(push, pusher))
        assert gap > (0.0 if item.id == push.target_id else 0.95 * clearance)
    target = arrangement.objects[arrangement.index(push.target_id)]
    at_contact = [part + 3.0 * clearance * push.direction for part in footprint(push, pusher)]
    assert min(separation(part, target.outline) for part in at_contact) < 1e-9
    assert contains(wide, [push.start, push.end], margin=0.999 * min(pusher.tip_radius, pusher.edge_width / 2)).all()


def test_the_width_of_the_contact_is_the_jaws():
    arrangement = clutter(4, 8)
    assert plan_push(arrangement).contact_width == 0.0
    assert plan_push(arrangement, contact_mode="edge").contact_width == PusherGeometry().edge_width
    push = plan_push(arrangement, contact_mode="two_point")
    radius = arrangement.objects[arrangement.index(push.target_id)].bounding_radius
    assert push.contact_width == pytest.approx(0.6 * radius)
    narrow = plan_push(arrangement, contact_mode="two_point", placement=Placement(widest_jaw=0.004))
    assert narrow.contact_width == pytest.approx(0.004)


def test_the_geometric_policies_promise_no_gain():
    pushes = [plan_push(GOOD, policy) for policy in GEOMETRIC if policy != "rollout_push"]
    assert all(math.isnan(push.expected_gain) and push.expected is None for push in pushes)


def test_another_process_plans_the_same_to_the_last_bit():
    script = (
        "from singulation_planner import plan_push; from singulation_planner.testing import clutter\n"
        "for name in %r:\n"
        "    push = plan_push(clutter(7, 3), name, seed=5)\n"
        "    print(push.start.tobytes().hex(), push.target_id)"
    )
    done = subprocess.run(
        [sys.executable, "-c", script % GEOMETRIC], capture_output=True, text=True, check=True, timeout=60.0
    )
    here = [plan_push(clutter(7, 3), name, seed=5) for name in GEOMETRIC]
    assert done.stdout.splitlines() == [f"{push.start.tobytes().hex()} {push.target_id}" for push in here]


def test_importing_the_package_compiles_nothing():
    script = "import sys, singulation_planner; print('numba' in sys.modules, 'pymunk' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True, timeout=60.0)
    assert done.stdout.split() == ["False", "False"]


def test_what_is_not_there_is_an_attribute_error():
    import singulation_planner

    with pytest.raises(AttributeError, match="no_such_name"):
        _ = singulation_planner.no_such_name
