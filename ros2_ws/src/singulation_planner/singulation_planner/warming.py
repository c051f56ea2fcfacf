"""Loading the compiled kernels before they are needed."""

import numpy as np

from singulation_core import Arrangement, CellGeometry, ContactMode, PlanarObject
from singulation_planner.plan import plan_push
from singulation_planner.policies import POLICIES

_SQUARE = 0.02 * np.array(((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)))


def warm_up() -> None:
    """Plan once with every policy and mode; compiles what is not in numba's cache yet (some seconds, once per machine).

    Brute Force is left out: its kernels are those of the others, and its simulations would only take time.
    """
    arrangement = Arrangement([PlanarObject(k, _SQUARE + 0.05 * k - 0.05) for k in range(3)])
    for policy in POLICIES.keys() - {"brute_force"}:
        for mode in ContactMode:
            plan_push(arrangement, policy, mode, workspace=CellGeometry().workspace_polygon)
