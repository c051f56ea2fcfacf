"""Rollout Push, our own: pushes scored by geometry, the best few simulated, the best of those refined.

Nothing like it is in the paper. Cheap scores choose among all objects, directions and lines; a fast simulator of pushes
(``push_world.compiled``) then finds out what the best of them would really do. The search is anytime: more simulations
never give a worse expected result.
"""

import math
import time
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from singulation_core.push_world import PushPhysics
from singulation_planner.candidates import Candidates
from singulation_planner.policy import Task, policy
from singulation_planner.rollout.judge import Judge
from singulation_planner.rollout.look_ahead import LookAhead
from singulation_planner.rollout.objective import make_objective
from singulation_planner.rollout.options import Options
from singulation_planner.rollout.proposals import by_score
from singulation_planner.rollout.search import Search
from singulation_planner.rollouts import relative_gain


@policy(Options)
def rank(task: Task, options: Options) -> Iterator[Candidates]:
    """The best push found within the budget, then all others by score."""
    deadline = time.thread_time() + 1e-3 * options.budget * task.share
    objective = make_objective(task.scene, options)
    ranked = by_score(task.placer, objective)
    if options.budget > 0.0 and len(ranked):
        ordered = task.scene.in_order()
        judge = Judge(task.placer, objective, _fast(task.physics), ordered, options.worlds, task.seed)
        limit = math.ceil(options.rollouts * task.share)
        search = Search(task.placer, judge, limit, task.random, deadline)
        if options.worlds > 1:
            search = replace(search, final=judge.in_all_worlds, final_cost=options.worlds)
        elif options.look_ahead > 1:
            ahead = LookAhead(judge, options, task.seed, deadline)
            search = replace(search, final=ahead.outcomes, final_cost=ahead.cost)
        best = search.run(ranked)
        if best is not None:
            poses = best.poses[np.newaxis]
            if np.isnan(poses).any():  # judged in other worlds; what is expected is told for the one seen
                poses = judge.outcomes(best.proposal).poses
            gain, value = np.array([relative_gain(best.change, ordered)]), np.array([best.value])
            yield best.proposal.candidates._replace(gains=gain, values=value, poses=poses)
    yield ranked.candidates


def _fast(physics: PushPhysics | None) -> PushPhysics:
    """The numbers of the fast preset with the friction and densities of ``physics``."""
    if physics is None:
        return PushPhysics.fast()
    given = {name: getattr(physics, name) for name in ("friction", "density", "density_spread", "seed")}
    return replace(PushPhysics.fast(), **given)
