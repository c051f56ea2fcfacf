"""Endings and steps of a push as messages."""

import math
import time
from typing import Any

from singulation_msgs.action import ExecutePush
from singulation_msgs.msg import PushOutcome
from std_msgs.msg import Header

from singulation_core import singulation_distance
from singulation_core.conversions import arrangement_to_msg, point_to_msg
from singulation_node.guard import report_failure
from yumi_push_executor.ending import Ending
from yumi_push_executor.supervision import Step

_PERIOD = 0.05  # s between two feedbacks of one phase


def result_of(ending: Ending) -> Any:
    """Result of the action ``execute_push``."""
    return ExecutePush.Result(code=int(ending.code), message=ending.text, reached=point_to_msg(ending.reached))


class Feedback:
    """Feedback of one goal of ``execute_push``: every new phase, and how far it is twenty times a second.

    Args:
        node: that serves the goal.
        goal: its handle.
    """

    def __init__(self, node: Any, goal: Any) -> None:
        self._node, self._goal = node, goal
        self._phase: int | None = None
        self._told = -math.inf

    def tell(self, step: Step) -> None:
        """Take a step. A feedback that cannot be sent must not stop a motion."""
        now = time.monotonic()
        if step.phase == self._phase and now - self._told < _PERIOD:
            return
        self._phase, self._told = step.phase, now
        try:
            self._goal.publish_feedback(ExecutePush.Feedback(phase=int(step.phase), fraction=float(step.fraction)))
        except Exception as error:
            report_failure(self._node, "feedback", error)


def outcome_of(ending: Ending, push: Any, stamp: Any) -> Any:
    """singulation_msgs/PushOutcome of a push (PushTrajectory); what comes after it the executor does not see."""
    message = PushOutcome(
        header=Header(stamp=stamp, frame_id=push.header.frame_id),
        push=push,
        code=int(ending.code),
        message=ending.text,
        singulation_distance_before=math.nan,
        singulation_distance_after=math.nan,
    )
    if ending.before is not None:
        message.before = arrangement_to_msg(ending.before)
        message.singulation_distance_before = singulation_distance(ending.before)
    return message
