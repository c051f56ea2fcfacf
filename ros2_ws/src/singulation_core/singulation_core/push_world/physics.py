"""What a simulated push depends on besides shapes and motion."""

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from singulation_core.errors import InvalidInputError

ENGINES = ("pymunk", "compiled")
HEALED = 0.8  # share of an overlap that a step of settling takes away
TOUCHING = 0.01  # overlap of pusher and block that still counts as touching [mean bounding radii]


@dataclass(frozen=True, slots=True)
class PushPhysics:
    """Physical and numerical settings; lengths in mean bounding radii, so that nothing depends on scale.

    Table friction. With ``velocity_kept = 0`` every step starts at rest: blocks stop when nothing pushes them, which is
    the quasi-static model of the paper (section III-A) with an ellipsoidal limit surface whose characteristic length is
    the radius of gyration. With ``velocity_kept > 0`` blocks coast as in the authors' simulator. Friction on pivots and
    gears (a box limit surface) is not offered: off-centre pushes hardly rotate there and gains come out 20 % too large.

    Args:
        engine: ``pymunk``, the reference, or ``compiled``, six times faster and quasi-static only. ``PushWorld`` is
            always pymunk's.
        friction: coefficient of every contact between blocks and with the pusher.
        density: of every block [kg/m^2]; the paths depend on it only where it differs between blocks.
        density_spread: standard deviation of a block's density as a share of ``density``, drawn by ``seed``.
        seed: of everything random; the same seed gives the same result.
        step: largest advance of the pusher per step. It is shortened where pusher or blocks are thin.
        iterations: of the contact solver in each step.
        velocity_kept: share of a block's velocity that survives a step.
        seconds_per_step: only matters when velocity is kept.
        settle_steps: after the pusher stopped, in which overlaps of the last steps heal; none if velocity is kept.
        total_steps: steps of one push, the pusher's own included; the rest of them is coasting.
        slop: overlap that is left alone.
        overlap_correction: share of a deeper overlap that is taken away per step.

    Raises:
        InvalidInputError: naming the field, its value and its range.
    """

    engine: Literal["pymunk", "compiled"] = "pymunk"
    friction: float = 0.5
    density: float = 1.0
    density_spread: float = 0.0
    seed: int = 0
    step: float = 0.05
    iterations: int = 10
    velocity_kept: float = 0.0
    seconds_per_step: float = 1.0
    settle_steps: int = 4
    total_steps: int = 0
    slop: float = 0.002
    overlap_correction: float = 0.3

    def __post_init__(self) -> None:
        if self.engine not in ENGINES:
            raise InvalidInputError(f"physics: engine {self.engine!r}, need one of: {', '.join(ENGINES)}")
        if self.engine == "compiled" and self.velocity_kept > 0.0:
            raise InvalidInputError(
                f"physics: velocity_kept {self.velocity_kept} with the compiled engine, need 0 (or pymunk)"
            )
        _check("friction", self.friction, 0.0, 10.0)
        _check("density", self.density, 1e-9, 1e9)
        _check("density_spread", self.density_spread, 0.0, 0.5)
        _check("seed", self.seed, 0, 2**63 - 1)
        _check("step", self.step, 1e-4, 0.5)
        _check("iterations", self.iterations, 1, 1000)
        _check("velocity_kept", self.velocity_kept, 0.0, 0.999)
        _check("seconds_per_step", self.seconds_per_step, 1e-6, 10.0)
        _check("settle_steps", self.settle_steps, 0, 1000)
        _check("total_steps", self.total_steps, 0, 1_000_000)
        _check("slop", self.slop, 0.0, 0.1)
        _check("overlap_correction", self.overlap_correction, 0.0, 0.99)

    @classmethod
    def quasi_static(cls) -> "PushPhysics":
        """The default: accurate enough to rank pushes and quick enough for brute force."""
        return cls()

    @classmethod
    def fine(cls) -> "PushPhysics":
        """To judge plans that were made with a coarser preset."""
        return cls(step=0.02, iterations=30)

    @classmethod
    def fast(cls) -> "PushPhysics":
        """For planners that simulate many pushes: the compiled engine, about 0.03 ms a push."""
        return cls(engine="compiled", step=0.1, settle_steps=2)

    @classmethod
    def authors(cls) -> "PushPhysics":
        """The simulator behind the paper's tables (their published code; facts, not code, were taken from it).

        Velocity times 5/6 before each step of 0.1 s, pusher at one bounding radius per second, 100 steps a push: blocks
        coast after the pusher stops. Give ``unit`` = one nominal bounding radius where this preset is used.
        """
        return cls(step=0.1, velocity_kept=5.0 / 6.0, seconds_per_step=0.1, total_steps=100)

    @classmethod
    def named(cls, name: str) -> "PushPhysics":
        """A preset by its name.

        Raises:
            InvalidInputError: listing the names there are.
        """
        presets = {
            "quasi_static": cls.quasi_static,
            "fine": cls.fine,
            "fast": cls.fast,
            "authors": cls.authors,
        }
        if name not in presets:
            raise InvalidInputError(f"physics: no preset {name!r}; one of: {', '.join(presets)}")
        return presets[name]()

    def sampled(self, seed: int) -> "PushPhysics":
        """The same with friction drawn from N(0.5, 0.1) and density from N(1.0, 0.2), as in the paper."""
        random = np.random.default_rng(seed)
        friction = float(np.clip(random.normal(0.5, 0.1), 0.05, 1.5))
        density = float(np.clip(random.normal(1.0, 0.2), 0.1, 3.0))
        return replace(self, friction=friction, density=density, seed=seed)

    def densities(self, count: int) -> list[float]:
        """Density of each of ``count`` blocks [kg/m^2]."""
        if self.density_spread == 0.0:
            return [self.density] * count
        factors = np.random.default_rng(self.seed).normal(1.0, self.density_spread, count)
        return [float(self.density * factor) for factor in np.clip(factors, 0.1, 3.0)]


def _check(name: str, value: float, low: float, high: float) -> None:
    if not (math.isfinite(value) and low <= value <= high):
        raise InvalidInputError(f"physics: {name} {value}, need {low} to {high}")
