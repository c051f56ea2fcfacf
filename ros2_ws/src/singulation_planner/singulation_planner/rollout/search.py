"""The search: a fixed sequence of simulations, cut off where budget or work limit end it, and the best so far."""

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_planner.placer import Placer
from singulation_planner.rollout.judge import Judge, Outcomes
from singulation_planner.rollout.proposals import Proposals, variations

_SCREENED, _REFINED = 24, 16  # simulated in turn: the next ones by score, variations of the best
_SCREENED_FIRST = 64  # where the best of them are judged again: before that
_BATCH, _BLOCKS = 8, 96  # simulations between two looks at the clock: at least, and times the number of blocks
_REFINEMENTS = 4  # portions of the variations
_NARROWER = 0.7  # shrinks the variations from batch to batch
_FINALISTS = 16  # of those screened so far, judged again


@dataclass(frozen=True, slots=True)
class Best:
    """A push with its value, the change of s [1] and the poses (n, 3) that it is expected to lead to."""

    proposal: Proposals
    value: float
    change: float
    poses: FloatArray


@dataclass(slots=True)
class Search:
    """See the module.

    Attributes:
        placer, judge: of the scene.
        limit: number of simulations.
        random: makes the generator for the variations; a short search needs none.
        deadline: processor time of this thread [s].
        final: a more careful way to judge the best pushes; the answer is then the best of those. None: the judge's.
        final_cost: simulations that this takes for one push.
    """

    placer: Placer
    judge: Judge
    limit: int
    random: Callable[[], np.random.Generator]
    deadline: float
    final: Callable[[Proposals], Outcomes] | None = None
    final_cost: int = 1
    done: int = 0
    best: Best | None = None
    nominal: Best | None = None
    screened: list[tuple[float, int, Proposals]] = field(default_factory=list)

    def run(self, ranked: Proposals) -> Best | None:
        """Work through the sequence; None if nothing could be simulated."""
        sequence = self._sequence(ranked) if self.final is None else self._sequence_with_finals(ranked)
        for batch, attempt, cost in sequence:
            left = (self.limit - self.done) // cost
            if left <= 0 or (self.done > 0 and time.thread_time() >= self.deadline):
                break
            tried = batch.part(slice(left))
            self.done += cost * len(tried)
            if len(tried):
                attempt(tried)
        return self.best or self.nominal

    def _sequence(self, ranked: Proposals) -> Iterator[tuple[Proposals, Callable[[Proposals], None], int]]:
        """What would be tried without any limit: depends on what was found before, but not on the limits."""
        random = None
        yield ranked.part(slice(1)), self._screen, 1
        for at in range(1, len(ranked), _SCREENED):
            for batch in self._batches(ranked.part(slice(at, at + _SCREENED))):
                yield batch, self._screen, 1
            for step in range(_REFINEMENTS):
                if self.nominal is not None:
                    around, count = self.nominal.proposal.candidates, _REFINED // _REFINEMENTS
                    random = random or self.random()
                    yield variations(self.placer, around, _NARROWER**step, count, random), self._screen, 1

    def _sequence_with_finals(self, ranked: Proposals) -> Iterator[tuple[Proposals, Callable[[Proposals], None], int]]:
        """The same where the best of those screened are judged again."""
        yield ranked.part(slice(1)), self._screen, 1
        yield ranked.part(slice(1)), self._judge, self.final_cost
        for at in range(1, len(ranked), _SCREENED_FIRST):
            for batch in self._batches(ranked.part(slice(at, at + _SCREENED_FIRST))):
                yield batch, self._screen, 1
            self.screened.sort(key=lambda one: one[:2])
            finalists, self.screened = self.screened[:_FINALISTS], self.screened[_FINALISTS:]
            for _, _, proposal in finalists:
                yield proposal, self._judge, self.final_cost

    def _batches(self, proposals: Proposals) -> Iterator[Proposals]:
        size = max(_BATCH, _BLOCKS // len(self.placer.scene))
        for begin in range(0, len(proposals), size):
            yield proposals.part(slice(begin, begin + size))

    def _screen(self, tried: Proposals) -> None:
        outcomes = self.judge.outcomes(tried)
        self._look_again(tried, outcomes)
        if self.final is not None:
            for k, value in enumerate(_comparable(outcomes.values).tolist()):
                if np.isfinite(value):
                    self.screened.append((-value, self.done + k, tried.part(slice(k, k + 1))))

    def _look_again(self, tried: Proposals, outcomes: Outcomes) -> None:
        """Take those for better than the best so far that are so at a second look too, best first."""
        values = _comparable(outcomes.values)
        for k in np.argsort(-values, kind="stable").tolist():
            best = -np.inf if self.nominal is None else self.nominal.value
            if not values[k] > best:
                return
            one = slice(k, k + 1)
            first = Outcomes(outcomes.values[one], outcomes.changes[one], outcomes.poses[one])
            self.nominal = _better(self.nominal, tried.part(one), self.judge.least(tried.part(one), first, best))

    def _judge(self, tried: Proposals) -> None:
        if self.final is not None:
            self.best = _better(self.best, tried, self.final(tried))


def _comparable(values: FloatArray) -> FloatArray:
    """Rounded, so that equal values are equal whatever their rounding errors; failures last."""
    return np.asarray(np.round(np.where(np.isnan(values), -np.inf, values), 9))


def _better(best: Best | None, tried: Proposals, outcomes: Outcomes) -> Best | None:
    """The best of what was known and what was tried."""
    values = _comparable(outcomes.values)
    k = int(np.argmax(values))
    if not np.isfinite(values[k]) or (best is not None and values[k] <= best.value):
        return best
    return Best(tried.part(slice(k, k + 1)), float(values[k]), float(outcomes.changes[k]), outcomes.poses[k])
