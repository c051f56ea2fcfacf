"""The search: a fixed sequence of simulations, cut off where budget or work limit end it, and the best so far."""

import time
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_planner.candidates import Candidates
from singulation_planner.placer import Placer
from singulation_planner.rollout.judge import Judge, Outcomes
from singulation_planner.rollout.proposals import Proposals, variations

_BATCH = 8  # simulations between two looks at the clock
_SCREENED, _REFINED = 64, 32  # simulated in turn: the next ones by score, variations of the best
_NARROWER = 0.7  # shrinks the variations from batch to batch


@dataclass(frozen=True, slots=True)
class Best:
    """A push with its value, the change of s [1] and the poses (n, 3) that it is expected to lead to."""

    candidate: Candidates
    value: float
    change: float
    poses: FloatArray


@dataclass(slots=True)
class Search:
    """See the module. Ends after ``limit`` simulations or at ``deadline`` (processor time of this thread [s])."""

    placer: Placer
    judge: Judge
    limit: int
    random: np.random.Generator
    deadline: float
    done: int = 0
    best: Best | None = None

    def run(self, ranked: Proposals) -> Best | None:
        """Work through the sequence; None if nothing could be simulated."""
        for batch in self._sequence(ranked):
            left = self.limit - self.done
            if left <= 0 or time.thread_time() >= self.deadline:
                break
            self._try(batch.part(slice(left)))
        return self.best

    def _sequence(self, ranked: Proposals) -> Iterator[Proposals]:
        """What would be tried without any limit: does not depend on the limits, only on what was found before."""
        at = 0
        while at < len(ranked):
            until = min(at + _SCREENED, len(ranked))
            for begin in range(at, until, _BATCH):
                yield ranked.part(slice(begin, min(begin + _BATCH, until)))
            at = until
            for step in range(_REFINED // _BATCH):
                if self.best is not None:
                    width = _NARROWER**step
                    yield variations(self.placer, self.best.candidate, width, _BATCH, self.random)

    def _try(self, batch: Proposals) -> None:
        self.done += len(batch)
        if len(batch):
            outcomes = self.judge.outcomes(batch)
            self._keep_best(batch.candidates, outcomes)

    def _keep_best(self, tried: Candidates, outcomes: Outcomes) -> None:
        values = np.round(np.nan_to_num(outcomes.values, nan=-np.inf), 9)
        k = int(np.argmax(values))
        if np.isfinite(values[k]) and (self.best is None or values[k] > self.best.value):
            candidate = Candidates(tried.objects[[k]], tried.directions[[k]], tried.offsets[[k]])
            self.best = Best(candidate, float(values[k]), float(outcomes.changes[k]), outcomes.poses[k])
