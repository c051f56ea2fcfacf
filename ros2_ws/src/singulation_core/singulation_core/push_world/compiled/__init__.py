"""A lean quasi-static simulator of pushes, compiled, for planners that simulate many.

The same model as pymunk's (every step starts at rest, contacts with Coulomb friction, least kinetic energy), with what
a planner needs and no more: blocks that nothing touches are not looked at, free ways of the pusher are jumped over, and
contacts act just before blocks touch, which allows large steps.
"""

from singulation_core.push_world.compiled.engine import CompiledWorld
from singulation_core.push_world.compiled.rollout import BLOCKED, DIVERGED, DONE

__all__ = ["BLOCKED", "DIVERGED", "DONE", "CompiledWorld"]
