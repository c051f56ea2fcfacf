"""The benchmark's tables as Markdown."""

from collections import Counter
from pathlib import Path

import numpy as np
from benchmarks.executor.reach import ReachMap
from benchmarks.executor.trials import Trial

_AUDIT = "## Audit: 250 Hz samples of every motion, Pinocchio's kinematics and distances"


def write_report(path: Path, reach: ReachMap, sets: dict[str, list[Trial]]) -> None:
    """Reach map, planned share, planning time and audit of every set of pushes."""
    lines = ["# Motion planning of pushes", "", *_reach_lines(reach)]
    lines += ["", "## Planned", "", *_planned_lines(sets)]
    lines += ["", "## Planning time, processor time of one core", "", *_time_lines(sets)]
    lines += [
        "",
        _AUDIT,
        "",
        *_audit_lines(sets),
    ]
    path.write_text("\n".join(lines) + "\n")


def _reach_lines(reach: ReachMap) -> list[str]:
    either = np.any(list(reach.reached.values()), axis=0)
    both = np.all(list(reach.reached.values()), axis=0)
    rows = [
        ("left arm", reach.reached["left"]),
        ("right arm", reach.reached["right"]),
        ("either", either),
        ("both", both),
    ]
    spacing = (reach.xs[1] - reach.xs[0]) * 1e3
    lines = [
        "## Reach map",
        "",
        f"{either.size} points, {spacing:.0f} mm apart over the workspace: jaws straight down at pushing and at "
        "travelling height, within the joint limits, clear of body, other arm and table.",
        "",
        "| arm | share of the workspace |",
        "|---|---|",
    ]
    return lines + [f"| {name} | {100.0 * float(mask.mean()):.1f} % |" for name, mask in rows]


def _planned_lines(sets: dict[str, list[Trial]]) -> list[str]:
    lines = [
        "| set | pushes | within reach | planned | of those within reach | refusals by code |",
        "|---|---|---|---|---|---|",
    ]
    for name, trials in sets.items():
        inside = [one for one in trials if one.within_reach]
        done = sum(one.motion is not None for one in inside)
        refused = Counter(one.code.name for one in trials if one.motion is None)
        text = ", ".join(f"{code} {count}" for code, count in refused.most_common()) or "none"
        total = sum(one.motion is not None for one in trials)
        share = 100.0 * done / max(len(inside), 1)
        lines.append(f"| {name} | {len(trials)} | {len(inside)} | {total} | {share:.1f} % | {text} |")
    for name, trials in sets.items():
        arms = Counter(one.motion.arm for one in trials if one.motion)
        modes = Counter(one.task.push.contact_mode.label for one in trials if one.motion is None)
        lines += ["", f"{name}: arms {dict(arms)}; refused by mode {dict(modes) or 'none'}"]
    return lines


def _time_lines(sets: dict[str, list[Trial]]) -> list[str]:
    lines = ["| set | median | 90 % | 99 % | worst |", "|---|---|---|---|---|"]
    for name, trials in sets.items():
        times = 1e3 * np.array([one.seconds for one in trials])
        middle, nine, ninety_nine = np.percentile(times, (50, 90, 99))
        lines.append(f"| {name} | {middle:.1f} ms | {nine:.1f} ms | {ninety_nine:.1f} ms | {times.max():.1f} ms |")
    return lines


def _audit_lines(sets: dict[str, list[Trial]]) -> list[str]:
    lines = ["| figure | " + " | ".join(sets) + " |", "|---|" + "---|" * len(sets)]
    columns = [_figures(trials) for trials in sets.values()]
    return lines + [
        f"| {name} | " + " | ".join(column.get(name, "") for column in columns) + " |" for name in columns[-1]
    ]


def _figures(trials: list[Trial]) -> dict[str, str]:
    figures = [one.figures for one in trials if one.figures]
    if not figures:
        return {}
    values = {
        "motions": str(len(figures)),
        "motions with a violation": str(sum(bool(one.violations) for one in figures)),
        "largest deviation from a straight line": f"{1e3 * max(one.straightness for one in figures):.4f} mm",
        "largest tilt of the jaws on straight lines": f"{np.rad2deg(max(one.tilt for one in figures)):.4f} deg",
        "jaws off the perpendicular (edge, two points)": f"{np.rad2deg(max(one.heading for one in figures)):.4f} deg",
        "smallest distance to a joint limit": f"{min(one.joint_room for one in figures):.3f} rad",
        "highest joint speed, share of its limit": f"{max(one.speed_ratio for one in figures):.3f}",
        "highest joint acceleration, share of its limit": f"{max(one.acceleration_ratio for one in figures):.3f}",
        "largest joint step in 4 ms": f"{max(one.joint_step for one in figures):.4f} rad",
        "share of the push at constant speed, least": f"{100 * min(one.steady_share for one in figures):.0f} %",
    }
    for phase in figures[0].tip_speed:
        values[f"fastest tips: {phase.lower()}"] = f"{1e3 * max(one.tip_speed[phase] for one in figures):.1f} mm/s"
    kinds = sorted({kind for one in figures for kind in one.clearance})
    for kind in kinds:
        smallest = min(one.clearance.get(kind, np.inf) for one in figures)
        values[f"smallest distance: {kind}"] = f"{1e3 * smallest:.2f} mm"
    return values
