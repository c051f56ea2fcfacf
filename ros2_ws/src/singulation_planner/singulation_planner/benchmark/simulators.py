"""The presets of the push physics against each other: time and error of a simulated push."""

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from singulation_core import ContactMode, Push
from singulation_core.polygon import FloatArray
from singulation_core.push_world import PushOutcomes, PushPhysics, simulate_pushes
from singulation_planner.benchmark.generators import generate, groups
from singulation_planner.benchmark.markdown import table
from singulation_planner.benchmark.scenario import Scenario
from singulation_planner.benchmark.settings import Setting

# As fine as pymunk reasonably goes; what the others are measured against.
_REFERENCE = PushPhysics(step=0.005, iterations=60, slop=0.0005)
_COUNTS = (3, 6, 10, 15)
_PUSHES = 60  # random ones on each scene
_TRAVEL = 1.3  # bounding radii, of which 0.3 are free way


@dataclass(frozen=True, eq=False)
class _Case:
    scenario: Scenario
    pushes: Sequence[Push]
    truth: PushOutcomes


def simulator_table(setting: Setting, scenes: int, mode: ContactMode) -> str:
    """Markdown: a row for each preset.

    Args:
        setting: scenes, jaws.
        scenes: how many; 60 random pushes on each.
        mode: contact mode.
    """
    cases = [_case(setting, mode, rank) for rank in range(scenes)]
    presets = {
        "pymunk, reference (step 0.005, 60 iterations)": _REFERENCE,
        "pymunk, fine (0.02, 30)": PushPhysics.fine(),
        "pymunk, quasi_static (0.05, 10)": PushPhysics.quasi_static(),
        "pymunk (0.1, 10)": PushPhysics(step=0.1),
        "compiled (0.02, 20)": PushPhysics(engine="compiled", step=0.02, iterations=20, settle_steps=2),
        "compiled (0.05, 10)": PushPhysics(engine="compiled", step=0.05, settle_steps=2),
        "compiled, fast (0.1, 10)": PushPhysics.fast(),
    }
    done = int(sum(case.truth.done.sum() for case in cases))
    header = [f"{mode.label}: {done} pushes on {scenes} scenes", "ms/push", "median error", "90 %"]
    header += ["correlation of gains", "mean size of gain / reference", "value of its best push", "gain without push"]
    return table(header, [_row(name, physics, cases, setting) for name, physics in presets.items()])


def _case(setting: Setting, mode: ContactMode, rank: int) -> _Case:
    count = _COUNTS[rank % len(_COUNTS)]
    scenario = generate(setting.generator, count, rank // len(_COUNTS) % len(groups()), 500 + rank)
    pushes = _random_pushes(setting, scenario, mode, np.random.default_rng(rank))
    truth = simulate_pushes(scenario.arrangement, pushes, _REFERENCE, setting.pusher)
    return _Case(scenario, pushes, truth)


def _random_pushes(setting: Setting, scenario: Scenario, mode: ContactMode, random: np.random.Generator) -> list[Push]:
    blocks, jaws = scenario.arrangement, setting.pusher
    pushes = []
    for _ in range(_PUSHES):
        index = int(random.integers(len(blocks)))
        radius, angle = float(blocks.bounding_radii[index]), random.uniform(-np.pi, np.pi)
        way = np.array((np.cos(angle), np.sin(angle)))
        aside = random.uniform(-0.7, 0.7) * radius * np.array((-way[1], way[0]))
        start = blocks.centroids[index] + aside - (radius + jaws.tip_radius) * way
        width = {ContactMode.EDGE: jaws.edge_width, ContactMode.TWO_POINT: 0.6 * radius}.get(mode, 0.0)
        pushes.append(Push(start, start + _TRAVEL * scenario.unit * way, mode, width))
    return pushes


def _row(name: str, physics: PushPhysics, cases: Sequence[_Case], setting: Setting) -> list[str]:
    first = cases[0]
    simulate_pushes(first.scenario.arrangement, first.pushes[:1], physics, setting.pusher)  # compile
    started = time.process_time()
    found = [simulate_pushes(case.scenario.arrangement, case.pushes, physics, setting.pusher) for case in cases]
    seconds = (time.process_time() - started) / (len(cases) * _PUSHES)
    errors = np.concatenate([_errors(case, one) for case, one in zip(cases, found, strict=True)])
    both = [case.truth.done & one.done for case, one in zip(cases, found, strict=True)]
    theirs = np.concatenate([case.truth.gains()[k] for case, k in zip(cases, both, strict=True)])
    ours = np.concatenate([one.gains()[k] for one, k in zip(found, both, strict=True)])
    return [
        name,
        f"{1e3 * seconds:.3f}",
        f"{np.median(errors):.4f}",
        f"{np.quantile(errors, 0.9):.3f}",
        f"{np.corrcoef(ours, theirs)[0, 1]:.4f}",
        f"{np.abs(ours).mean() / np.abs(theirs).mean():.3f}",
        f"{_value(cases, found):.4f}",
        f"{_gain_without_push(cases, physics, setting):.1e}",
    ]


def _errors(case: _Case, found: PushOutcomes) -> FloatArray:
    """Distance of the worst block from where the reference has it, for each push [bounding radii]."""
    both = case.truth.done & found.done
    apart = (found.poses[both] - case.truth.poses[both])[..., :2]
    return np.asarray(np.hypot(apart[..., 0], apart[..., 1]).max(axis=1) / case.scenario.unit)


def _value(cases: Sequence[_Case], found: Sequence[PushOutcomes]) -> float:
    """What the pushes that look best here gain in the reference, as a share of the best there."""
    chosen = best = 0.0
    for case, one in zip(cases, found, strict=True):
        gains = case.truth.gains()
        looks = np.where(case.truth.done, one.gains(), -np.inf)
        chosen += float(gains[int(np.nanargmax(looks))])
        best += float(np.nanmax(gains))
    return chosen / best


def _gain_without_push(cases: Sequence[_Case], physics: PushPhysics, setting: Setting) -> float:
    """Largest change of s on any scene by a push that meets nothing."""
    changes = []
    for case in cases:
        far = case.scenario.arrangement.centroids.max(axis=0) + 10.0 * case.scenario.unit
        away = Push(far, far + case.scenario.unit, ContactMode.SINGLE_POINT)
        outcome = simulate_pushes(case.scenario.arrangement, [away], physics, setting.pusher)
        changes.append(abs(float(outcome.gains()[0])))
    return max(changes)
