"""Helpers shared by the tests of the simulated cell."""

from collections.abc import Callable, Sequence

import numpy as np
import pytest
from numpy.typing import NDArray

from singulation_core import Arrangement, CellGeometry, PlanarObject
from singulation_sim.cell import SimulatedCell
from singulation_sim.driver import DriverSettings, JointTrajectory, SimulatedDriver
from singulation_sim.driver.trajectory import point
from yumi_push_executor.kinematics import TIP_OFFSET, YumiArm
from yumi_push_executor.kinematics.postures import BRANCHES


def square(object_id: int, x: float, y: float, side: float = 0.04, height: float = 0.03) -> PlanarObject:
    """Axis-parallel square block."""
    half = side / 2.0
    corners = [(x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half)]
    return PlanarObject(object_id, np.array(corners), height)


class ArmDriver:
    """Drives the left arm's tip through points of the table frame, tool vertical, jaws closing along table y."""

    def __init__(self, cell: SimulatedCell) -> None:
        self.cell = cell
        self.model = YumiArm("left")
        self._seed = BRANCHES[0]["left"]

    def pose(self, x: float, y: float, z: float) -> NDArray[np.float64]:
        """4x4 of ``tool0`` in ``yumi_body``."""
        tool = np.eye(4)
        tool[:3, :3] = ((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, -1.0))
        tool[:3, 3] = (x, y, z + TIP_OFFSET)
        return CellGeometry().body_from_table @ tool

    def go(self, *points: tuple[float, float, float], seconds: float = 1.0) -> None:
        """One trajectory through the points, ``seconds`` from one to the next; returns without waiting."""
        knots = []
        for number, where in enumerate(points, 1):
            self._seed = self.model.inverse(self.pose(*where), self._seed)
            knots.append(point(number * seconds, self._seed))
        names = self.cell.driver.settings.joints["left"]
        self.cell.driver.command_arm("left", JointTrajectory(names, knots))

    def line(self, start: tuple[float, float, float], end: tuple[float, float, float], seconds: float) -> None:
        """A straight line of 20 pieces, from a place the tip is already near to."""
        ways = np.linspace(0.0, 1.0, 21)[1:, None]
        points = np.array(start) + ways * (np.array(end) - np.array(start))
        self.go(*map(tuple, points.tolist()), seconds=seconds / 20)

    def run(self, seconds: float) -> None:
        """Let simulated time pass."""
        self.cell.run(seconds)

    def stand_at(self, x: float, y: float, z: float) -> None:
        """Bring the tip there and wait."""
        self.go((x, y, z), seconds=2.5)
        self.run(3.0)


@pytest.fixture
def make_square() -> Callable[..., PlanarObject]:
    """The function ``square``."""
    return square


@pytest.fixture
def make_cell() -> Callable[[Sequence[PlanarObject]], ArmDriver]:
    """A cell with these blocks, its left tip high over the table, and what drives it."""

    def make(blocks: Sequence[PlanarObject]) -> ArmDriver:
        arms = ArmDriver(SimulatedCell(Arrangement(blocks)))
        arms.stand_at(-0.08, 0.0, 0.1)
        return arms

    return make


@pytest.fixture
def exact_driver() -> SimulatedDriver:
    """A driver without lag and noise, at time 10 s."""
    return SimulatedDriver(DriverSettings(lag=0.0, position_noise=0.0, velocity_noise=0.0), start=10.0)
