"""Looks at a motion from outside: dense samples, Pinocchio's forward kinematics, distances without margins."""

import numpy as np
import pinocchio as pin

from yumi_push_executor.clearance import Checker, Margins, Stage, build_scene
from yumi_push_executor.kinematics import CLEAR_VIEW, TIP_OFFSET
from yumi_push_executor.kinematics.model import arm_model, robot
from yumi_push_executor.motion.table import swept_blocks
from yumi_push_executor.supervision import Phase

STEP = 0.004  # [s]: the robot's controller interpolates at 250 Hz
NO_MARGIN = Margins(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
STAGES = {
    Phase.APPROACH: Stage.TRAVEL,
    Phase.DESCEND: Stage.DESCEND,
    Phase.PUSH: Stage.PUSH,
    Phase.RETREAT: Stage.PUSH,
    Phase.CLEAR_VIEW: Stage.CLEAR,
}


def sampled(trajectory):
    return trajectory.sample(np.arange(0.0, trajectory.duration + STEP, STEP))


def tool_poses(arm, positions):
    """(n, 4, 4) poses of tool0."""
    model = robot()
    data, q, frame = model.createData(), np.zeros(model.nq), model.getFrameId(f"{arm}_tool0")
    poses = []
    for row in positions:
        q[list(arm_model(arm).positions)] = row
        pin.framesForwardKinematics(model, data, q)
        poses.append(data.oMf[frame].homogeneous)
    return np.array(poses)


def tips(poses):
    return poses[:, :3, 3] + TIP_OFFSET * poses[:, :3, 2]


def off_line(points, start, direction):
    """Largest distance of points to a line [m]."""
    off = points - start
    return float(np.linalg.norm(off - (off @ direction)[:, None] * direction, axis=1).max())


def trajectories(motion):
    return [(segment.phase, segment.trajectory) for segment in motion.segments if segment.trajectory is not None]


def smallest_distance(motion, arrangement, cell, pusher):
    """Over all phases, of everything that must not touch [m]; and what it is."""
    touched = swept_blocks(motion.push, arrangement, pusher)
    shift = motion.push.end - motion.push.start
    scene = build_scene(motion.arm, cell, arrangement, touched, shift, 0.05)
    checker = Checker(scene, CLEAR_VIEW, motion.opening, NO_MARGIN)
    found = []
    for phase, trajectory in trajectories(motion):
        for row in sampled(trajectory)[0][::8]:
            found.append(checker.smallest_slack(row, STAGES[phase]))
    return min(found, key=lambda one: one[0])
