"""Part one: recorded clouds, one after the other, through perception and planner."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from sensor_msgs.msg import PointCloud2
from singulation_msgs.msg import Arrangement as ArrangementMsg
from singulation_msgs.srv import PlanPush
from std_srvs.srv import Trigger

from singulation_bringup.demo.label_view import label_view
from singulation_bringup.demo.observer import Observer
from singulation_bringup.demo.options import DemoOptions
from singulation_bringup.demo.processes import NodeProcesses
from singulation_bringup.demo.summary import Summary, object_entry, push_entry
from singulation_bringup.demo.terminal import say
from singulation_bringup.drawing import picture_of_frame
from singulation_core import Arrangement, Push, ResultCode, SingulationError, conversions
from singulation_perception.playback import Recording

_START = 600.0  # s; without the set-up's compiling, the first start on a machine compiles the segmentation
_FRAME = 60.0  # s for one cloud
# Of a foreign recording neither the camera pose nor the size of the blocks is known.
_PLANE_FIT = ("camera_pose_source:=plane_fit", "crop_to_workspace:=false", "max_height:=1.0")
_WIDE_TABLE = "workspace:=[-5.0, 5.0, -5.0, 5.0]"


class ReplayPart:
    """Steps ``replay_clouds`` cloud by cloud and notes what became of each.

    Args:
        options: of the demo.
        paths: a bag, or cloud files.
        own: whether it is the project's own recording, whose camera stands where the cell's does; of any other camera
            the pose is not known, and the table is what the plane fit finds.
        summary: receives one frame entry for each cloud.
    """

    def __init__(self, options: DemoOptions, paths: list[Path], own: bool, summary: Summary) -> None:
        self._options, self._paths, self._own, self._summary = options, paths, own, summary
        self._objects: list[Any] = []
        self._labels: list[Any] = []

    def run(self, recording: Recording, processes: NodeProcesses, observer: Observer) -> None:
        """All clouds of the recording.

        Raises:
            SingulationError: a damaged recording, a node that ended, or no answer in time.
        """
        observer.hear(ArrangementMsg, "objects", self._objects.append)
        observer.hear(PointCloud2, "perception/labels", self._labels.append)
        with self._summary.timed("replay start"):
            self._start(processes, observer)
        say(f"recorded clouds: {recording.name} ({recording.count})")
        for number, cloud in enumerate(recording.open(), start=1):
            source = cloud.source or recording.name
            with self._summary.timed("replay segment and plan"):
                self._frame(number, source, observer)

    def _start(self, processes: NodeProcesses, observer: Observer) -> None:
        perception = [] if self._own else _PLANE_FIT
        planner = ["plan_on_arrival:=false", "max_age:=600.0", *([] if self._own else [_WIDE_TABLE])]
        processes.start("singulation_perception", "perception_node", ["--autostart", *_parameters(perception)])
        processes.start("singulation_planner", "planner_node", ["--autostart", *_parameters(planner)])
        topic = ["--topic", self._options.topic] if self._options.topic else []
        replay = [*map(str, self._paths), "--step", "--stamps", "now", "--wait", str(_START), *topic]
        processes.start("singulation_perception", "replay_clouds", replay)
        say("starting perception and planner")
        observer.wait(
            lambda: observer.status("perception_node: state").get("message") == "active", _START, "perception_node"
        )
        observer.wait(lambda: observer.status("planner_node: state").get("message") == "active", _START, "planner_node")
        observer.wait(lambda: observer.node.count_publishers("objects") > 0, _START, "objects")

    def _frame(self, number: int, source: str, observer: Observer) -> None:
        finished = _finished(observer)
        known = len(self._objects)
        observer.call(Trigger, "replay_clouds/step", Trigger.Request(), ready=_FRAME, answer=_FRAME)
        observer.wait(lambda: len(self._objects) > known or _finished(observer) > finished, _FRAME, f"cloud {number}")
        if len(self._objects) == known:
            code, text = _rejection(observer)
            self._note(number, source, Arrangement([]), None, code, text)
            return
        message = self._objects[-1]
        push, code, text = _plan(observer, message, self._options)
        arrangement = conversions.arrangement_from_msg(message)
        self._note(number, source, arrangement, push, code, text)
        observer.wait(lambda: self._labels, _FRAME, "perception/labels")
        picture = self._options.out / f"cloud_{number:02d}.png"
        heading = f"{Path(source).name}: {len(arrangement)} objects" + ("" if push else f", {text}")
        picture_of_frame(picture, label_view(self._labels[-1]), arrangement, push, heading)
        self._summary.files.append(picture.name)
        del self._objects[:], self._labels[:]

    def _note(
        self, number: int, source: str, seen: Arrangement, push: Push | None, code: ResultCode, text: str
    ) -> None:
        self._summary.frames.append(
            {
                "source": source,
                "code": int(code),
                "code_name": code.name,
                "message": text,
                "objects": object_entry(seen),
                "push": None if push is None else push_entry(push),
            }
        )
        plan = text if push is None else f"push object {push.target_id} by {100 * push.length:.1f} cm"
        say(f"  cloud {number}: {len(seen)} objects; {plan}")


def _plan(observer: Observer, message: Any, options: DemoOptions) -> tuple[Push | None, ResultCode, str]:
    request = PlanPush.Request(
        arrangement=message, policy=options.policy, contact_mode=conversions.contact_mode_to_msg(options.contact_mode)
    )
    answer = observer.call(PlanPush, "plan_push", request, ready=_FRAME, answer=_FRAME)
    code = ResultCode(answer.code)
    if code is ResultCode.UNKNOWN_POLICY:  # no cloud will change that
        raise SingulationError(code, answer.message)
    return (conversions.push_from_msg(answer.push) if code is ResultCode.OK else None), code, answer.message


def _finished(observer: Observer) -> int:
    """Clouds that perception is through with, by its diagnostics."""
    status = observer.status("perception_node: clouds")
    return sum(int(value) for key, value in status.items() if key == "superseded" or key.startswith("rejected "))


def _rejection(observer: Observer) -> tuple[ResultCode, str]:
    text = observer.status("perception_node: clouds")["message"]
    names = [code for code in ResultCode if f" {code.name} (" in text]
    return (names[0] if names else ResultCode.INTERNAL), text


def _parameters(assignments: Sequence[str]) -> list[str]:
    """``--ros-args -p name:=value`` for each."""
    pairs = [part for assignment in assignments for part in ("-p", assignment)]
    return ["--ros-args", *pairs] if pairs else []
