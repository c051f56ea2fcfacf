"""Pushes judged by what can be reached after them."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from singulation_core import SingulationError
from singulation_core.polygon import FloatArray
from singulation_planner.placer import make_placer
from singulation_planner.rollout.judge import Judge, Outcomes
from singulation_planner.rollout.objective import make_objective
from singulation_planner.rollout.options import Options
from singulation_planner.rollout.proposals import Proposals, by_score
from singulation_planner.rollout.search import Best, Search

NEXT = 24  # simulations for the push after a push


@dataclass(frozen=True, slots=True)
class LookAhead:
    """Values of pushes by the best that is found to follow them.

    Attributes:
        judge: of the scene.
        options: of the policy; ``look_ahead`` of them counts from this scene on.
        seed, deadline: of the search for the following pushes.
    """

    judge: Judge
    options: Options
    seed: int
    deadline: float

    @property
    def cost(self) -> int:
        """Simulations for one push."""
        return 1 + NEXT * (self.options.look_ahead - 1)

    def outcomes(self, proposals: Proposals) -> Outcomes:
        """As the judge's, but with the values after the pushes that follow."""
        found = self.judge.outcomes(proposals)
        values = found.values.copy()
        for k in np.flatnonzero(np.isfinite(values)).tolist():
            best = self._next(found.poses[k])
            if best is not None:
                values[k] = best.value + (found.changes[k] if self.judge.objective.weights[1] == 0.0 else 0.0)
        return Outcomes(values, found.changes, found.poses)

    def _next(self, poses: FloatArray) -> Best | None:
        placer = self.judge.placer
        try:
            scene = placer.scene.after(poses)
        except SingulationError:  # pushed into an overlap that no scene may have
            return None
        options = replace(self.options, look_ahead=self.options.look_ahead - 1)
        following = make_placer(scene, placer.mode, placer.travel, placer.geometry, placer.placement, placer.walls)
        objective = replace(make_objective(scene, options), width=self.judge.objective.width)
        judge = Judge(following, objective, self.judge.physics, scene.in_order())
        ranked = by_score(following, objective)
        random = partial(np.random.default_rng, self.seed)
        search = Search(following, judge, NEXT, random, self.deadline)
        if options.look_ahead > 1:
            ahead = LookAhead(judge, options, self.seed, self.deadline)
            search = replace(search, limit=self.cost, final=ahead.outcomes, final_cost=ahead.cost)
        return search.run(ranked) if len(ranked) else None
