"""Physics of pushing blocks on a table.

One push of an arrangement: ``simulate_push``; many pushes of the same arrangement: ``simulate_pushes``; a table that
lives on while jaws move over it: ``PushWorld``. ``PushPhysics.engine`` chooses between pymunk and a compiled solver; a
planner that has its pushes as arrays uses the latter directly: ``push_world.compiled.CompiledWorld``.
"""

from singulation_core.push_world.footprint import Disc, Footprint, pusher_footprint
from singulation_core.push_world.physics import PushPhysics
from singulation_core.push_world.simulate import PushOutcomes, simulate_push, simulate_pushes
from singulation_core.push_world.world import PushWorld

__all__ = [
    "Disc",
    "Footprint",
    "PushOutcomes",
    "PushPhysics",
    "PushWorld",
    "pusher_footprint",
    "simulate_push",
    "simulate_pushes",
]
