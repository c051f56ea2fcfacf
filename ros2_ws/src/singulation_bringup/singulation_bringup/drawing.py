"""Pictures of arrangements and pushes as an operator sees the table: the robot below, x up, y to the left."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon, Rectangle

from singulation_core import Arrangement, ContactMode, Push, PusherGeometry
from singulation_core.polygon import FloatArray

Workspace = tuple[float, float, float, float]

_COLOURS = mpl.colormaps["tab10"].colors  # type: ignore[attr-defined]  # a ListedColormap
_MARGIN = 0.02  # m of table around what is shown
_PUSHER = "#202020"


def colour_of(identity: int) -> tuple[float, float, float]:
    """Colour of a block, the same in every picture of a run."""
    return tuple(_COLOURS[identity % len(_COLOURS)])


def extent(arrangements: list[Arrangement], push: Push | None = None, workspace: Workspace | None = None) -> Workspace:
    """x_min, x_max, y_min, y_max around everything to be shown [m]."""
    corners = [item.outline for arrangement in arrangements for item in arrangement.objects]
    if push is not None:
        corners.append(np.array((push.start, push.end)))
    if workspace is not None:
        corners.append(np.array(((workspace[0], workspace[2]), (workspace[1], workspace[3]))))
    if not corners:
        return (-0.2, 0.2, -0.2, 0.2)
    points = np.concatenate(corners)
    low, high = points.min(axis=0) - _MARGIN, points.max(axis=0) + _MARGIN
    return (float(low[0]), float(high[0]), float(low[1]), float(high[1]))


def draw_table(axes: Axes, shown: Workspace, title: str, workspace: Workspace | None = None) -> None:
    """Axes in centimetres, with the workspace as a dashed rectangle."""
    axes.set_xlim(100 * shown[3], 100 * shown[2])
    axes.set_ylim(100 * shown[0], 100 * shown[1])
    axes.set_aspect("equal")
    axes.set_xlabel("y [cm]")
    axes.set_ylabel("x [cm]")
    axes.set_title(title, fontsize=10)
    if workspace is not None:
        low, size = (workspace[2], workspace[0]), (workspace[3] - workspace[2], workspace[1] - workspace[0])
        axes.add_patch(
            Rectangle((100 * low[0], 100 * low[1]), 100 * size[0], 100 * size[1], fill=False, ls=":", ec="0.6")
        )


def draw_arrangement(axes: Axes, arrangement: Arrangement, faint: bool = False) -> None:
    """Outlines with ids at their centroids; faint for where they were."""
    for item in arrangement.objects:
        colour = colour_of(item.id)
        style = {"fill": False, "ls": "--", "lw": 0.8} if faint else {"fc": (*colour, 0.55), "lw": 1.4}
        axes.add_patch(Polygon(_shown(item.outline), closed=True, ec=colour, **style))
        if not faint:
            y, x = 100 * item.centroid[1], 100 * item.centroid[0]
            axes.text(y, x, str(item.id), ha="center", va="center", fontsize=9)


def draw_push(axes: Axes, push: Push, pusher: PusherGeometry | None = None) -> None:
    """Arrow from P to Q and the footprint of the jaws at both."""
    start, end = _shown(push.start[None])[0], _shown(push.end[None])[0]
    for place, alpha in ((push.start, 0.9), (push.end, 0.35)):
        for outline in footprint(push, place, pusher or PusherGeometry()):
            axes.add_patch(Polygon(_shown(outline), closed=True, fc=_PUSHER, ec="none", alpha=alpha, zorder=4))
    axes.annotate("", xy=end, xytext=start, arrowprops={"arrowstyle": "-|>", "lw": 2.0, "color": _PUSHER}, zorder=5)


def footprint(push: Push, place: FloatArray, pusher: PusherGeometry) -> list[FloatArray]:
    """Outlines of what touches the table plane with the middle of the contact at ``place``, (k, 2) each [m]."""
    along = push.direction
    across = np.array((-along[1], along[0]))
    if push.contact_mode is ContactMode.EDGE:
        half = 0.5 * push.contact_width * across
        back = place - pusher.edge_thickness * along
        return [np.array((place - half, place + half, back + half, back - half))]
    angles = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    disc = pusher.tip_radius * np.column_stack((np.cos(angles), np.sin(angles)))
    offsets = (0.0,) if push.contact_mode is ContactMode.SINGLE_POINT else (-0.5, 0.5)
    return [disc + place + offset * push.contact_width * across for offset in offsets]


def _shown(points: FloatArray) -> FloatArray:
    """Table x, y [m] -> picture right is -y (axes run from +y to -y), up is x [cm]."""
    return 100.0 * points[:, ::-1]


def picture_of_push(
    path: Path,
    before: Arrangement,
    push: Push,
    after: Arrangement,
    distances: tuple[float, float],
    gaps: tuple[float, float],
    heading: str,
    workspace: Workspace | None = None,
) -> None:
    """Three panels: before, planned push, after, with s(A), smallest gap and the gain."""
    shown = extent([before, after], push, workspace)
    width = 4.3  # inches of a panel, whose height follows from what is shown
    height = width * (shown[1] - shown[0]) / (shown[3] - shown[2])
    figure = Figure(figsize=(3 * width, height + 1.0), layout="constrained")
    panels = figure.subplots(1, 3, sharey=True)
    draw_table(panels[0], shown, f"before: s(A) = {distances[0]:.3f}, smallest gap {1e3 * gaps[0]:.1f} mm", workspace)
    draw_arrangement(panels[0], before)
    mode = push.contact_mode.label.replace("_", " ")
    draw_table(panels[1], shown, f"planned: {push.policy}, {mode}", workspace)
    draw_arrangement(panels[1], before)
    draw_push(panels[1], push)
    gain = distances[1] - distances[0]
    title = f"after: s(A) = {distances[1]:.3f} ({gain:+.3f}), smallest gap {1e3 * gaps[1]:.1f} mm"
    draw_table(panels[2], shown, title, workspace)
    draw_arrangement(panels[2], before, faint=True)
    draw_arrangement(panels[2], after)
    figure.suptitle(heading)
    figure.savefig(path, dpi=100)


def picture_of_frame(path: Path, view: FloatArray | None, seen: Arrangement, push: Push | None, title: str) -> None:
    """A recorded scene: what the camera saw with the segments in colour, and the plan on the table.

    Args:
        path: PNG to write.
        view: (H, W, 3) colours 0..1, None if the cloud has no image order.
        seen: segments.
        push: the plan, None if there is none.
        title: above the picture.
    """
    figure = Figure(figsize=(13.0, 5.6), layout="constrained")
    panels = figure.subplots(1, 2 if view is not None else 1, squeeze=False)[0]
    if view is not None:
        panels[0].imshow(view)
        panels[0].set_axis_off()
        panels[0].set_title("camera view, segments in colour", fontsize=10)
    draw_table(panels[-1], extent([seen], push), "polygons and planned push on the table")
    draw_arrangement(panels[-1], seen)
    if push is not None:
        draw_push(panels[-1], push)
    figure.suptitle(title)
    figure.savefig(path, dpi=100)


def picture_of_progress(path: Path, distances: list[float], gaps: list[float], min_gap: float) -> None:
    """s(A) and the smallest gap over the pushes of a run."""
    figure = Figure(figsize=(7.0, 3.6), layout="constrained")
    left = figure.subplots()
    pushes = range(len(distances))
    left.plot(pushes, distances, "o-", color="tab:blue")
    left.set_xlabel("pushes")
    left.set_ylabel("s(A)", color="tab:blue")
    left.set_xticks(list(pushes))
    right = left.twinx()
    right.plot(pushes, [1e3 * gap for gap in gaps], "s--", color="tab:orange")
    right.axhline(1e3 * min_gap, color="tab:orange", lw=0.8, ls=":")
    right.set_ylabel("smallest gap [mm]", color="tab:orange")
    figure.savefig(path, dpi=100)
