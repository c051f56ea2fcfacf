"""Looks at a finished motion from outside: dense samples, Pinocchio's kinematics and distances."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pinocchio as pin
from benchmarks.executor.solids import configuration

from singulation_core import Arrangement, CellGeometry, ContactMode, PusherGeometry
from singulation_core.polygon import FloatArray
from yumi_push_executor import Motion, MotionParameters
from yumi_push_executor.clearance import Margins, build_scene, parts_in_view
from yumi_push_executor.clearance.shapes import Kind
from yumi_push_executor.kinematics import CLEAR_VIEW, TIP_OFFSET
from yumi_push_executor.kinematics.model import arm_model, robot
from yumi_push_executor.motion.jaws import middle_line
from yumi_push_executor.motion.table import swept_blocks
from yumi_push_executor.supervision.segment import Phase

_STEP = 0.004  # [s], as the robot's controller interpolates
_SPARSE = 10  # every how many of these samples distances are measured
_BETWEEN = 0.004  # [m] that clearance may fall below a margin between two postures the planner checked
_TOUCHED = frozenset((Phase.PUSH, Phase.RETREAT))
_LINES = frozenset((Phase.DESCEND, Phase.PUSH, Phase.RETREAT))


@dataclass
class Figures:
    """Worst values of one motion; lengths [m], angles [rad], ratios of the limit."""

    straightness: float = 0.0
    tilt: float = 0.0
    heading: float = 0.0
    joint_room: float = np.inf
    speed_ratio: float = 0.0
    acceleration_ratio: float = 0.0
    tip_speed: dict[str, float] = field(default_factory=dict)
    steady_share: float = 0.0
    joint_step: float = 0.0
    clearance: dict[str, float] = field(default_factory=dict)
    violations: list[str] = field(default_factory=list)


def audit(motion: Motion, arrangement: Arrangement, cell: CellGeometry, parameters: MotionParameters) -> Figures:
    """Everything that is promised of a motion, measured; broken promises are named in ``violations``."""
    figures = Figures()
    touched = swept_blocks(motion.push, arrangement, PusherGeometry())
    scene = build_scene(motion.arm, cell, arrangement, touched, motion.push.end - motion.push.start, 0.05)
    data = pin.GeometryData(scene.geometry)
    before: FloatArray | None = None
    for segment in motion.segments:
        if segment.trajectory is None:
            continue
        times = np.arange(0.0, segment.trajectory.duration + _STEP, _STEP)
        positions, velocities = segment.trajectory.sample(times)
        if before is not None and not (np.abs(positions[0] - before).max() < 1e-9):
            figures.violations.append(f"{segment.phase.name} does not start where the one before ends")
        before = positions[-1]
        _joints(figures, motion, positions, velocities, parameters)
        poses = _tool_poses(motion.arm, positions)
        _tips(figures, motion, segment.phase, poses, cell, parameters)
        _distances(figures, scene, data, motion, segment.phase, positions[::_SPARSE], parameters)
    if before is not None and parts_in_view({motion.arm: before}, cell):
        figures.violations.append("the arm ends in the camera's view")
    return figures


def _joints(
    figures: Figures, motion: Motion, positions: FloatArray, velocities: FloatArray, p: MotionParameters
) -> None:
    arm = arm_model(motion.arm)
    room = float(np.minimum(positions - arm.chain.limits[0], arm.chain.limits[1] - positions).min())
    speed = float((np.abs(velocities) / arm.velocity).max())
    hard = float((np.abs(np.diff(velocities, axis=0)) / _STEP / np.array(p.joint_acceleration)).max(initial=0.0))
    figures.joint_room = min(figures.joint_room, room)
    figures.speed_ratio = max(figures.speed_ratio, speed)
    figures.acceleration_ratio = max(figures.acceleration_ratio, hard)
    figures.joint_step = max(figures.joint_step, float(np.abs(np.diff(positions, axis=0)).max(initial=0.0)))
    for broken, text in (
        (not (room >= 0.0), f"joint limit exceeded by {-room:.4f} rad"),
        (not (speed <= p.velocity_share + 1e-6), f"joint speed {speed:.3f} of its limit"),
        (not (hard <= 1.0 + 1e-3), f"joint acceleration {hard:.3f} of its limit"),
    ):
        if broken:
            figures.violations.append(text)


def _tool_poses(arm: str, positions: FloatArray) -> list[Any]:
    model = robot()
    data, frame, q = model.createData(), model.getFrameId(f"{arm}_tool0"), np.zeros(model.nq)
    poses = []
    for row in positions:
        q[list(arm_model(arm).positions)] = row
        pin.framesForwardKinematics(model, data, q)
        poses.append(data.oMf[frame].copy())
    return poses


def _tips(
    figures: Figures, motion: Motion, phase: Phase, poses: list[Any], cell: CellGeometry, p: MotionParameters
) -> None:
    tips = np.array([one.translation + TIP_OFFSET * one.rotation[:, 2] for one in poses])
    speeds = np.sqrt((np.diff(tips, axis=0) ** 2).sum(axis=1)) / _STEP
    fastest = float(speeds.max(initial=0.0))
    figures.tip_speed[phase.name] = fastest
    allowed = {Phase.PUSH: p.push_speed, Phase.DESCEND: p.vertical_speed, Phase.RETREAT: p.vertical_speed}
    if not (fastest <= allowed.get(phase, p.approach_speed) * 1.001):
        figures.violations.append(f"{phase.name}: tips at {fastest:.3f} m/s")
    if phase not in _LINES:
        return
    pose, line = cell.body_from_table, middle_line(motion.push, PusherGeometry())
    start, end = (pose[:3, :2] @ point + pose[:3, 3] + p.tip_height * pose[:3, 2] for point in (line.start, line.end))
    origin, direction = {
        Phase.DESCEND: (start, pose[:3, 2]),
        Phase.PUSH: (start, (end - start) / motion.push.length),
        Phase.RETREAT: (end, pose[:3, 2]),
    }[phase]
    off = tips - origin
    deviation = float(np.sqrt(((off - (off @ direction)[:, None] * direction) ** 2).sum(axis=1)).max())
    tilt = max(float(np.arccos(np.clip(-one.rotation[:, 2] @ pose[:3, 2], -1.0, 1.0))) for one in poses)
    figures.straightness = max(figures.straightness, deviation)
    figures.tilt = max(figures.tilt, tilt)
    if not (deviation <= p.straightness):
        figures.violations.append(f"{phase.name}: {deviation * 1e3:.2f} mm from the straight line")
    if phase is Phase.PUSH:
        for point, wanted, name in ((tips[0], start, "start"), (tips[-1], end, "end")):
            if not (np.abs(point - wanted).max() <= 5e-4):
                figures.violations.append(f"the push misses its {name}")
        _pushing(figures, motion, speeds, poses, direction)


def _pushing(figures: Figures, motion: Motion, speeds: FloatArray, poses: list[Any], direction: FloatArray) -> None:
    """Steadiness of the speed, and jaws across the push."""
    steady = speeds > 0.99 * speeds.max()
    figures.steady_share = float(speeds[steady].sum() / speeds.sum())
    if motion.push.contact_mode is not ContactMode.SINGLE_POINT:
        along = max(abs(float(one.rotation[:, 0] @ direction)) for one in poses)
        figures.heading = max(figures.heading, float(np.arcsin(along)))
        if not (along <= 0.01):
            figures.violations.append(f"jaws {np.rad2deg(np.arcsin(along)):.1f} degrees off the perpendicular")


def _distances(
    figures: Figures, scene: Any, data: Any, motion: Motion, phase: Phase, positions: FloatArray, p: MotionParameters
) -> None:
    """Smallest distance of every kind of pair; what may be touched in this phase is left out."""
    model, work = robot(), robot().createData()
    postures, smallest = dict(CLEAR_VIEW), np.full(len(scene.pairs), np.inf)
    for row in positions:
        postures[motion.arm] = row
        pin.computeDistances(model, work, scene.geometry, data, configuration(postures, {motion.arm: motion.opening}))
        smallest = np.minimum(smallest, [result.min_distance for result in data.distanceResults])
    for pair, distance in zip(scene.pairs, smallest.tolist(), strict=True):
        if _may_touch(pair.kind, phase, pair.block in scene.touched):
            continue
        name = f"{pair.kind.value}, {'on the lines' if phase in _LINES else 'travelling'}"
        figures.clearance[name] = min(figures.clearance.get(name, np.inf), distance)
        if not (distance >= max(_margin(pair.kind, phase, p.margins) - _BETWEEN, 0.0)):
            figures.violations.append(f"{phase.name}: {pair.kind.value} {distance * 1e3:.2f} mm")


def _margin(kind: Kind, phase: Phase, margins: Margins) -> float:
    if kind is Kind.FINGER_BLOCK and phase in _LINES:
        return margins.descent
    if kind is Kind.FINGER_TABLE and phase in _LINES:
        return margins.finger_table
    return margins.by_kind()[kind]


def _may_touch(kind: Kind, phase: Phase, touched: bool) -> bool:
    if kind is Kind.MOVED_BLOCKS:
        return phase is not Phase.CLEAR_VIEW
    return kind is Kind.FINGER_BLOCK and touched and phase in _TOUCHED
