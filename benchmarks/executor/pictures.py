"""One push of each contact mode as a picture and as an animation, from the joint states of its execution."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from benchmarks.executor.drawing import Moment, save_animation, save_strip
from benchmarks.supervision.robot import BenchRobot

from singulation_core import Arrangement, CellGeometry, ContactMode, PlanarObject, Push, PusherGeometry, ResultCode
from singulation_core.polygon import FloatArray
from singulation_core.push_world import simulate_push
from singulation_sim.driver import PERIOD
from yumi_push_executor import YumiArm
from yumi_push_executor.motion.jaws import middle_line
from yumi_push_executor.supervision import Phase, Step, Supervisor

_RATE = 8  # frames per second
_SPEED = 2.0  # times the real one


def example(mode: ContactMode) -> tuple[Push, Arrangement]:
    """Four blocks close together, and a push into them."""
    square = np.array(((-0.018, -0.018), (0.018, -0.018), (0.018, 0.018), (-0.018, 0.018)))
    places = ((0.02, -0.02), (0.02, 0.018), (0.058, -0.02), (0.059, 0.019))
    blocks = Arrangement([PlanarObject(k, square + place, height=0.03) for k, place in enumerate(places)])
    width = {ContactMode.SINGLE_POINT: 0.0, ContactMode.EDGE: 0.0124, ContactMode.TWO_POINT: 0.026}[mode]
    start, end = {
        ContactMode.SINGLE_POINT: ((-0.02, 0.0), (0.06, 0.0)),
        ContactMode.EDGE: ((0.0, 0.06), (0.035, 0.0)),
        ContactMode.TWO_POINT: ((-0.02, -0.02), (0.06, -0.03)),
    }[mode]
    return Push(np.array(start), np.array(end), mode, width), blocks


def save_pictures(folder: Path, animations: bool) -> list[Path]:
    """Files written."""
    written: list[Path] = []
    for mode in ContactMode:
        push, blocks = example(mode)
        states = executed(push, blocks)
        parts = [[one for one in states if one.phase is phase] for phase in _PHASES]
        picture = folder / f"executor_{mode.label}.png"
        save_strip(picture, [_moment(part[-1], push, blocks) for part in parts], push)
        written.append(picture)
        if animations:
            written.append(picture.with_suffix(".gif"))
            moments = [_moment(one, push, blocks) for one in states[:: round(_SPEED / _RATE / PERIOD)]]
            save_animation(written[-1], moments, _RATE)
    return written


@dataclass(frozen=True, eq=False, slots=True)
class _State:
    """Measured joint states during a push: (7,) angles per arm [rad], jaw openings [m]."""

    phase: Phase
    arm: str
    postures: dict[str, FloatArray]
    openings: dict[str, float]


def executed(push: Push, blocks: Arrangement) -> list[_State]:
    """The joint states that the simulated driver reports while the push is executed under supervision, at 250 Hz."""
    robot, states = BenchRobot(), list[_State]()
    segments = robot.planner.plan(push, blocks, robot.sample)
    arm = segments[0].arm

    def record(step: Step, _: Supervisor) -> None:
        states.append(_State(step.phase, arm, robot.sample.positions, robot.sample.openings))

    outcome = robot.run(segments, record)
    if outcome.code is not ResultCode.OK:
        raise RuntimeError(f"{push.contact_mode.label} push ended with {outcome.code.name}: {outcome.text}")
    return states


_PHASES = (Phase.GRIPPER, Phase.APPROACH, Phase.DESCEND, Phase.PUSH, Phase.RETREAT, Phase.CLEAR_VIEW)


def _moment(state: _State, push: Push, blocks: Arrangement) -> Moment:
    """What is seen in a state; the blocks move as the push physics says."""
    title = state.phase.name.lower().replace("_", " ")
    return Moment(title, state.arm, state.postures, state.openings, _blocks(state, push, blocks))


def _blocks(state: _State, push: Push, blocks: Arrangement) -> Arrangement:
    if state.phase < Phase.PUSH:
        return blocks
    if state.phase is Phase.PUSH:
        tip = _tip_in_table(state.arm, state.postures[state.arm])
        gone = float((tip - middle_line(push, PusherGeometry()).start) @ push.direction)
        if not (gone > 1e-4):
            return blocks
        push = Push(push.start, push.start + gone * push.direction, push.contact_mode, push.contact_width)
    return simulate_push(blocks, push)


def _tip_in_table(arm: str, q: FloatArray) -> FloatArray:
    pose = CellGeometry().body_from_table
    return np.asarray((pose[:3, :3].T @ (YumiArm(arm).tip(q)[:3, 3] - pose[:3, 3]))[:2])
