"""What one worker does: plan and simulate the pushes of one scene."""

import time
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, replace

from singulation_core import Push, SingulationError, singulation_distance
from singulation_core.push_world import PushPhysics, simulate_push
from singulation_planner.benchmark.generators import generate
from singulation_planner.benchmark.record import BEST_MODE, Job, Record
from singulation_planner.benchmark.scenario import Scenario
from singulation_planner.benchmark.settings import Setting
from singulation_planner.plan import plan_push


@dataclass(frozen=True, slots=True)
class SceneRecipe:
    """How to make a scene again: cheaper to send to a worker than the scene."""

    generator: str
    n: int
    group: int
    seed: int

    @property
    def key(self) -> str:
        """Name of the scene it makes."""
        return f"{self.generator}-n{self.n:02d}-g{self.group}-s{self.seed}"

    def scene(self) -> Scenario:
        """The scene."""
        return generate(self.generator, self.n, self.group, self.seed)


@dataclass(frozen=True, eq=False)
class SceneTask:
    """All jobs for one scene, given as a recipe or, if it comes from a file, itself."""

    setting: Setting
    source: SceneRecipe | Scenario
    jobs: Sequence[Job]


def evaluate(task: SceneTask) -> list[Record]:
    """Results of all jobs of a scene. No job can end the run: its error becomes its result."""
    scenario = task.source.scene() if isinstance(task.source, SceneRecipe) else task.source
    return [_result(task.setting, scenario, job) for job in task.jobs]


def _result(setting: Setting, scenario: Scenario, job: Job) -> Record:
    before = singulation_distance(scenario.arrangement, scenario.unit)
    after = judged = before
    code, text, simulating = "OK", "", 0.0
    started = planned = time.thread_time()
    try:
        push = plan(setting, scenario, job)
        planned = time.thread_time()
        outcome = _spread_after(setting, scenario, push, setting.physics)
        simulating = time.thread_time() - planned
        judged = outcome if setting.judge is None else _spread_after(setting, scenario, push, setting.judge)
        after = outcome
    except SingulationError as error:
        code, text = error.code.name, error.message
        planned = max(planned, time.thread_time() - simulating)
    except Exception as error:
        code, text = "INTERNAL", f"{type(error).__name__}: {error}"
    return Record(
        scenario.key,
        scenario.n,
        scenario.group,
        scenario.seed,
        job.policy,
        job.contact_mode,
        job.fits,
        code,
        scenario.unit,
        before,
        after,
        judged,
        planned - started,
        simulating,
        text,
    )


def plan(setting: Setting, scenario: Scenario, job: Job) -> Push:
    """The push that the job's policy plans for the scene.

    Raises:
        SingulationError: as ``plan_push``.
    """
    best, placement = job.contact_mode == BEST_MODE, setting.placement
    if placement.fits != job.fits:
        placement = replace(placement, fits=job.fits)  # type: ignore[arg-type]
    return plan_push(
        scenario.arrangement,
        job.policy,
        "single_point" if best else job.contact_mode,
        push_distance=setting.push_distance,
        pusher=setting.pusher,
        seed=zlib.crc32(scenario.key.encode()),  # not the scene's own, which other scenes share
        placement=placement,
        best_contact_mode=best,
        physics=setting.physics,
        **setting.options.get(job.policy, {}),
    )


def _spread_after(setting: Setting, scenario: Scenario, push: Push, physics: PushPhysics) -> float:
    moved = simulate_push(scenario.arrangement, push, physics, setting.pusher)
    return singulation_distance(moved, scenario.unit)
