"""An arm that sweeps over the table."""

import numpy as np

from singulation_core import CellGeometry
from singulation_core.polygon import FloatArray
from singulation_sim.cell import SimulatedCell
from singulation_sim.driver import JointTrajectory
from singulation_sim.driver.trajectory import point
from yumi_push_executor.kinematics import TIP_OFFSET, YumiArm
from yumi_push_executor.kinematics.postures import BRANCHES

_ABOVE = 0.1  # m; of the tips while they go back to the start
_START, _END = (-0.145, 0.0), (0.1, 0.0)  # m, in ``table``


class Sweeper:
    """Moves the left arm's closed jaws across the middle of the table.

    Args:
        cell: to move in.
    """

    def __init__(self, cell: SimulatedCell) -> None:
        self.cell = cell
        self._arm = YumiArm("left")
        self._q = np.array(BRANCHES[0]["left"])

    def approach(self, height: float) -> None:
        """Bring the tips beside the blocks, to a height above the table [m]."""
        self.cell.driver.reset()
        for x, y, z, seconds in ((*_END, _ABOVE, 1.0), (*_START, _ABOVE, 1.0), (*_START, height, 1.0)):
            self._send([(x, y, z)], seconds)
            self.cell.run(seconds + 0.2)

    def start(self, height: float) -> None:
        """Begin to cross the table within a second."""
        ways = np.linspace(0.0, 1.0, 21)[1:, None]
        line = np.array(_START) + ways * (np.array(_END) - np.array(_START))
        self._send([(x, y, height) for x, y in line.tolist()], 1.0)

    def _send(self, tips: list[tuple[float, float, float]], seconds: float) -> None:
        knots = []
        for number, tip in enumerate(tips, 1):
            self._q = self._arm.inverse(_pose(*tip), self._q)
            knots.append(point(seconds * number / len(tips), self._q))
        names = self.cell.driver.settings.joints["left"]
        self.cell.driver.command_arm("left", JointTrajectory(names, knots))


def _pose(x: float, y: float, z: float) -> FloatArray:
    """4x4 of ``tool0`` in ``yumi_body``: jaws down, closing along table y."""
    tool = np.eye(4)
    tool[:3, :3] = ((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, -1.0))
    tool[:3, 3] = (x, y, z + TIP_OFFSET)
    return np.asarray(CellGeometry().body_from_table @ tool)
