"""Pushes that planners choose, stored so that a stopped run goes on where it was."""

import json
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
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
Judge = Callable[[Scenario, Push], float]


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


class Store:
    """Plans, and what judges say of them, in two files of JSON lines."""

    def __init__(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self._plans_path, self._gains_path = folder / "plans.jsonl", folder / "gains.jsonl"
        self.plans = {(one.scene, one.planner): one for one in (Plan(**line) for line in _lines(self._plans_path))}
        self.gains = {(one["scene"], one["planner"], one["judge"]): one["gain"] for one in _lines(self._gains_path)}

    def complete(self, scenes: Sequence[SceneRecipe], planners: Sequence[Planner], judges: Mapping[str, Judge]) -> None:
        """Plan and judge whatever is missing."""
        for number, recipe in enumerate(scenes):
            asked = [one for one in planners if recipe.n <= one.largest]
            if all((recipe.key, one.name, judge) in self.gains for one in asked for judge in judges):
                continue
            scenario = recipe.scene()
            for planner in asked:
                plan = self._planned(planner, scenario)
                for name, judge in judges.items():
                    self._judged(plan, scenario, name, judge)
            if number % 50 == 0:
                print(f"scene {number + 1} of {len(scenes)}", file=sys.stderr)

    def _planned(self, planner: Planner, scenario: Scenario) -> Plan:
        key = scenario.key, planner.name
        if key not in self.plans:
            self.plans[key] = plan_one(planner, scenario)
            _append(self._plans_path, asdict(self.plans[key]))
        return self.plans[key]

    def _judged(self, plan: Plan, scenario: Scenario, name: str, judge: Judge) -> None:
        key = plan.scene, plan.planner, name
        if key not in self.gains:
            self.gains[key] = 0.0 if plan.push is None else judge(scenario, plan.push)
            gain = self.gains[key]
            _append(self._gains_path, {"scene": plan.scene, "planner": plan.planner, "judge": name, "gain": gain})


def _lines(path: Path) -> Iterator[dict[str, Any]]:
    if path.exists():
        for line in path.read_text(encoding="utf-8").splitlines():
            try:
                yield json.loads(line)
            except ValueError:  # the run was stopped while it wrote this one
                continue


def _append(path: Path, record: dict[str, Any]) -> None:
    with path.open("a", encoding="utf-8") as file:
        file.write(json.dumps(record) + "\n")
