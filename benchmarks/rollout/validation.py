"""Errors of the simulators of pushes, the compiled one among them, against pymunk in very small steps."""

import json
import math
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from benchmarks.rollout.plans import SETTING, recipes
from benchmarks.rollout.table_in_box2d import simulate_in_box2d

from singulation_core import Arrangement, Push, SingulationError, singulation_distance
from singulation_core.polygon import FloatArray
from singulation_core.push_world import PushPhysics, simulate_push
from singulation_planner import plan_push
from singulation_planner.benchmark.evaluate import SceneRecipe
from singulation_planner.benchmark.markdown import table

Simulate = Callable[[Arrangement, Push], Arrangement]
_MOVED = 1e-3  # bounding radii; blocks that the reference moves less are left out of the errors


def _by(physics: PushPhysics) -> Simulate:
    return lambda blocks, push: simulate_push(blocks, push, physics, SETTING.pusher)


COASTING = "pymunk, authors (blocks coast)"
REFERENCE = _by(PushPhysics(step=0.005, iterations=60))
SIMULATORS: Mapping[str, Simulate] = {
    "pymunk, fine (steps of 0.02)": _by(PushPhysics.fine()),
    "pymunk, quasi_static (0.05)": _by(PushPhysics.quasi_static()),
    "compiled (0.05)": _by(PushPhysics(engine="compiled", settle_steps=2)),
    "compiled, fast (0.1)": _by(PushPhysics.fast()),
    "Box2D (0.02)": lambda blocks, push: simulate_in_box2d(blocks, push, SETTING.pusher),
    COASTING: _by(PushPhysics.authors()),
}


def validation_report(folder: Path, seeds: int, pushes: int, first_seed: int = 9000) -> str:
    """Markdown: a row for each simulator, over ``pushes`` random pushes of each of 52 scenes for each seed."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "validation.jsonl"
    known = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()] if path.exists() else []
    done = {one["scene"] for one in known}
    scenes = recipes(seeds, first_seed=first_seed)
    for number, recipe in enumerate(scenes):
        if recipe.key in done or not pushes:
            continue
        known.append(_compared(recipe, pushes))
        with path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(known[-1]) + "\n")
        if number % 10 == 0:
            print(f"scene {number + 1} of {len(scenes)}", file=sys.stderr)
    header = ["", "ms", "position, median", "95 %", "turn, median", "correlation of s' - s", "its best push"]
    header += ["correlation with authors", "its best push there", "failed"]
    text = f"{len(known)} scenes, {sum(len(one['gains']) for one in known)} pushes.\n\n"
    return text + table(header, [_row(known, name) for name in SIMULATORS]) if known else "nothing yet\n"


def _compared(recipe: SceneRecipe, count: int) -> dict[str, Any]:
    """Errors of all simulators over random pushes of one scene; None where one of them failed."""
    blocks = recipe.scene().arrangement
    unit = float(blocks.bounding_radii.mean())
    pushes = [
        plan_push(blocks, "quasi_random", pusher=SETTING.pusher, placement=SETTING.placement, seed=seed)
        for seed in range(count)
    ]
    true = [REFERENCE(blocks, push) for push in pushes]
    start = singulation_distance(blocks, unit)
    record: dict[str, Any] = {"scene": recipe.key, "gains": [singulation_distance(one, unit) - start for one in true]}
    for name, simulate in SIMULATORS.items():
        began = time.thread_time()
        found = [_tried(simulate, blocks, push) for push in pushes]
        errors = [_errors(blocks, one, other) if other else None for one, other in zip(true, found, strict=True)]
        gains = [singulation_distance(one, unit) - start if one else None for one in found]
        record[name] = {"errors": errors, "gains": gains, "seconds": (time.thread_time() - began) / count}
    return record


def _tried(simulate: Simulate, blocks: Arrangement, push: Push) -> Arrangement | None:
    try:
        return simulate(blocks, push)
    except SingulationError:
        return None


def _errors(before: Arrangement, true: Arrangement, found: Arrangement) -> list[tuple[float, float]]:
    """For each block that moves: error of its centroid [bounding radii] and of its direction [rad]."""
    unit = float(before.bounding_radii.mean())
    errors = []
    for old, one, other in zip(before.objects, true.objects, found.objects, strict=True):
        if np.abs(one.outline - old.outline).max() > _MOVED * unit:
            shift = float(np.hypot(*(other.centroid - one.centroid))) / unit
            errors.append((shift, abs(_turn(one.outline - one.centroid, other.outline - other.centroid))))
    return errors


def _turn(one: FloatArray, other: FloatArray) -> float:
    """Angle by which an outline around its centroid is turned against another [rad]."""
    sine, cosine = one[:, 0] @ other[:, 1] - one[:, 1] @ other[:, 0], (one * other).sum()
    return math.atan2(float(sine), float(cosine))


def _row(known: Sequence[Mapping[str, Any]], name: str) -> list[str]:
    errors = np.array([pair for one in known for push in one[name]["errors"] if push for pair in push]).reshape(-1, 2)
    true = [np.array(one["gains"]) for one in known]
    found = [np.array(one[name]["gains"], dtype=np.float64) for one in known]
    failed = sum(int(np.isnan(one).sum()) for one in found)
    coasting = [np.array(one[COASTING]["gains"], dtype=np.float64) for one in known]
    seconds = np.mean([one[name]["seconds"] for one in known])
    return [
        name,
        f"{1e3 * seconds:.2f}",
        f"{np.median(errors[:, 0]):.4f}",
        f"{np.quantile(errors[:, 0], 0.95):.3f}",
        f"{math.degrees(np.median(errors[:, 1])):.2f}°",
        *_agreement(true, found),
        *_agreement(coasting, found),
        str(failed),
    ]


def _agreement(true: Sequence[FloatArray], found: Sequence[FloatArray]) -> list[str]:
    """Mean correlation in a scene, and the gain of the push that is best by ``found`` as a share of the largest."""
    correlations = [_correlation(one, other) for one, other in zip(true, found, strict=True)]
    chosen = [one[int(np.argmax(np.nan_to_num(other, nan=-np.inf)))] for one, other in zip(true, found, strict=True)]
    share = float(np.nansum(chosen)) / sum(float(np.nanmax(one)) for one in true)
    return [f"{np.nanmean(correlations):.4f}", f"{100.0 * share:.1f} %"]


def _correlation(true: FloatArray, found: FloatArray) -> float:
    known = np.isfinite(found) & np.isfinite(true)
    return float(np.corrcoef(true[known], found[known])[0, 1]) if known.sum() > 1 else math.nan
