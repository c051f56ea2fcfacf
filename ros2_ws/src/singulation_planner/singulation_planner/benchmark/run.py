"""Which scenes a run consists of, and running what is not known yet."""

import math
import random
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

from singulation_core import InvalidInputError, contact_mode
from singulation_planner.benchmark.engines import on_cores, on_dask
from singulation_planner.benchmark.evaluate import SceneRecipe, SceneTask, evaluate
from singulation_planner.benchmark.generators import UNIT, groups
from singulation_planner.benchmark.progress import Progress
from singulation_planner.benchmark.record import BEST_MODE, FITS, Job, Record
from singulation_planner.benchmark.scenario import Scenario, read_scenarios
from singulation_planner.benchmark.settings import Setting
from singulation_planner.benchmark.store import ResultStore
from singulation_planner.policies import find_policy

BRUTE_FORCE = "brute_force"


@dataclass(frozen=True, slots=True)
class Plan:
    """A run.

    Args:
        setting: conditions.
        policies: names.
        contact_modes: labels, or ``BEST_MODE``.
        fits: see ``Job``.
        scenarios: how many, spread evenly over numbers of objects and groups.
        brute_force_scenarios: how many of them Brute Force works on.
        counts: numbers of objects.
        first_seed: scenes have seeds from here on.
        file: scenes from a file instead of the generator.
    """

    setting: Setting
    policies: Sequence[str]
    contact_modes: Sequence[str] = ("single_point",)
    fits: Sequence[str] = ("contact_mode",)
    scenarios: int = 1040
    brute_force_scenarios: int = 520
    counts: Sequence[int] = tuple(range(3, 16))
    first_seed: int = 0
    file: Path | None = None

    def __post_init__(self) -> None:
        for name in self.policies:
            find_policy(name)
        for mode in self.contact_modes:
            if mode != BEST_MODE:
                contact_mode(mode)
        wrong = [one for one in self.fits if one not in FITS]
        if wrong or not (self.scenarios >= 1) or not self.counts or not (min(self.counts) >= 2):
            raise InvalidInputError(
                f"benchmark: fits {wrong}, {self.scenarios} scenarios of {list(self.counts)} objects; need fits of "
                f"{list(FITS)}, at least one scenario, at least two objects"
            )

    def tasks(self) -> list[SceneTask]:
        """One for each scene, seeds outermost, so that a run that stops early is balanced."""
        jobs = [Job(*one) for one in _product(self.policies, self.contact_modes, self.fits)]
        scenes = self._from_file() if self.file else self._generated()
        cells = max(len({(n, group) for n, group, _, _ in scenes}), 1)
        tasks = []
        for _, _, rank, source in scenes:
            allowed = rank < math.ceil(self.brute_force_scenarios / cells)
            tasks.append(SceneTask(self.setting, source, [job for job in jobs if allowed or job.policy != BRUTE_FORCE]))
        return tasks

    def _generated(self) -> list[tuple[int, int, int, SceneRecipe | Scenario]]:
        each = math.ceil(self.scenarios / (len(self.counts) * len(groups())))
        generator = self.setting.generator
        cells = [(n, group) for n in self.counts for group in groups()]
        order = random.Random(0)
        scenes: list[tuple[int, int, int, SceneRecipe | Scenario]] = []
        for rank in range(each):
            order.shuffle(cells)  # large and small scenes mixed, so that the time left can be told
            scenes += [(n, group, rank, SceneRecipe(generator, n, group, self.first_seed + rank)) for n, group in cells]
        return scenes

    def _from_file(self) -> list[tuple[int, int, int, SceneRecipe | Scenario]]:
        if self.file is None:
            return []
        ranks: dict[tuple[int, int], int] = {}
        scenes: list[tuple[int, int, int, SceneRecipe | Scenario]] = []
        for scenario, _ in read_scenarios(self.file, UNIT):
            cell = scenario.n, scenario.group
            if scenario.n in self.counts:
                ranks[cell] = ranks.get(cell, -1) + 1
                scenes.append((*cell, ranks[cell], scenario))
        return scenes[: self.scenarios]

    def about(self) -> dict[str, Any]:
        """What results depend on besides what each line says itself."""
        return {"setting": asdict(self.setting), "source": str(self.file.name) if self.file else "generated"}


def run(plan: Plan, out: Path, workers: int, dask: str | None = None) -> list[Record]:
    """Do what is missing of a plan; results of earlier runs in the folder are kept and counted.

    Args:
        plan: what to do.
        out: folder of the results.
        workers: processes, if not on a cluster.
        dask: address of a Dask scheduler, or None.

    Raises:
        SingulationError: as the store and the engines.
    """
    with ResultStore(out, plan.about()) as store:
        known = {record.key for record in store.records}
        todo = [rest for task in plan.tasks() if (rest := _unknown(task, known)).jobs]
        progress = Progress(len(todo))
        engine = partial(on_dask, dask) if dask else partial(on_cores, workers)
        for records in engine(evaluate, todo):
            store.add(records)
            progress.step()
        return store.records


def _unknown(task: SceneTask, known: set[tuple[str, str, str, str]]) -> SceneTask:
    key = task.source.key
    jobs = [job for job in task.jobs if (key, job.policy, job.contact_mode, job.fits) not in known]
    return SceneTask(task.setting, task.source, jobs)


def _product(policies: Iterable[str], modes: Sequence[str], fits: Sequence[str]) -> list[tuple[str, str, str]]:
    """All combinations that mean something: the best of three modes is chosen among modes that fit for themselves."""
    return [
        (policy, mode, fit)
        for policy in policies
        for mode in modes
        for fit in fits
        if mode != BEST_MODE or fit == "contact_mode"
    ]
