"""Push policies: ClusterPush, the other policies of the paper, and our own.

Importing the package is cheap; the compiled kernels are loaded with the first name that needs them.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from singulation_planner.placement import Placement as Placement
    from singulation_planner.plan import plan_push as plan_push
    from singulation_planner.policies import POLICIES as POLICIES
    from singulation_planner.warming import warm_up as warm_up

__all__ = ["POLICIES", "Placement", "plan_push", "warm_up"]

_HOMES = {"POLICIES": "policies", "Placement": "placement", "plan_push": "plan", "warm_up": "warming"}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)
