"""What keeps a structured-light camera from measuring every pixel exactly."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatImage = NDArray[np.float32]  # (H, W)
Mask = NDArray[np.bool_]  # (H, W)

_STEP = 0.003  # m; neighbours that differ more in distance lie on both sides of an edge


@dataclass(frozen=True, slots=True)
class SensorDefects:
    """Noise and losses. The noise is measured on the lab's PhoXi; the behaviour at edges is an assumption.

    Args:
        noise: standard deviation along the ray [m].
        edge_loss: share of the pixels at depth edges that are lost.
        flying: share of the pixels at depth edges that lie between both sides.
        random_loss: share of all pixels that are lost.
        grazing: surfaces seen under a smaller cosine of incidence are lost.
        shadows: whether points that the projector does not light are lost.
    """

    noise: float = 2e-4
    edge_loss: float = 0.5
    flying: float = 0.03
    random_loss: float = 0.003
    grazing: float = 0.2
    shadows: bool = True

    @classmethod
    def none(cls) -> "SensorDefects":
        """A perfect sensor: every point that is seen, where it is."""
        return cls(0.0, 0.0, 0.0, 0.0, 0.0, shadows=False)


def add_defects(
    distance: FloatImage, cosine: FloatImage, lit: Mask, defects: SensorDefects, rng: np.random.Generator
) -> FloatImage:
    """(H, W) measured distances along the rays [m]; 0 where nothing is measured.

    Args:
        distance: true ones, infinite where nothing is seen.
        cosine: of the angle of incidence.
        lit: what the projector reaches.
        defects: how much of what.
        rng: consumed alike for every scene, so that a pixel's noise does not depend on what else is seen.
    """
    measured = distance.copy()
    chance = rng.random(distance.shape, dtype=np.float32)
    noise = rng.standard_normal(distance.shape, dtype=np.float32)
    near, far = _edges(distance)
    edge = far > near + np.float32(_STEP)
    flies = edge & np.isfinite(far) & (chance >= 1.0 - defects.flying)
    where = rng.random(distance.shape, dtype=np.float32)[flies]
    measured[flies] = near[flies] + (far[flies] - near[flies]) * where
    lost = ~np.isfinite(measured) | (chance < np.where(edge, defects.edge_loss, defects.random_loss))
    lost |= (cosine < defects.grazing) | (~lit & defects.shadows)
    measured += np.float32(defects.noise) * noise
    measured[lost] = 0.0
    return measured


def _edges(distance: FloatImage) -> tuple[FloatImage, FloatImage]:
    """Smallest and largest distance among each pixel and its four neighbours."""
    near, far = distance.copy(), distance.copy()
    for axis in (0, 1):
        first = (slice(None, -1), slice(None))[:: 1 if axis == 0 else -1]
        second = (slice(1, None), slice(None))[:: 1 if axis == 0 else -1]
        for here, there in ((first, second), (second, first)):
            np.minimum(near[here], distance[there], out=near[here])
            np.maximum(far[here], distance[there], out=far[here])
    return near, far
