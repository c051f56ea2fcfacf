"""One push of each contact mode as a picture and as an animation."""

from pathlib import Path

import numpy as np
from benchmarks.executor.drawing import Moment, save_animation, save_strip

from singulation_core import Arrangement, CellGeometry, ContactMode, PlanarObject, Push, PusherGeometry
from singulation_core.polygon import FloatArray
from singulation_core.push_world import simulate_push
from yumi_push_executor import Motion, YumiArm, plan_motion
from yumi_push_executor.kinematics import CLEAR_VIEW
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.motion.jaws import middle_line
from yumi_push_executor.supervision.segment import Phase

_RATE = 8  # frames per second


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
        motion = plan_motion(push, blocks)
        picture = folder / f"motion_{mode.label}.png"
        save_strip(picture, [_moment(motion, blocks, phase, 1.0) for phase in _PHASES], push)
        written.append(picture)
        if animations:
            written.append(folder / f"motion_{mode.label}.gif")
            save_animation(written[-1], _all_moments(motion, blocks), _RATE)
    return written


_PHASES = (Phase.GRIPPER, Phase.APPROACH, Phase.DESCEND, Phase.PUSH, Phase.RETREAT, Phase.CLEAR_VIEW)


def _all_moments(motion: Motion, blocks: Arrangement) -> list[Moment]:
    """Twice the real speed."""
    moments = []
    for phase in _PHASES[1:]:
        trajectory = motion.segment(phase).trajectory
        frames = max(2, round(0.5 * _RATE * (trajectory.duration if trajectory else 0.0)))
        moments += [_moment(motion, blocks, phase, share) for share in np.linspace(0.0, 1.0, frames)]
    return moments


def _moment(motion: Motion, blocks: Arrangement, phase: Phase, share: float) -> Moment:
    """What is seen after a share of a phase; the blocks move as the push physics says."""
    trajectory = motion.segment(phase).trajectory
    q = motion.start if trajectory is None else trajectory.sample(share * trajectory.duration)[0][0]
    other = next(name for name in ARMS if name != motion.arm)
    postures = {motion.arm: q, other: CLEAR_VIEW[other]}
    title = phase.name.lower().replace("_", " ")
    return Moment(title, motion.arm, postures, {motion.arm: motion.opening}, _blocks(motion, blocks, phase, q))


def _blocks(motion: Motion, blocks: Arrangement, phase: Phase, q: FloatArray) -> Arrangement:
    if phase < Phase.PUSH:
        return blocks
    push = motion.push
    if phase is Phase.PUSH:
        tip = _tip_in_table(motion.arm, q)
        gone = float((tip - middle_line(push, PusherGeometry()).start) @ push.direction)
        if not (gone > 1e-4):
            return blocks
        push = Push(push.start, push.start + gone * push.direction, push.contact_mode, push.contact_width)
    return simulate_push(blocks, push)


def _tip_in_table(arm: str, q: FloatArray) -> FloatArray:
    pose = CellGeometry().body_from_table
    return np.asarray((pose[:3, :3].T @ (YumiArm(arm).tip(q)[:3, 3] - pose[:3, 3]))[:2])
