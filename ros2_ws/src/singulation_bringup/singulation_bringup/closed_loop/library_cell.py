"""The cell of ``singulation_loop`` made of the real parts, without ROS and without a clock on the wall."""

from collections.abc import Callable

from singulation_bringup.closed_loop.setting import CellSetting
from singulation_bringup.closed_loop.stopwatch import Stopwatch
from singulation_bringup.closed_loop.supervised_robot import SupervisedRobot
from singulation_bringup.policy_choice import options_towards
from singulation_bringup.singulation_loop import LOOK_AGAIN
from singulation_core import Arrangement, ContactMode, Push, ResultCode, SingulationError
from singulation_perception import TablePlane, segment_cloud
from singulation_planner import plan_push
from singulation_sim.cell import SimulatedCell
from yumi_push_executor import plan_motion


class LibraryCell:
    """Camera cloud -> ``segment_cloud`` -> ``plan_push`` -> ``plan_motion`` -> supervised motion -> moved blocks.

    Args:
        simulation: what stands for hardware.
        setting: of every part.
        seed: of policies that draw at random.
        cancelled: whether the client has given up; asked between the steps and all through a motion.
        on_cycle: called at every joint state with the simulation.
    """

    def __init__(
        self,
        simulation: SimulatedCell,
        setting: CellSetting,
        seed: int = 0,
        cancelled: Callable[[], bool] = lambda: False,
        on_cycle: Callable[[SimulatedCell], None] = lambda _: None,
    ) -> None:
        self.simulation, self.stopwatch = simulation, Stopwatch()
        self._setting, self._seed, self._cancelled = setting, seed, cancelled
        self.robot = SupervisedRobot(
            simulation, setting.geometry, setting.limits, setting.motion, self.stopwatch, cancelled, on_cycle
        )
        self._segmentation = setting.segmentation
        self._table: TablePlane | None = None
        self._seen = Arrangement(())
        self.looks = 0
        self.asked = 0  # pushes handed to ``execute``
        self.refused = 0  # of them, those for which no motion was found

    def truth(self) -> Arrangement:
        """Where the blocks really are."""
        return self.simulation.arrangement()

    def look(self) -> Arrangement:
        """Segments of a new cloud.

        Raises:
            SingulationError: with perception's code.
        """
        with self.stopwatch.timed("render"):
            view = self.simulation.view()
            self.simulation.run(self._setting.scan_time)
            cloud = self.simulation.render(view)
        with self.stopwatch.timed("segment"):
            found = segment_cloud(cloud, self._segmentation, self._table)
        self._table = found.table
        self.looks += 1
        self._seen = Arrangement(found.arrangement.objects, stamp=self.simulation.now)
        return self._seen

    def plan(self, seen: Arrangement, policy: str, mode: ContactMode, min_gap: float) -> Push:
        """The policy's push.

        Raises:
            SingulationError: with the planner's code.
        """
        setting = self._setting
        with self.stopwatch.timed("plan"):
            return plan_push(
                seen,
                policy,
                mode,
                push_distance_factor=setting.push_distance_factor,
                pusher=setting.pusher,
                placement=setting.placement,
                workspace=setting.geometry.workspace_polygon,
                seed=self._seed,
                **options_towards(policy, min_gap),
            )

    def execute(self, push: Push) -> None:
        """Plan the motion and run it under supervision.

        Raises:
            SingulationError: with the executor's code. After a stop that another look may get over, the arms are out
                of the camera's view again.
        """
        setting = self._setting
        self.asked += 1
        with self.stopwatch.timed("motion"):
            try:
                motion = plan_motion(
                    push,
                    self._seen,
                    cell=setting.geometry,
                    joints=self.robot.postures,
                    pusher=setting.pusher,
                    parameters=setting.motion,
                )
            except SingulationError:
                self.refused += 1
                raise
        with self.stopwatch.timed("moving"):
            try:
                self.robot.perform(motion.segments)
            except SingulationError as stop:
                if stop.code in LOOK_AGAIN:
                    self.robot.leave_view(self._seen)
                raise

    def check_cancelled(self) -> None:
        """Raise ``CANCELLED`` if the client has given up."""
        if self._cancelled():
            raise SingulationError(ResultCode.CANCELLED, "cancelled by the client")
