"""Which way of doing a push comes first: arm, branch and heading in order of promise."""

from collections.abc import Mapping

import numpy as np

from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics import TIP_OFFSET, YumiArm, chain
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.motion.lines import Lines
from yumi_push_executor.motion.parameters import MotionParameters
from yumi_push_executor.motion.timing import peaks

_WIDE_MARGIN = 0.7  # [rad] to the nearest joint limit; more is no better
_FAR = 0.3  # [m] from the other arm's tool; more is no better
_LONG = 3.0  # [s] of travel that cost as much as a whole margin


def ranked(
    solved: list[Lines], headings: FloatArray, postures: Mapping[str, FloatArray], parameters: MotionParameters
) -> list[Lines]:
    """All headings of all solved lines, best first.

    Four things count, each between 0 and 1: distance to the joint limits, ease of the push (joint speed it needs),
    distance to the other arm, and, against it, the time to get there.
    """
    scored: list[tuple[float, Lines]] = []
    for lines in solved:
        common = _ease(lines, parameters) + _distance(lines, postures)
        for heading in headings:
            for one in lines.turned(float(heading), parameters.limit_margin):
                own = _margin(one) - _travel(one, postures[one.arm.name], parameters)
                scored.append((common + own, one))
    return [lines for _, lines in sorted(scored, key=lambda pair: -pair[0])]


def _margin(lines: Lines) -> float:
    return min(lines.limit_margin[0] / _WIDE_MARGIN, 1.0)


def _ease(lines: Lines, parameters: MotionParameters) -> float:
    speed = peaks(lines.push)[0]
    return 1.0 - float((speed / (parameters.velocity_share * lines.arm.velocity)).max())


def _distance(lines: Lines, postures: Mapping[str, FloatArray]) -> float:
    """Between the tips along the push and the other arm's tool."""
    other = YumiArm(next(name for name in ARMS if name != lines.arm.name))
    tool = other.tip(postures[other.name])[:3, 3]
    tips = chain.tips(lines.arm.chain, lines.push.positions, TIP_OFFSET)
    return min(float(np.sqrt(((tips - tool) ** 2).sum(axis=1)).min()) / _FAR, 1.0)


def _travel(lines: Lines, present: FloatArray, parameters: MotionParameters) -> float:
    way = np.abs(lines.down.start - present)
    return float((way / (parameters.velocity_share * lines.arm.velocity)).max()) / _LONG
