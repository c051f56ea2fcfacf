"""What is compared: policies with their options."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from singulation_core.push_world import PushPhysics
from singulation_planner.benchmark.generators import UNIT
from singulation_planner.placement import Placement

_NO_LIMIT = 10**9
_WIDE = 0.05  # clearance of the start that allows for noise [bounding radii]; else a sixth of the tip radius, 0.017


@dataclass(frozen=True, eq=False, slots=True)
class Planner:
    """A policy with options.

    Args:
        name: under which its pushes are stored.
        text: in tables.
        policy: of ``plan_push``.
        options: keyword arguments of ``plan_push``.
        largest: number of blocks beyond which it is not asked.
    """

    name: str
    text: str
    policy: str
    options: Mapping[str, Any] = field(default_factory=dict)
    largest: int = 15


def _rollout(milliseconds: float, **options: Any) -> Planner:
    name = "_".join([f"rollout_{milliseconds:g}ms", *(f"{key}{value}" for key, value in options.items())])
    text = f"Rollout Push, {milliseconds:g} ms" if milliseconds else "Rollout Push, score alone"
    text += "".join(f", {key} {value}" for key, value in options.items())
    given = {"budget": milliseconds, "rollouts": _NO_LIMIT, **options}
    return Planner(name, text, "rollout_push", given)


def _worked(rollouts: int, **options: Any) -> Planner:
    """With a limit that does not depend on the speed of the machine."""
    name = "_".join([f"rollout_{rollouts}", *(f"{key}{value}" for key, value in options.items())])
    text = f"Rollout Push, {rollouts} simulations" + "".join(f", {key} {value}" for key, value in options.items())
    return Planner(name, text, "rollout_push", {"budget": 1e6, "rollouts": rollouts, **options})


def _at_a_distance(planner: Planner) -> Planner:
    """The same with starts that keep the wider clearance."""
    options = {**planner.options, "placement": Placement(clearance=_WIDE * UNIT)}
    text = f"{planner.text}, start clearance {_WIDE:g}"
    return replace(planner, name=f"{planner.name}_clearance{_WIDE:g}", text=text, options=options)


BRUTE_FORCE = Planner("brute_force", "Brute Force", "brute_force")
FAST_BRUTE_FORCE = Planner(
    "brute_force_compiled", "Brute Force in the compiled simulator", "brute_force", {"physics": PushPhysics.fast()}
)
BUDGETS: Sequence[float] = (0.0, 0.1, 1.0, 3.0, 5.0, 10.0, 30.0, 100.0)
LONG_BUDGETS: Sequence[float] = (1000.0, 10000.0)
WORKED: Sequence[Planner] = tuple(_worked(count) for count in (8, 32, 96, 160, 400))
NOMINAL: Sequence[Planner] = (
    Planner("cluster_push", "ClusterPush", "cluster_push"),
    Planner("min_overlap", "Minimum Overlap", "min_overlap"),
    BRUTE_FORCE,
    FAST_BRUTE_FORCE,
    *(_rollout(budget) for budget in BUDGETS),
    *WORKED,
)
LONG: Sequence[Planner] = (BRUTE_FORCE, FAST_BRUTE_FORCE, *(_rollout(budget) for budget in LONG_BUDGETS))
MODES: Sequence[Planner] = (
    BRUTE_FORCE,
    FAST_BRUTE_FORCE,
    _worked(160),
    _worked(480, best_contact_mode=True),
    _rollout(30.0, best_contact_mode=True),
)
ROBUST: Sequence[Planner] = (
    Planner("cluster_push", "ClusterPush", "cluster_push"),
    BRUTE_FORCE,
    FAST_BRUTE_FORCE,
    _rollout(0.0),
    _rollout(10.0),
    _worked(160),
    _worked(64 + 16 * 16 + 17, worlds=16),
    _rollout(26.0, worlds=16),
    *map(_at_a_distance, (FAST_BRUTE_FORCE, _rollout(10.0), _worked(160))),
    _rollout(100.0, worlds=64),
)
