"""The node ``sim_cell``: a whole cell without hardware. It starts by itself, as hardware does."""

import argparse
import sys
import threading
import time
from collections.abc import Sequence
from functools import partial
from typing import Any

from singulation_node.large_messages import prepare_for_large_messages  # before ROS: keeps memory

# isort: split
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
from rclpy.parameter import Parameter
from singulation_msgs.srv import InjectFault
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory

from singulation_core import ResultCode, SingulationError
from singulation_node.diagnostics import Diagnostics
from singulation_node.guard import guarded, guarded_service, report_failure
from singulation_node.main import plain_arguments, run_node
from singulation_node.parameters import ParameterSet
from singulation_node.qos import COMMAND
from singulation_sim.border import opening_from_msg, trajectory_from_msg
from singulation_sim.camera import warm_up
from singulation_sim.driver import ARMS
from singulation_sim.scenes import SCENES
from singulation_sim.sim_outputs import SimOutputs
from singulation_sim.sim_settings import SimSettings
from singulation_sim.stepper import Stepper

_OWN_START = 1.0  # s; own time begins here, because a stamp of 0 means "none"
_LAST_FRAME = 5.0  # s that an ending node waits for a frame to be published
_PATIENCE = 20.0  # times the scan time that a trigger waits before it gives up


class SimCell(Node):
    """Simulated YuMi driver, table and PhoXi behind the topics of the real ones."""

    def __init__(self, **options: Any) -> None:
        super().__init__("sim_cell", **options)
        self._settings: ParameterSet[SimSettings] = ParameterSet(self, SimSettings)
        self.diagnostics = Diagnostics(self)
        settings = self._settings.current
        warm_up()
        self.cell = settings.new_cell(_OWN_START if settings.own_time else time.time())
        self._scene_key = settings.scene_key
        self._lock = threading.Condition()
        self._camera_lock = threading.Lock()
        self._refused = 0
        self._outputs = SimOutputs(self, settings.own_time, settings.camera_frame)
        self._subscribe()
        self._serve(settings)
        self._stepper = Stepper(
            self.cell,
            self._lock,
            interval=1.0 / settings.state_rate,
            speed=settings.speed,
            own_time=settings.own_time,
            tell=self._tell,
        )
        self._stepper.start()
        self.get_logger().info(
            f"simulated cell: {len(self.cell.arrangement())} blocks ({settings.scene}, seed {settings.seed}), "
            f"{settings.speed:g} x real time"
        )

    def destroy_node(self) -> None:
        """Stop time, let a frame that is on its way go out, then destroy the node."""
        self._stepper.stop()
        gone = self._camera_lock.acquire(timeout=_LAST_FRAME)
        try:
            super().destroy_node()
        finally:
            if gone:
                self._camera_lock.release()

    def _subscribe(self) -> None:
        for arm in ARMS:
            self.create_subscription(
                JointTrajectory, f"{arm}_arm_controller/joint_trajectory", partial(self._on_trajectory, arm), COMMAND
            )
            self.create_subscription(
                Float64MultiArray, f"{arm}_gripper_controller/commands", partial(self._on_gripper, arm), COMMAND
            )

    def _serve(self, settings: SimSettings) -> None:
        # A trigger waits for its scan; nothing else may wait for it.
        camera = MutuallyExclusiveCallbackGroup()
        self.create_service(Trigger, "trigger_frame", self._on_trigger, callback_group=camera)
        self.create_service(InjectFault, "inject_fault", self._on_inject)
        self.create_service(Trigger, "reset", self._on_reset)
        if settings.frame_period > 0.0:
            self.create_timer(settings.frame_period / settings.speed, self._free_run, callback_group=camera)

    @guarded
    def _on_trajectory(self, arm: str, message: Any) -> None:
        trajectory = trajectory_from_msg(message)
        self._order(lambda: self.cell.driver.command_arm(arm, trajectory))

    @guarded
    def _on_gripper(self, arm: str, message: Any) -> None:
        self._order(lambda: self.cell.driver.command_gripper(arm, opening_from_msg(message)))

    def _order(self, order: Any) -> None:
        """Give an order to the driver; a refusal is logged, as a real controller does, and not answered."""
        try:
            with self._lock:
                order()
        except SingulationError as error:
            self._refused += 1
            self.get_logger().warning(str(error), throttle_duration_sec=0.5)

    @guarded_service
    def _on_inject(self, request: Any, response: Any) -> Any:
        with self._lock:
            self.cell.driver.inject(request.fault, float(request.value))
        response.success, response.message = True, f"{request.fault} injected"
        return response

    @guarded_service
    def _on_reset(self, request: Any, response: Any) -> Any:
        with self._lock:
            self.cell.driver.reset()
        response.success, response.message = True, "no faults, motors on, the arms hold their positions"
        return response

    @guarded_service
    def _on_trigger(self, request: Any, response: Any) -> Any:
        points = self._scan()
        response.success, response.message = True, f"published a cloud of {points} measured points"
        return response

    @guarded
    def _free_run(self) -> None:
        if self._camera_lock.locked():
            return
        try:
            self._scan()
        except SingulationError:
            if not self._stepper.stopped:
                raise

    def _scan(self) -> int:
        """Take a frame and publish it when the scan is over; the number of measured points.

        Raises:
            SingulationError: ``TIMEOUT`` if simulated time does not get on, or the node ends.
        """
        settings = self._settings.current
        patience = 5.0 + _PATIENCE * settings.scan_time / settings.speed
        with self._camera_lock:
            with self._lock:
                view = self.cell.view()
                if not self._stepper.wait_for(self.cell.now + settings.scan_time, patience):
                    why = "the node ends" if self._stepper.stopped else f"time stood still for {patience:.0f} s"
                    raise SingulationError(ResultCode.TIMEOUT, f"no frame: {why}")
                now = self.cell.now
            points = self.cell.render(view)
            self._outputs.publish_cloud(points, now)
        return int((points[..., 2] > 0.0).sum())

    def _tell(self, moved: bool) -> None:
        """After each interval, in the thread of the stepper."""
        try:
            self._change_scene()
            with self._lock:
                self._outputs.publish(self.cell, moved)
            self.diagnostics.report(
                "simulation", True, "running", time=self.cell.now, behind=self._stepper.behind, refused=self._refused
            )
        except Exception as error:
            report_failure(self, "publishing", error)

    def _change_scene(self) -> None:
        settings = self._settings.current
        if settings.scene_key != self._scene_key:
            self._scene_key = settings.scene_key
            scene = settings.new_scene()
            with self._lock:
                self.cell.set_scene(scene)
            self.get_logger().info(f"new scene: {len(scene)} blocks ({settings.scene}, seed {settings.seed})")


def _options(arguments: Sequence[str]) -> list[Any]:
    """Parameter values from the command line."""
    parser = argparse.ArgumentParser(prog="sim_cell", description=__doc__)
    parser.add_argument("--speed", type=float, help="simulated seconds per second; other than 1: own time on /clock")
    parser.add_argument("--seed", type=int, help="of scene and noise")
    parser.add_argument("--objects", type=int, help="number of blocks, 0 for a random one from 3 to 7")
    parser.add_argument("--scene", choices=tuple(SCENES), help="kinds of blocks")
    parser.add_argument("--autostart", action="store_true", help="accepted; the cell always starts by itself")
    given = vars(parser.parse_args(list(arguments)))
    given.pop("autostart")
    return [Parameter(name, value=value) for name, value in given.items() if value is not None]


def main(args: Sequence[str] | None = None) -> int:
    """Run the node until it is told to end."""
    overrides = _options(plain_arguments(args))
    prepare_for_large_messages()
    return run_node(lambda: SimCell(parameter_overrides=overrides), args)


if __name__ == "__main__":
    sys.exit(main())
