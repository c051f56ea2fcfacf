"""The simulated cell without ROS: driver, table and camera that share one time."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from singulation_core import Arrangement, CellGeometry
from singulation_core.polygon import FloatArray
from singulation_core.push_world import PushPhysics
from singulation_core.transforms import inverse
from singulation_sim.camera import PhoxiCamera, RobotShape
from singulation_sim.driver import PERIOD, SimulatedDriver
from singulation_sim.table import Fingertip, Table, fingertips
from yumi_push_executor.kinematics import YumiArm


@dataclass(frozen=True, eq=False)
class View:
    """What stands before the camera at one moment: blocks, and the robot by joint angles [rad] and openings [m]."""

    arrangement: Arrangement
    joints: Mapping[str, FloatArray]
    openings: Mapping[str, float]


class SimulatedCell:
    """Driver, table and camera.

    Args:
        arrangement: blocks on the table.
        geometry: where table and camera are.
        driver: of both arms.
        camera: above the table.
        physics: of pushing.
    """

    def __init__(
        self,
        arrangement: Arrangement,
        geometry: CellGeometry | None = None,
        driver: SimulatedDriver | None = None,
        camera: PhoxiCamera | None = None,
        physics: PushPhysics | None = None,
    ) -> None:
        geometry = geometry or CellGeometry()
        self.driver = driver or SimulatedDriver()
        self.camera = camera or PhoxiCamera(geometry)
        self._physics = physics
        self._table_from_body = inverse(geometry.body_from_table)
        self._kinematics = {name: YumiArm(name) for name in self.driver.arms}
        self._robot = RobotShape()
        self._moved = True
        self.set_scene(arrangement)

    @property
    def now(self) -> float:
        """Time of the last cycle [s]."""
        return self.driver.now

    def set_scene(self, arrangement: Arrangement) -> None:
        """Clear the table and put these blocks down."""
        self.table = Table(arrangement, self._physics)
        self._moved = True

    def step(self) -> bool:
        """One cycle of the driver, then of the table; whether anything moved."""
        moves = self.driver.is_moving
        self.driver.step()
        if moves or self._moved:
            for contact in self.table.move(self.tips(), settle=not moves):
                self.driver.collide(contact.text)
            self._stall_hands()
        self._moved = moves
        return moves

    def run(self, seconds: float) -> None:
        """Let simulated time pass."""
        for _ in range(round(seconds / PERIOD)):
            self.step()

    def arrangement(self) -> Arrangement:
        """Where the blocks really are, stamped now."""
        return self.table.arrangement(self.now)

    def tips(self) -> dict[str, Fingertip]:
        """Where the four fingertips really are, by names such as ``left finger 1``."""
        tips = {}
        for name, arm in self.driver.arms.items():
            tool = self._table_from_body @ self._kinematics[name].forward(arm.positions)
            pair = fingertips(tool, arm.gripper.opening, self.table.finger)
            tips.update({f"{name} finger {number}": tip for number, tip in enumerate(pair, 1)})
        return tips

    def view(self) -> View:
        """What the camera would see now; cheap, to be rendered later."""
        arms = self.driver.arms
        return View(
            self.arrangement(),
            {name: np.array(arm.positions) for name, arm in arms.items()},
            {name: arm.gripper.opening for name, arm in arms.items()},
        )

    def render(self, view: View) -> NDArray[np.float32]:
        """(H, W, 3) cloud of a view in the camera frame [m]. One call at a time."""
        robot = self._robot.solids(view.joints, view.openings)
        return self.camera.capture(view.arrangement, [solid.moved(self._table_from_body) for solid in robot])

    def _stall_hands(self) -> None:
        """A hand that closes on a block between its fingers stops there."""
        for name, arm in self.driver.arms.items():
            if arm.gripper.finger_velocity < 0.0 and any(
                self.table.squeezed(f"{name} finger {number}") for number in (1, 2)
            ):
                arm.gripper.stop()
