"""How many pushes until all blocks are separated."""

import json
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from benchmarks.rollout.plans import SETTING

from singulation_core import SingulationError, smallest_gap
from singulation_core.push_world import PushPhysics, simulate_push
from singulation_planner import plan_push
from singulation_planner.benchmark.evaluate import SceneRecipe
from singulation_planner.benchmark.generators import groups
from singulation_planner.benchmark.markdown import table

GAP = 0.4  # that counts as separated [mean bounding radii]
LIMITS = {5: 30, 8: 40, 10: 50, 15: 80}  # pushes after which a scene counts as not solved


@dataclass(frozen=True, slots=True)
class Way:
    """A policy with options, asked again after each push."""

    name: str
    policy: str
    options: Mapping[str, Any] = field(default_factory=dict)


def _clearance(**options: Any) -> Mapping[str, Any]:
    return {"objective": "clearance", **options}


WAYS: Sequence[Way] = (
    Way("Rollout Push, clearance", "rollout_push", _clearance()),
    Way("ClusterPush", "cluster_push"),
    Way("Rollout Push, clearance, score alone", "rollout_push", _clearance(budget=0.0)),
    Way("Rollout Push, clearance, 400 rollouts", "rollout_push", _clearance(rollouts=400)),
    Way("Rollout Push, clearance, best contact mode", "rollout_push", _clearance(best_contact_mode=True, rollouts=480)),
    Way(
        "Rollout Push, clearance, two pushes ahead",
        "rollout_push",
        _clearance(look_ahead=2, rollouts=500, budget=1e5),
    ),
    Way("Rollout Push, singulation distance", "rollout_push"),
)


def pushes_needed(way: Way, recipe: SceneRecipe) -> dict[str, Any]:
    """Pushes, whether all gaps were wide enough then, and the median time of a plan [s]; judged in fine pymunk."""
    blocks = recipe.scene().arrangement
    times: list[float] = []
    width, limit = GAP * float(blocks.bounding_radii.mean()), LIMITS[recipe.n]
    for done in range(limit):
        if smallest_gap(blocks) > width:
            return _record(way, recipe, done, True, times)
        started = time.thread_time()
        try:
            push = plan_push(
                blocks, way.policy, pusher=SETTING.pusher, placement=SETTING.placement, seed=done, **way.options
            )
            times.append(time.thread_time() - started)
            blocks = simulate_push(blocks, push, PushPhysics.fine(), SETTING.pusher)
        except SingulationError:
            break
    return _record(way, recipe, limit, smallest_gap(blocks) > width, times)


def _record(way: Way, recipe: SceneRecipe, pushes: int, solved: bool, times: list[float]) -> dict[str, Any]:
    seconds = float(np.median(times)) if times else 0.0
    return {"way": way.name, "scene": recipe.key, "n": recipe.n, "pushes": pushes, "solved": solved, "seconds": seconds}


def separation_report(
    folder: Path, scenes: int, counts: Sequence[int], ways: Sequence[Way], first_seed: int = 8000
) -> str:
    """Markdown: for each way and number of blocks the mean pushes, the share solved, the time of a plan."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "separation.jsonl"
    known = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()] if path.exists() else []
    done = {(one["way"], one["scene"]) for one in known}
    with path.open("a", encoding="utf-8") as file:
        for number in range(scenes):
            if number % 5 == 0:
                print(f"scene {number + 1} of {scenes}", file=sys.stderr)
            for way in ways:
                for n in counts:
                    recipe = SceneRecipe(SETTING.generator, n, number % len(groups()), first_seed + number)
                    if (way.name, recipe.key) not in done:
                        known.append(pushes_needed(way, recipe))
                        file.write(json.dumps(known[-1]) + "\n")
                        file.flush()
    return table(["", *(f"n = {n}" for n in counts)], [_row(known, way, counts) for way in ways])


def _row(known: Sequence[Mapping[str, Any]], way: Way, counts: Sequence[int]) -> list[str]:
    cells = [way.name]
    for n in counts:
        mine = [one for one in known if one["way"] == way.name and one["n"] == n]
        if not mine:
            cells.append("-")
            continue
        pushes = np.array([one["pushes"] for one in mine], dtype=np.float64)
        error, solved = pushes.std() / np.sqrt(len(mine)), np.mean([one["solved"] for one in mine])
        milliseconds = 1e3 * np.median([one["seconds"] for one in mine])
        cells.append(
            f"{pushes.mean():.2f} ± {error:.2f}, {solved:.0%} of {len(mine)} solved, {milliseconds:.0f} ms a plan"
        )
    return cells
