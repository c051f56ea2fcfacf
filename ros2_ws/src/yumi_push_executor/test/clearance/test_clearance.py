"""Distances of the robot to what stands around it, against distances known beforehand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from singulation_core import Arrangement, CellGeometry, PlanarObject
from yumi_push_executor import YumiArm
from yumi_push_executor.clearance import Checker, Margins, Stage, build_scene
from yumi_push_executor.clearance.shapes import FINGER, GRIPPER, robot_shapes
from yumi_push_executor.kinematics import BRANCHES, CLEAR_VIEW, FOLDED, TIP_OFFSET
from yumi_push_executor.motion.jaws import tool_pose

CELL = CellGeometry()
SQUARE = 0.02 * np.array(((-1, -1), (1, -1), (1, 1), (-1, 1)))
NO_MARGIN = Margins(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
FINGER_LENGTH = 0.0523


def over(x, y, height, heading=np.pi / 2):
    """Left arm with its jaws straight down over a point of the table."""
    pose = tool_pose(CELL.body_from_table, np.array((x, y)), height, heading, TIP_OFFSET)
    return YumiArm("left").inverse(pose, BRANCHES[0]["left"])


def nearest(q, blocks=(), stage=Stage.TRAVEL, opening=0.0, touched=(), right=CLEAR_VIEW["right"], margins=NO_MARGIN):
    scene = build_scene("left", CELL, Arrangement(blocks), touched, np.array((0.05, 0.0)), 0.05)
    checker = Checker(scene, {"left": q, "right": right}, opening, margins)
    slack, contact = checker.smallest_slack(q, stage)
    found = checker.first_contact(q[None], stage)
    assert (found is not None) == (slack < 0.0)  # both ways to ask agree
    return slack, contact


@pytest.mark.parametrize("height", [0.02, 0.004, 0.0011])
def test_fingers_over_the_bare_table(height):
    slack, contact = nearest(over(0.0, 0.0, height))
    assert slack == pytest.approx(height, abs=2e-4)
    assert {contact.first.rsplit(" ", 1)[0], contact.second} == {"left finger", "table"}


@pytest.mark.parametrize("gap", [0.010, 0.004])
def test_closed_fingers_beside_a_block(gap):
    # Closed, the fingers are 12.4 mm thick in the closing direction, which lies along y here.
    block = PlanarObject(5, SQUARE + (0.0, 0.02 + 0.0062 + gap), height=0.03)
    slack, contact = nearest(over(0.0, 0.0, 0.012), [block])
    assert slack == pytest.approx(gap, abs=2e-4)
    assert "block 5" in (contact.first, contact.second)


def test_open_jaws_reach_further():
    block = PlanarObject(5, SQUARE + (0.0, 0.02 + 0.0062 + 0.02), height=0.03)
    closed, _ = nearest(over(0.0, 0.0, 0.03), [block])
    opened, _ = nearest(over(0.0, 0.0, 0.03), [block], opening=0.03)
    assert closed - opened == pytest.approx(0.015, abs=2e-4)


def test_the_palm_over_a_block():
    block = PlanarObject(5, SQUARE + (0.028, 0.0), height=0.038)
    slack, contact = nearest(over(0.0, 0.0, 0.005), [block], touched=[5], stage=Stage.PUSH)
    palm = 0.005 + TIP_OFFSET - 0.093  # the gripper's body is 93 mm long
    assert slack == pytest.approx(min(palm - 0.038, 0.005), abs=2e-4)
    assert "left" in contact.first


def test_what_the_stages_allow():
    pushed, bystander = (PlanarObject(k, SQUARE + (x, 0.0), height=0.03) for k, x in ((1, 0.0), (2, 0.0401)))
    q = over(0.0, 0.0, 0.005)
    inside = {stage: nearest(q, [pushed], stage, touched=[1])[0] < 0.0 for stage in Stage}
    assert inside == {
        Stage.TRAVEL: True,
        Stage.LEAVE: False,
        Stage.DESCEND: True,
        Stage.PUSH: False,
        Stage.CLEAR: True,
    }
    assert nearest(over(0.04, 0.0, 0.005), [pushed, bystander], Stage.PUSH, touched=[1])[0] < 0.0


def test_blocks_may_have_moved_when_the_arm_leaves():
    block = PlanarObject(1, SQUARE, height=0.03)
    ahead = over(0.06, 0.0, 0.02)  # where the push of 5 cm can have carried it
    assert nearest(ahead, [block], Stage.TRAVEL, touched=[1])[0] > 0.0
    slack, contact = nearest(ahead, [block], Stage.CLEAR, touched=[1])
    assert slack < 0.0 and "moved blocks" in (contact.first, contact.second)


def test_the_other_arm():
    q = over(0.0, 0.0, 0.02)
    mirrored = YumiArm("right").inverse(
        tool_pose(CELL.body_from_table, np.array((0.0, -0.03)), 0.02, 0.0, TIP_OFFSET), BRANCHES[0]["right"]
    )
    slack, contact = nearest(q, right=mirrored)
    assert slack < 0.0
    assert contact.first.startswith("left") and contact.second.startswith("right")


def test_margins_move_the_border():
    q = over(0.0, 0.0, 0.02)
    assert nearest(q, margins=Margins(finger_travel=0.019))[0] == pytest.approx(0.001, abs=3e-4)
    assert nearest(q, margins=Margins(finger_travel=0.021))[0] < 0.0


@pytest.mark.parametrize("postures", [CLEAR_VIEW, FOLDED])
def test_the_named_postures_are_clear_for_both_arms(postures):
    for name in ("left", "right"):
        scene = build_scene(name, CELL, Arrangement(()), (), np.zeros(2), 0.05)
        checker = Checker(scene, postures, 0.05, Margins())
        slack, contact = checker.smallest_slack(postures[name], Stage.TRAVEL)
        assert slack > 0.02, contact


@pytest.mark.parametrize(
    "degrees",
    [(-62.62, -20.31, 36.71, 44.91, 78.61, 74.79, -90.07), (-51.16, -99.4, 36.0, 21.57, 107.19, 84.11, 94.61)],
)
def test_postures_recorded_on_a_real_robot_are_clear(degrees):
    slack, contact = nearest(np.deg2rad(np.array(degrees)), right=FOLDED["right"])
    assert slack > 0.02, contact


def test_every_shape_belongs_to_a_part():
    shapes = robot_shapes()
    for arm in ("left", "right"):
        parts = [shape.part for shape in shapes if shape.arm == arm]
        assert set(parts) == set(range(1, 8)) | {GRIPPER, FINGER}
        assert parts.count(FINGER) == 4
    assert {shape.part for shape in shapes if not shape.arm} == {0}


@given(st.sampled_from(("left", "right")), st.sampled_from(list(Stage)), st.integers(0, 2**32 - 1))
def test_what_is_left_out_as_far_away_could_not_have_met(name, stage, seed):
    random = np.random.default_rng(seed)
    other = "right" if name == "left" else "left"
    blocks = [PlanarObject(k, SQUARE + random.uniform(-0.15, 0.15, 2), height=0.05) for k in range(3)]
    scene = build_scene(name, CELL, Arrangement(blocks), [0], np.array((0.03, 0.02)), 0.05)
    postures = {name: CLEAR_VIEW[name], other: BRANCHES[0][other] + random.normal(0.0, 0.3, 7)}
    checker = Checker(scene, postures, 0.02, Margins())
    along = (
        BRANCHES[random.integers(3)][name]
        + random.normal(0.0, 0.3, 7)
        + random.normal(0.0, 0.1, (random.integers(1, 7), 7))
    )
    slack = [checker.smallest_slack(q, stage)[0] for q in along]
    found = checker.first_contact(along, stage)
    assert (len(along) if found is None else found[0]) == next(
        (k for k, one in enumerate(slack) if one < 0.0), len(along)
    )
