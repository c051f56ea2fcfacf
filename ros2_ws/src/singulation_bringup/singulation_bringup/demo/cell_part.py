"""Part two: the closed loop in the simulated cell, look -> plan -> push -> look again."""

import queue
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState, PointCloud2
from singulation_msgs.action import Singulate
from singulation_msgs.msg import Arrangement as ArrangementMsg
from singulation_msgs.msg import DriverState, PushOutcome, PushTrajectory
from std_msgs.msg import Float64MultiArray
from trajectory_msgs.msg import JointTrajectory

from singulation_bringup.demo.film import Film
from singulation_bringup.demo.observer import Observer
from singulation_bringup.demo.options import DemoOptions
from singulation_bringup.demo.processes import NodeProcesses
from singulation_bringup.demo.summary import Summary, object_entry, push_entry
from singulation_bringup.demo.terminal import say
from singulation_bringup.drawing import picture_of_progress, picture_of_push
from singulation_core import CellGeometry, ResultCode, SingulationError, conversions, smallest_gap
from singulation_node.qos import RECORD
from singulation_perception.bag_writing import BagRecorder

_START = 600.0  # s; without the set-up's compiling, the first start on a machine compiles all of it
_LATE = 60.0  # s; a busy machine hands messages on late
_PER_PUSH = 90.0  # s of wall time, far more than any push takes
_RECORDED: tuple[tuple[str, Any], ...] = (
    ("points", PointCloud2),
    ("objects", ArrangementMsg),
    ("true_objects", ArrangementMsg),
    ("push", PushTrajectory),
    ("joint_states", JointState),
    ("driver_state", DriverState),
    ("left_arm_controller/joint_trajectory", JointTrajectory),
    ("right_arm_controller/joint_trajectory", JointTrajectory),
    ("left_gripper_controller/commands", Float64MultiArray),
    ("right_gripper_controller/commands", Float64MultiArray),
    ("/clock", Clock),
)
_NODES = (
    ("singulation_perception", "perception_node"),
    ("singulation_planner", "planner_node"),
    ("yumi_push_executor", "executor_node"),
    ("singulation_bringup", "singulate_node"),
)


class CellPart:
    """One run of the closed loop, recorded and drawn.

    Args:
        options: of the demo.
        summary: receives pushes, s(A) and gaps.
    """

    def __init__(self, options: DemoOptions, summary: Summary) -> None:
        self._options, self._summary = options, summary
        self._outcomes: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._film = Film(CellGeometry())
        self._now = 0  # ns of simulated time
        self._recording = True
        self._pictures: dict[Path, Callable[[], None]] = {}  # of pushes, drawn when the robot has gone

    def run(self, processes: NodeProcesses, observer: Observer) -> None:
        """Until separated, out of pushes, or stopped.

        Raises:
            SingulationError: a node that ended, no answer in time, or the code with which the loop failed.
        """
        with BagRecorder(self._options.out / "run") as recorder:
            self._summary.files.append("run")
            self._listen(observer, recorder)
            try:
                with self._summary.timed("cell start"):
                    self._start(processes, observer)
                with self._summary.timed("cell loop"):
                    result = self._singulate(observer)
            finally:
                self._recording = False
                # Beside a robot that tells its state 250 times a second, drawing took ten times as long.
                with self._summary.timed("stop"):
                    processes.stop()
                with self._summary.timed("pictures"):
                    self._finish()
        self._conclude(result)

    def _listen(self, observer: Observer, recorder: BagRecorder) -> None:
        for topic, kind in _RECORDED:
            name = topic if topic.startswith("/") else f"/{topic}"

            def record(message: Any, name: str = name) -> None:
                self._record(recorder, name, message)

            (observer.hear_cloud if kind is PointCloud2 else observer.hear)(kind, topic, record)

        def record_outcome(message: Any) -> None:
            self._record(recorder, "/outcomes", message)
            self._outcomes.put(message)

        observer.hear(PushOutcome, "outcomes", record_outcome, RECORD)
        observer.hear(Clock, "/clock", self._on_clock)
        observer.hear(ArrangementMsg, "true_objects", self._film.see_table)
        observer.hear(JointState, "joint_states", self._film.see_arms)

    def _record(self, recorder: BagRecorder, topic: str, message: Any) -> None:
        if self._recording:
            recorder.write(topic, message, self._now)

    def _on_clock(self, message: Any) -> None:
        self._now = message.clock.sec * 10**9 + message.clock.nanosec

    def _start(self, processes: NodeProcesses, observer: Observer) -> None:
        options = self._options
        say(f"simulated cell: {options.objects} blocks, seed {options.seed}, {options.speed:g} times real time")
        blocks = ["--objects", str(options.objects)] if options.objects else ["--scene", "empty"]
        scene = ["--seed", str(options.seed), "--speed", str(options.speed), *blocks]
        clock = ["--ros-args", "-p", "publish_clock:=true"]  # every node lives in simulated time, at any speed
        processes.start("singulation_sim", "sim_cell", [*scene, *clock])
        for package, executable in _NODES:
            settings = ["-p", "use_sim_time:=true"]
            if executable == "planner_node":
                # Faster than real time, the same computing takes more of the simulated seconds.
                settings += ["-p", f"max_age:={5.0 + 15.0 * options.speed}", "-p", "plan_on_arrival:=false"]
            processes.start(package, executable, ["--autostart", "--ros-args", *settings])
        for _, name in _NODES:
            say(f"  waiting for {name}")
            observer.wait(partial(_is_active, observer, name), _START, name)

    def _singulate(self, observer: Observer) -> Any:
        options = self._options
        self._summary.min_gap = options.min_gap
        goal = Singulate.Goal(
            max_pushes=options.max_pushes,
            min_gap=options.min_gap,
            policy=options.policy,
            contact_mode=conversions.contact_mode_to_msg(options.contact_mode),
        )
        result = observer.action(Singulate, "singulate", goal, _START)
        say("look -> plan -> push -> look again")
        limit = _START + _PER_PUSH * (options.max_pushes + 1)
        observer.wait(lambda: self._show_outcomes() or result() is not None, limit, "singulate")
        answer = result()
        observer.wait(
            lambda: self._show_outcomes() or len(self._summary.pushes) >= len(answer.outcomes),
            _LATE,
            "the last outcome",
        )
        self._note_stages(
            observer.wait(lambda: observer.status("singulate_node: stages"), _LATE, "times of the stages")
        )
        return answer

    def _note_stages(self, status: dict[str, str]) -> None:
        for stage in ("look", "plan", "push"):
            entry = {"count": int(status[f"{stage} count"]), "seconds": float(status[f"{stage} [s]"])}
            self._summary.stages[stage] = entry

    def _show_outcomes(self) -> bool:
        """Note what has come; never true, so that waiting goes on."""
        while not self._outcomes.empty():
            self._note(self._outcomes.get())
        return False

    def _note(self, message: Any) -> None:
        summary, number = self._summary, len(self._summary.pushes) + 1
        before, after = (
            conversions.arrangement_from_msg(message.before),
            conversions.arrangement_from_msg(message.after),
        )
        push, code = conversions.push_from_msg(message.push), ResultCode(message.code)
        distances = (message.singulation_distance_before, message.singulation_distance_after)
        gaps = (smallest_gap(before), smallest_gap(after))
        if number == 1:
            self._film.name_blocks(before)
            summary.singulation_distance.append(distances[0])
            summary.smallest_gap.append(gaps[0])
        summary.singulation_distance.append(distances[1])
        summary.smallest_gap.append(gaps[1])
        outcome = {"code": int(code), "code_name": code.name, "message": message.message}
        arrangements = {"before": object_entry(before), "after": object_entry(after)}
        summary.pushes.append({**push_entry(push), **outcome, **arrangements})
        say(
            f"  push {number}: object {push.target_id}, {code.name}; s(A) {distances[0]:.3f} -> {distances[1]:.3f}, "
            f"smallest gap {1e3 * gaps[1]:.1f} mm"
        )
        picture = self._options.out / f"push_{number:02d}.png"
        heading = f"push {number}: {code.name}" + (f", {message.message}" if message.message else "")
        workspace = CellGeometry().workspace
        self._pictures[picture] = partial(
            picture_of_push, picture, before, push, after, distances, gaps, heading, workspace
        )

    def _finish(self) -> None:
        out, summary = self._options.out, self._summary
        for picture, draw in self._pictures.items():
            draw()
            summary.files.append(picture.name)
        if summary.singulation_distance:
            picture_of_progress(
                out / "progress.png", summary.singulation_distance, summary.smallest_gap, self._options.min_gap
            )
            summary.files.append("progress.png")
        if self._film.save(out / "run.gif"):
            summary.files.append("run.gif")

    def _conclude(self, result: Any) -> None:
        code, summary = ResultCode(result.code), self._summary
        if not summary.pushes and len(result.singulation_distance) > 0:
            summary.singulation_distance += list(result.singulation_distance)
            summary.smallest_gap.append(result.smallest_gap)
        summary.loop_code, summary.loop_message = code, result.message
        say(f"{code.name}: {result.message}")
        # Out of pushes is one of the two ways this part is meant to end.
        if code not in (ResultCode.OK, ResultCode.MAX_PUSHES_REACHED):
            raise SingulationError(code, result.message)


def _is_active(observer: Observer, node: str) -> bool:
    return observer.status(f"{node}: state").get("message") == "active"
