"""Pictures of segmented scenes."""

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

from singulation_core import Arrangement
from singulation_core.transforms import transform_points
from singulation_perception import Segmentation

_COLOURS = plt.get_cmap("tab20")


def draw_table(axes: Any, points: NDArray[np.float32], seen: Segmentation, truth: Arrangement | None = None) -> None:
    """Points of the objects from above with their outlines; the truth dashed.

    Args:
        axes: of matplotlib.
        points: the cloud, camera frame [m].
        seen: its segmentation.
        truth: what there really is.
    """
    chosen = np.flatnonzero(seen.labels.ravel() >= 0)
    chosen = chosen[:: max(1, len(chosen) // 40_000)]
    located = transform_points(seen.table.table_from_camera, points.reshape(-1, 3)[chosen].astype(np.float64))
    colours = _COLOURS(seen.labels.ravel()[chosen] % 20)
    axes.scatter(1e3 * located[:, 0], 1e3 * located[:, 1], s=0.3, c=colours, linewidths=0, alpha=0.5)
    for item in seen.arrangement.objects:
        ring = 1e3 * np.vstack((item.outline, item.outline[:1]))
        axes.plot(ring[:, 0], ring[:, 1], color="black", linewidth=1.2)
        axes.plot(ring[:-1, 0], ring[:-1, 1], ".", color="black", markersize=3)
        text = f"{1e3 * item.height:.0f}" + ("" if item.confidence > 0.9 else f" ({item.confidence:.1f})")
        axes.annotate(text, 1e3 * item.centroid, ha="center", va="center", fontsize=6)
    for block in truth.objects if truth is not None else ():
        ring = 1e3 * np.vstack((block.outline, block.outline[:1]))
        axes.plot(ring[:, 0], ring[:, 1], "--", color="red", linewidth=0.6)
    axes.set_aspect("equal")
    axes.set_xlabel("x [mm]")
    axes.set_ylabel("y [mm]")


def draw_image(axes: Any, labels: NDArray[np.int32], background: NDArray[Any]) -> None:
    """Labels over a picture of the scene, (H, W) grey or (H, W, 3) colour."""
    axes.imshow(background, cmap="gray")
    painted = _COLOURS(labels % 20)
    painted[..., 3] = np.where(labels >= 0, 0.7, 0.0)
    axes.imshow(painted, interpolation="nearest")
    axes.set_axis_off()


def save(figure: Any, path: Path) -> None:
    """Writes a figure and closes it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=130, bbox_inches="tight")
    plt.close(figure)
