"""Blocks move where jaws really are."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest

from singulation_core import Arrangement, PlanarObject
from singulation_sim.driver import DriverMode
from singulation_sim.table import FingerGeometry, Fingertip, Table, fingertips

MakeCell = Callable[[Sequence[PlanarObject]], Any]
MakeSquare = Callable[..., PlanarObject]


def test_closed_fingers_touch_and_open_ones_are_apart() -> None:
    tool = np.eye(4)
    tool[:3, :3] = ((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, -1.0))  # closing along y
    tool[:3, 3] = (0.1, 0.2, 0.15)
    closed = fingertips(tool, 0.0, FingerGeometry())
    wide = fingertips(tool, 0.05, FingerGeometry())
    assert closed[0].height == pytest.approx(0.014)
    assert abs(closed[0].pose[1] - closed[1].pose[1]) == pytest.approx(0.0062)
    assert abs(wide[0].pose[1] - wide[1].pose[1]) == pytest.approx(0.0562)
    assert [tip.pose[0] for tip in wide] == pytest.approx([0.1, 0.1])


def test_a_sweep_pushes_a_block(make_cell: MakeCell, make_square: MakeSquare) -> None:
    arms = make_cell([make_square(1, 0.0, 0.0), make_square(2, 0.0, 0.1)])
    arms.stand_at(-0.08, 0.0, 0.01)
    arms.line((-0.08, 0.0, 0.01), (0.03, 0.0, 0.01), seconds=2.0)
    arms.run(3.0)
    pushed, other = arms.cell.arrangement().objects
    # Tip 12 mm wide, block 40 mm: its centre ends 6 + 20 mm ahead of the tip's.
    assert pushed.centroid == pytest.approx([0.056, 0.0], abs=0.002)
    assert other.centroid == pytest.approx([0.0, 0.1])
    assert arms.cell.driver.status.mode is DriverMode.MOTORS_ON


def test_blocks_follow_the_real_arm_not_the_commanded_one(make_cell: MakeCell, make_square: MakeSquare) -> None:
    arms = make_cell([make_square(1, 0.0, 0.0)])
    arms.stand_at(-0.08, 0.0, 0.01)
    arms.cell.driver.inject("slow", 0.01)
    arms.line((-0.08, 0.0, 0.01), (0.03, 0.0, 0.01), seconds=1.0)
    arms.run(1.5)
    tip = arms.cell.tips()["left finger 1"]
    assert tip.pose[0] < -0.05
    assert arms.cell.arrangement().objects[0].centroid == pytest.approx([0.0, 0.0])
    arms.cell.driver.reset()
    arms.line((tip.pose[0], 0.0, 0.01), (0.03, 0.0, 0.01), seconds=2.0)
    arms.run(3.0)
    assert arms.cell.arrangement().objects[0].centroid[0] == pytest.approx(0.056, abs=0.002)


def test_a_lifted_tip_moves_nothing(make_cell: MakeCell, make_square: MakeSquare) -> None:
    arms = make_cell([make_square(1, 0.0, 0.0)])
    arms.stand_at(-0.08, 0.0, 0.035)
    arms.line((-0.08, 0.0, 0.035), (0.08, 0.0, 0.035), seconds=2.0)
    arms.run(3.0)
    assert arms.cell.arrangement().objects[0].centroid == pytest.approx([0.0, 0.0])
    assert arms.cell.driver.status.mode is DriverMode.MOTORS_ON


def test_after_lifting_the_way_back_moves_nothing(make_cell: MakeCell, make_square: MakeSquare) -> None:
    arms = make_cell([make_square(1, 0.0, 0.0)])
    arms.stand_at(-0.08, 0.0, 0.01)
    arms.line((-0.08, 0.0, 0.01), (0.0, 0.0, 0.01), seconds=2.0)
    arms.run(2.5)
    where, where_tip = arms.cell.arrangement().objects[0].centroid, (0.0, 0.0, 0.01)
    for way in ((0.0, 0.1), (0.1, 0.1), (0.1, 0.05)):
        arms.line(where_tip, (way[0], 0.0, way[1]), seconds=1.0)
        arms.run(1.5)
        where_tip = (way[0], 0.0, way[1])
    assert arms.cell.arrangement().objects[0].centroid == pytest.approx(where)


@pytest.mark.parametrize(("opening", "moved"), [(0.05, False), (0.0, True)])
def test_an_open_hand_passes_a_narrow_block(
    make_cell: MakeCell, make_square: MakeSquare, opening: float, moved: bool
) -> None:
    arms = make_cell([make_square(1, 0.0, 0.0, side=0.03)])
    arms.cell.driver.command_gripper("left", opening)
    arms.run(1.5)
    arms.stand_at(-0.08, 0.0, 0.01)
    arms.line((-0.08, 0.0, 0.01), (0.02, 0.0, 0.01), seconds=2.0)
    arms.run(3.0)
    assert bool(arms.cell.arrangement().objects[0].centroid[0] > 0.01) is moved


def test_an_open_hand_pushes_a_wide_block_without_turning_it(make_cell: MakeCell, make_square: MakeSquare) -> None:
    arms = make_cell([make_square(1, 0.0, 0.006, side=0.06)])
    arms.cell.driver.command_gripper("left", 0.04)
    arms.run(1.5)
    arms.stand_at(-0.08, 0.0, 0.01)
    arms.line((-0.08, 0.0, 0.01), (0.03, 0.0, 0.01), seconds=2.0)
    arms.run(3.0)
    block = arms.cell.arrangement().objects[0]
    assert block.centroid == pytest.approx([0.066, 0.006], abs=0.002)
    assert np.ptp(block.outline[:, 0]) == pytest.approx(0.06, abs=1e-3)


def test_a_hand_that_closes_on_a_block_stops_there(make_cell: MakeCell, make_square: MakeSquare) -> None:
    arms = make_cell([make_square(1, 0.0, 0.0, side=0.03)])
    arms.cell.driver.command_gripper("left", 0.05)
    arms.run(1.5)
    arms.line((-0.08, 0.0, 0.1), (0.0, 0.0, 0.1), seconds=1.0)
    arms.run(1.5)
    arms.line((0.0, 0.0, 0.1), (0.0, 0.0, 0.01), seconds=1.0)
    arms.run(1.5)
    arms.cell.driver.command_gripper("left", 0.0)
    arms.run(2.0)
    assert arms.cell.driver.arms["left"].gripper.opening == pytest.approx(0.03, abs=2e-3)
    arms.cell.driver.command_gripper("left", 0.05)
    arms.run(1.0)
    assert arms.cell.driver.arms["left"].gripper.opening == pytest.approx(0.05)


def test_coming_down_on_a_block_is_a_collision(make_cell: MakeCell, make_square: MakeSquare) -> None:
    arms = make_cell([make_square(1, 0.0, 0.0)])
    arms.stand_at(0.0, 0.0, 0.06)
    arms.line((0.0, 0.0, 0.06), (0.0, 0.0, 0.01), seconds=1.0)
    arms.run(0.8)
    assert arms.cell.driver.status.mode is DriverMode.COLLISION_STOP
    assert "block(s) [1]" in arms.cell.driver.status.message
    arms.run(2.0)
    assert arms.cell.tips()["left finger 1"].height > 0.03
    assert arms.cell.arrangement().objects[0].centroid == pytest.approx([0.0, 0.0])
    assert arms.cell.driver.status.motion_enabled
    arms.line((0.0, 0.0, 0.035), (0.0, 0.0, 0.1), seconds=1.0)
    arms.run(1.5)
    assert arms.cell.tips()["left finger 1"].height == pytest.approx(0.1, abs=1e-3)


def test_running_into_the_table_is_a_collision(make_cell: MakeCell, make_square: MakeSquare) -> None:
    arms = make_cell([make_square(1, 0.1, 0.1)])
    arms.stand_at(0.0, 0.0, 0.03)
    arms.line((0.0, 0.0, 0.03), (0.0, 0.0, -0.02), seconds=1.0)
    arms.run(0.9)
    assert arms.cell.driver.status.mode is DriverMode.COLLISION_STOP
    assert "table" in arms.cell.driver.status.message
    arms.run(2.0)
    assert arms.cell.tips()["left finger 1"].height > -0.002
    arms.stand_at(0.0, 0.0, 0.05)
    assert arms.cell.driver.status.mode is DriverMode.MOTORS_ON


def test_a_contact_is_reported_once_until_it_gets_deeper(make_square: MakeSquare) -> None:
    table = Table(Arrangement([make_square(1, 0.0, 0.0)]))

    def at(height: float) -> int:
        return len(table.move({"tip": Fingertip((0.0, 0.0, 0.0), height)}))

    assert [at(height) for height in (0.05, 0.029, 0.0289, 0.029, 0.027, 0.05, 0.029)] == [0, 1, 0, 0, 1, 0, 1]


def test_a_tip_between_two_heights_hovers_over_the_lower_block(make_square: MakeSquare) -> None:
    table = Table(Arrangement([make_square(1, 0.0, 0.0, height=0.02), make_square(2, 0.1, 0.0, height=0.04)]))
    over_low = Fingertip((0.0, 0.0, 0.0), 0.03)
    assert not table.move({"tip": over_low})
    assert table.move({"tip": Fingertip((0.1, 0.0, 0.0), 0.03)})
    assert table.arrangement(1.0).objects[0].centroid == pytest.approx([0.0, 0.0])


def test_an_empty_table_is_a_table() -> None:
    table = Table(Arrangement([]))
    assert not table.move({"tip": Fingertip((0.0, 0.0, 0.0), 0.01)})
    assert table.move({"tip": Fingertip((0.0, 0.0, 0.0), -0.01)})
    assert len(table.arrangement(2.0)) == 0
