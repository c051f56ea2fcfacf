"""Every fault of the simulated driver in the middle of a push: code, reaction, standstill, and the push after it."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from benchmarks.supervision.robot import BenchRobot

from singulation_core import Arrangement, ContactMode, Push, ResultCode
from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.supervision import Phase, Step, Supervisor

STANDING = 0.02  # rad/s; below it an arm stands
_PUSH = Push(np.array((-0.05, 0.05)), np.array((0.06, 0.02)), ContactMode.TWO_POINT, 0.03)


@dataclass(frozen=True, slots=True)
class Scenario:
    """One thing that goes wrong.

    Args:
        case: number in the list of fault cases.
        name: what happens.
        phase: when it happens.
        after: seconds after the phase began.
        happen: makes it happen.
        test: the test that holds the same against a limit.
    """

    case: str
    name: str
    phase: Phase
    after: float
    happen: Callable[[BenchRobot, Supervisor], None]
    test: str


@dataclass(frozen=True, slots=True)
class Reaction:
    """What came of it; times in seconds, ways in metres, NaN where there is none.

    Args:
        scenario: what went wrong.
        code: of the outcome.
        text: of the outcome.
        noticed: from the fault to the order to stop.
        standstill: from the order to stop, or from the fault if the driver stopped by itself, until nothing moves.
        way: of the tips from the fault to that standstill.
        standing: whether the supervision saw it.
        next_code: of the push after it.
    """

    scenario: Scenario
    code: ResultCode
    text: str
    noticed: float
    standstill: float
    way: float
    standing: bool
    next_code: ResultCode


def inject(name: str, value: float = 0.0) -> Callable[[BenchRobot, Supervisor], None]:
    """One of the driver's own faults."""
    return lambda robot, _: robot.driver.inject(name, value)


def measure(scenario: Scenario, robot: BenchRobot) -> Reaction:
    """Make it happen during a push, then reset and push again."""
    happened: list[float] = []

    def watch(step: Step, supervisor: Supervisor) -> None:
        began = robot.record.phases.get(scenario.phase)
        if not happened and began is not None and robot.driver.now - began >= scenario.after:
            happened.append(robot.driver.now)
            scenario.happen(robot, supervisor)

    segments = robot.planner.plan(_PUSH, Arrangement(()), robot.sample)
    outcome = robot.run(segments, watch)
    noticed, standstill, way = _times(robot, happened[0])
    robot.heal()
    again = robot.run(robot.planner.plan(_PUSH, Arrangement(()), robot.sample), lambda *_: None)
    return Reaction(scenario, outcome.code, outcome.text, noticed, standstill, way, outcome.standing, again.code)


def _times(robot: BenchRobot, fault: float) -> tuple[float, float, float]:
    record = robot.record
    stops = sorted({time for time, phase in record.orders if phase is Phase.STOPPING})
    ordered = stops[0] if stops else float("nan")
    # What is ordered a tenth of a second later and more is the retreat.
    later = [time for time in stops if time > ordered + 0.02]
    until = later[0] if later else record.times[-1] + 1.0
    times, speeds = np.array(record.times), np.array(record.speeds)
    moving = times[(speeds > STANDING) & (times >= fault) & (times < until)]
    stood = float(moving[-1]) if len(moving) else fault
    joints = np.array(record.joints)[(times >= fault) & (times <= stood)]
    return ordered - fault, max(0.0, stood - ordered), _way(robot, joints)


def _way(robot: BenchRobot, joints: FloatArray) -> float:
    """Length of the longer way of both arms' tips."""
    if len(joints) < 2:
        return 0.0
    ways = []
    for index, arm in enumerate(ARMS):
        tips = np.array([robot.planner.tip(arm, q[7 * index : 7 * index + 7]) for q in joints])
        ways.append(float(np.sqrt((np.diff(tips, axis=0) ** 2).sum(axis=1)).sum()))
    return max(ways)
