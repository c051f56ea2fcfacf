"""Random scenes of blocks, seeded."""

from singulation_sim.scenes.scene import SCENES, random_scene

__all__ = ["SCENES", "random_scene"]
