"""What the camera sees of the arms."""

import dataclasses

import numpy as np
import pytest

from singulation_core import CellGeometry
from singulation_core.transforms import inverse
from yumi_push_executor import YumiArm
from yumi_push_executor.clearance import FIELD_OF_VIEW, parts_in_view
from yumi_push_executor.kinematics import BRANCHES, CLEAR_VIEW

CELL = CellGeometry()


def test_clear_view_is_clear_with_room_to_spare():
    assert parts_in_view(CLEAR_VIEW) == []
    beyond_shoulder = [
        part for part in parts_in_view(CLEAR_VIEW, margin=0.05) if "link_1" not in part and "link_2" not in part
    ]
    assert beyond_shoulder == []


@pytest.mark.parametrize("name", ["left", "right"])
def test_an_arm_over_the_table_is_seen(name):
    parts = parts_in_view({name: BRANCHES[0][name]})
    assert f"{name}_tool0_0" in parts
    assert parts_in_view({name: CLEAR_VIEW[name]}) == []


def test_the_border_is_where_the_pinhole_model_puts_it():
    """A finger tip that projects just inside the image is seen, one well outside is not."""
    arm, seen, hidden = YumiArm("left"), 0, 0
    camera_from_body = inverse(CELL.body_from_table @ CELL.table_from_camera)
    for share in np.linspace(0.0, 1.0, 60):
        q = CLEAR_VIEW["left"] + share * (BRANCHES[0]["left"] - CLEAR_VIEW["left"])
        x, y, z = (camera_from_body @ arm.tip(q)[:, 3])[:3]
        inside = abs(x) <= z * np.tan(FIELD_OF_VIEW[0] / 2) and abs(y) <= z * np.tan(FIELD_OF_VIEW[1] / 2)
        fingers = [part for part in parts_in_view({"left": q}) if "finger" in part]
        if inside:
            assert fingers, share
            seen += 1
        elif not fingers:
            hidden += 1
    assert seen > 10 and hidden > 10


def test_a_camera_that_looks_at_the_parked_arm_sees_it():
    moved = dataclasses.replace(CELL, camera_position=(CELL.camera_position[0], 0.35, 0.9))
    assert any(part.startswith("left") for part in parts_in_view(CLEAR_VIEW, moved))
