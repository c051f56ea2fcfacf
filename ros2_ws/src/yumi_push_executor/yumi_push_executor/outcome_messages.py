"""Endings and steps as messages."""

import math
from typing import Any

from singulation_msgs.action import ExecutePush
from singulation_msgs.msg import PushOutcome
from std_msgs.msg import Header

from singulation_core import singulation_distance
from singulation_core.conversions import arrangement_to_msg, point_to_msg
from yumi_push_executor.ending import Ending
from yumi_push_executor.supervision import Step


def result_of(ending: Ending) -> Any:
    """Result of the action ``execute_push``."""
    return ExecutePush.Result(code=int(ending.code), message=ending.text, reached=point_to_msg(ending.reached))


def feedback_of(step: Step) -> Any:
    """Feedback of the action ``execute_push``."""
    return ExecutePush.Feedback(phase=int(step.phase), fraction=float(step.fraction))


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
