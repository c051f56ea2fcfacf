"""Which way of doing a push comes first: arm, branch and heading in order of promise."""

from collections.abc import Mapping
from dataclasses import dataclass

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
_STAND_BACK = 0.2


@dataclass(frozen=True, eq=False)
class Candidate:
    """One way to do a push: lines of an arm and branch, and how far the last joint turns for the heading [rad]."""

    lines: Lines
    turn: float
    score: float


def ranked(
    solved: list[Lines], headings: FloatArray, postures: Mapping[str, FloatArray], parameters: MotionParameters
) -> list[Candidate]:
    """All headings of all solved lines, best first.

    Four things count, each between 0 and 1: distance to the joint limits, ease of the push (joint speed it needs),
    distance to the other arm, and, against it, the time to get there. What blocks one heading of a branch often
    blocks the next, so each further one of the same branch stands back a little.
    """
    found: list[Candidate] = []
    for lines in solved:
        common = _ease(lines, parameters) + _distance(lines, postures)
        present = postures[lines.arm.name]
        turns = [turn for one in headings for turn in lines.turns(float(one), parameters.limit_margin)]
        scores = [common + _margin(lines, turn) - _travel(lines, turn, present, parameters) for turn in turns]
        order = np.argsort(-np.array(scores), kind="stable")
        found += [Candidate(lines, turns[k], scores[k] - _STAND_BACK * rank) for rank, k in enumerate(order)]
    return sorted(found, key=lambda one: -one.score)


def _margin(lines: Lines, turn: float) -> float:
    return min(lines.room(turn)[0] / _WIDE_MARGIN, 1.0)


def _ease(lines: Lines, parameters: MotionParameters) -> float:
    speed = peaks(lines.push)[0]
    return 1.0 - float((speed / (parameters.velocity_share * lines.arm.velocity)).max())


def _distance(lines: Lines, postures: Mapping[str, FloatArray]) -> float:
    """Between the tips along the push and the other arm's tool."""
    other = YumiArm(next(name for name in ARMS if name != lines.arm.name))
    tool = other.tip(postures[other.name])[:3, 3]
    tips = chain.tips(lines.arm.chain, lines.push.positions, TIP_OFFSET)
    return min(float(np.sqrt(((tips - tool) ** 2).sum(axis=1)).min()) / _FAR, 1.0)


def _travel(lines: Lines, turn: float, present: FloatArray, parameters: MotionParameters) -> float:
    way = lines.down.start - present
    way[6] += turn
    return float((np.abs(way) / (parameters.velocity_share * lines.arm.velocity)).max()) / _LONG
