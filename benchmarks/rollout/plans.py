"""Pushes that planners choose, stored so that a stopped run goes on where it was."""

import json
import sys
import time
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from benchmarks.rollout.planners import Planner
from singulation_core import ContactMode, Push, SingulationError
from singulation_planner import plan_push
from singulation_planner.benchmark.evaluate import SceneRecipe
from singulation_planner.benchmark.generators import groups
from singulation_planner.benchmark.scenario import Scenario
from singulation_planner.benchmark.settings import find_setting

SETTING = find_setting("clutter")
COUNTS = range(3, 16)


@dataclass(frozen=True, slots=True)
class Plan:
    """A planned push; without a start if the planner found none."""

    scene: str
    n: int
    planner: str
    seconds: float
    start: tuple[float, float] | None
    end: tuple[float, float] | None
    mode: int
    width: float
    gain: float

    @property
    def push(self) -> Push | None:
        """As the simulators take it."""
        if self.start is None or self.end is None:
            return None
        return Push(self.start, self.end, ContactMode(self.mode), self.width)  # type: ignore[arg-type]


def recipes(seeds: int, counts: Iterable[int] = COUNTS, first_seed: int = 7000) -> list[SceneRecipe]:
    """Scenes of all groups with ``seeds`` different seeds for each number of blocks."""
    return [
        SceneRecipe(SETTING.generator, n, group, first_seed + seed)
        for seed in range(seeds)
        for n in counts
        for group in groups()
    ]


def plan_one(planner: Planner, scenario: Scenario) -> Plan:
    """The planner's push and the processor time of this thread that it took."""
    arguments: dict[str, Any] = {"pusher": SETTING.pusher, "placement": SETTING.placement, **planner.options}
    started = time.thread_time()
    try:
        push = plan_push(scenario.arrangement, planner.policy, **arguments)
    except SingulationError:
        return Plan(scenario.key, scenario.n, planner.name, time.thread_time() - started, None, None, 0, 0.0, 0.0)
    seconds = time.thread_time() - started
    start, end = tuple(push.start.tolist()), tuple(push.end.tolist())
    mode, width = int(push.contact_mode), push.contact_width
    return Plan(scenario.key, scenario.n, planner.name, seconds, start, end, mode, width, push.expected_gain)


class PlanStore:
    """Plans in a file of JSON lines."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._known: dict[tuple[str, str], Plan] = {}
        if path.exists():
            for line in path.read_text(encoding="utf-8").splitlines():
                plan = Plan(**json.loads(line))
                self._known[plan.scene, plan.planner] = plan

    def complete(self, scenes: Sequence[SceneRecipe], planners: Sequence[Planner]) -> dict[tuple[str, str], Plan]:
        """Plans of all planners for all scenes, by scene and planner; what is missing is planned."""
        self._path.parent.mkdir(parents=True, exist_ok=True)
        with self._path.open("a", encoding="utf-8") as file:
            for number, recipe in enumerate(scenes):
                missing = [
                    one for one in planners if recipe.n <= one.largest and (recipe.key, one.name) not in self._known
                ]
                scenario = recipe.scene() if missing else None
                for planner in missing:
                    assert scenario is not None
                    plan = plan_one(planner, scenario)
                    self._known[recipe.key, planner.name] = plan
                    file.write(json.dumps(asdict(plan)) + "\n")
                file.flush()
                if missing and number % 40 == 0:
                    print(f"planned {number + 1} of {len(scenes)} scenes", file=sys.stderr)
        wanted = {(recipe.key, planner.name) for recipe in scenes for planner in planners}
        return {key: plan for key, plan in self._known.items() if key in wanted}
