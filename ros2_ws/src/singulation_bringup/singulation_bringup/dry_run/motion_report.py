"""A planned motion in numbers a person can judge before the robot does it."""

from dataclasses import dataclass

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_core.transforms import inverse, transform_points
from yumi_push_executor import Motion, YumiArm
from yumi_push_executor.supervision import Segment

_STEP = 0.02  # s between two points of a path


@dataclass(frozen=True, eq=False, slots=True)
class PhaseReport:
    """One segment of a motion.

    Args:
        phase: its name.
        opening: of the jaws [m], for a segment that only moves them; else None.
        duration: [s].
        path: (k, 3) of the point between the finger tips, frame ``table`` [m].
        fastest_tip: of that point [m/s].
        lowest_tip: height of that point above the table, at its lowest [m].
        joint_share: highest speed of any joint, as a share of what the robot can do.
    """

    phase: str
    opening: float | None
    duration: float
    path: FloatArray
    fastest_tip: float
    lowest_tip: float
    joint_share: float


def motion_report(motion: Motion, body_from_table: FloatArray) -> list[PhaseReport]:
    """The segments of a motion, in order."""
    arm, table_from_body = YumiArm(motion.arm), inverse(body_from_table)
    return [_phase(segment, arm, table_from_body) for segment in motion.segments]


def _phase(segment: Segment, arm: YumiArm, table_from_body: FloatArray) -> PhaseReport:
    trajectory = segment.trajectory
    if trajectory is None:
        return PhaseReport(segment.phase.name, segment.opening, 0.0, np.empty((0, 3)), 0.0, np.inf, 0.0)
    times = np.linspace(0.0, trajectory.duration, max(2, round(trajectory.duration / _STEP) + 1))
    positions, velocities = trajectory.sample(times)
    path = transform_points(table_from_body, np.array([arm.tip(q)[:3, 3] for q in positions]))
    speed = np.linalg.norm(np.diff(path, axis=0), axis=1) / np.diff(times)
    return PhaseReport(
        segment.phase.name,
        None,
        trajectory.duration,
        path,
        float(speed.max()),
        float(path[:, 2].min()),
        float((np.abs(velocities) / arm.velocity).max()),
    )


def report_text(motion: Motion, phases: list[PhaseReport]) -> str:
    """The report as lines for a terminal."""
    push = motion.push
    lines = [
        f"push of object {push.target_id} with the {motion.arm} arm, {push.contact_mode.label}, "
        f"{1e3 * push.length:.0f} mm from ({push.start[0]:+.3f}, {push.start[1]:+.3f}) "
        f"to ({push.end[0]:+.3f}, {push.end[1]:+.3f}) m in table; {motion.duration:.1f} s in all",
        "  phase        s    tips at most   lowest tips   joints at most",
    ]
    for one in phases:
        if one.opening is not None:
            lines.append(f"  {one.phase:<10}      jaws to {1e3 * one.opening:.1f} mm")
        else:
            lines.append(
                f"  {one.phase:<10} {one.duration:4.1f}   {1e3 * one.fastest_tip:5.0f} mm/s   "
                f"{1e3 * one.lowest_tip:7.1f} mm   {100 * one.joint_share:7.0f} %"
            )
    lines.append(f"  nearest to a joint limit on the straight parts: {np.degrees(motion.limit_margin):.1f} degrees")
    return "\n".join(lines)
