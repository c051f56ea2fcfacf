"""Loading the compiled kernels before they are needed."""

from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np

from singulation_core import Arrangement, CellGeometry, ContactMode, PlanarObject, Push
from singulation_core.push_world import PushPhysics, simulate_push
from singulation_planner.plan import plan_push
from singulation_planner.policies import POLICIES

_SQUARE = 0.02 * np.array(((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)))
_LARGEST = "rollout_push"  # it compiles as much as all others together
_LEFT_OUT = "brute_force"  # its kernels are those of the others, and its simulations would only take time


def warm_up() -> None:
    """Plan once with every policy and mode; compiles what is not in numba's cache yet (some seconds, once per machine).

    Brute Force is left out.
    """
    for step in STEPS:
        step()


def _others() -> None:
    _plan(name for name in POLICIES if name not in (_LARGEST, _LEFT_OUT))


def _simulate() -> None:
    push = Push(np.array((-0.1, -0.1)), np.array((-0.08, -0.08)), ContactMode.SINGLE_POINT)
    simulate_push(_three_squares(), push, replace(PushPhysics.quasi_static(), engine="compiled"))


def _roll_out() -> None:
    _plan([_LARGEST])


# In this order two processes that begin at different ends of it have about the same to compile.
STEPS: tuple[Callable[[], None], ...] = (_others, _simulate, _roll_out)


def _plan(policies: Iterable[str]) -> None:
    for policy in policies:
        for mode in ContactMode:
            plan_push(_three_squares(), policy, mode, workspace=CellGeometry().workspace_polygon)


def _three_squares() -> Arrangement:
    return Arrangement([PlanarObject(k, _SQUARE + 0.05 * k - 0.05) for k in range(3)])
