"""Pictures of a motion, drawn from joint states alone."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from benchmarks.executor.solids import Faces, configuration, prism_faces, robot_faces
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import LightSource
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from singulation_core import Arrangement, CellGeometry, Push
from singulation_core.polygon import FloatArray
from singulation_core.transforms import inverse, transform_points
from yumi_push_executor.clearance.shapes import FINGER, GRIPPER

_LIGHT = LightSource(azdeg=-60, altdeg=50)
_PART = {GRIPPER: "#555c66", FINGER: "#8d1f2f"}
_ARM = {"left": "#d8e4f2", "right": "#f3e2d3"}
_BLOCK, _TABLE = "#e0912f", "#e4ecdf"
_PIECE = 0.03  # [m]
_LOW = 0.012  # [m] above the table: below it a finger is drawn from above


@dataclass(frozen=True, eq=False)
class Moment:
    """What to draw.

    Args:
        title: above the picture.
        arm: that pushes.
        postures: (7,) angles of both arms [rad].
        openings: of the jaws [m].
        arrangement: blocks on the table.
    """

    title: str
    arm: str
    postures: Mapping[str, FloatArray]
    openings: Mapping[str, float]
    arrangement: Arrangement


def draw_scene(axes: Axes3D, moment: Moment, cell: CellGeometry, only_jaws_of: str | None = None) -> None:
    """Robot (or the gripper of one arm), table and blocks into three-dimensional axes.

    All faces go into one collection and are small, because Matplotlib sorts faces of one collection by their middle.
    """
    coloured: list[tuple[Faces, str]] = [
        (faces, _PART.get(part, _ARM.get(arm, "#c9ccd1")))
        for (arm, part), faces in robot_faces(configuration(moment.postures, moment.openings)).items()
        if only_jaws_of in (None, arm) and (only_jaws_of is None or part >= GRIPPER)
    ]
    coloured.append((_tiles(cell), _TABLE))
    coloured += [
        (prism_faces(item.outline, 0.0, item.height, cell.body_from_table), _BLOCK)
        for item in moment.arrangement.objects
    ]
    small = [(piece, colour) for faces, colour in coloured for face in faces for piece in _pieces(face)]
    axes.add_collection3d(
        Poly3DCollection(
            [face for face, _ in small],
            facecolors=[colour for _, colour in small],
            linewidths=0.0,
            shade=True,
            lightsource=_LIGHT,
        )
    )


def _tiles(cell: CellGeometry) -> Faces:
    """The workspace in squares of about 2 cm, a little below the table's surface so that blocks stand on it."""
    x_min, x_max, y_min, y_max = cell.workspace
    xs, ys = np.arange(x_min, x_max, 0.02), np.arange(y_min, y_max, 0.02)
    corners = [np.array(((x, y), (x + 0.02, y), (x + 0.02, y + 0.02), (x, y + 0.02))) for x in xs for y in ys]
    return [prism_faces(one, -0.002, -0.001, cell.body_from_table)[-1] for one in corners]


def _pieces(face: FloatArray) -> Faces:
    """A quadrilateral in parts of about 3 cm; anything else as it is."""
    if len(face) != 4:
        return [face]
    a, b, c, d = face
    across = max(1, round(float(np.linalg.norm(b - a)) / _PIECE))
    along = max(1, round(float(np.linalg.norm(d - a)) / _PIECE))
    if across == along == 1:
        return [face]

    def point(i: int, j: int) -> FloatArray:
        u, v = i / across, j / along
        return np.asarray((1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * d + u * c))

    corners = ((0, 0), (1, 0), (1, 1), (0, 1))
    return [np.array([point(i + di, j + dj) for di, dj in corners]) for i in range(across) for j in range(along)]


def look(axes: Axes3D, centre: FloatArray, size: float, elevation: float, azimuth: float) -> None:
    """Cube of ``size`` [m] around a point, seen from a direction [degrees]."""
    half = 0.5 * size
    axes.set_xlim(centre[0] - half, centre[0] + half)
    axes.set_ylim(centre[1] - half, centre[1] + half)
    axes.set_zlim(centre[2] - half, centre[2] + half)
    axes.set_box_aspect((1, 1, 1), zoom=1.35)
    axes.set_proj_type("persp", focal_length=1.4)
    axes.view_init(elev=elevation, azim=azimuth)
    axes.set_axis_off()


def save_strip(path: Path, moments: Sequence[Moment], push: Push) -> None:
    """One picture, a column per moment: the whole cell, the jaws seen along the table, the jaws seen from above."""
    cell = CellGeometry()
    figure = plt.figure(figsize=(3.2 * len(moments), 9.0))
    middle = transform_points(cell.body_from_table, np.array((*(0.5 * (push.start + push.end)), 0.04)))
    across = float(np.rad2deg(np.arctan2(-push.direction[0], push.direction[1])))
    for column, moment in enumerate(moments):
        axes = figure.add_subplot(3, len(moments), column + 1, projection="3d")
        draw_scene(axes, moment, cell)
        look(axes, np.array((0.2, 0.0, 0.22)), 0.82, 20.0, 20.0)
        axes.set_title(moment.title, fontsize=12)
        axes = figure.add_subplot(3, len(moments), len(moments) + column + 1, projection="3d")
        draw_scene(axes, moment, cell, only_jaws_of=moment.arm)
        look(axes, middle, 0.16, 12.0, across)
        draw_from_above(figure.add_subplot(3, len(moments), 2 * len(moments) + column + 1), moment, push, cell)
    figure.subplots_adjust(left=0.01, right=0.99, bottom=0.01, top=0.96, wspace=0.04, hspace=0.02)
    figure.savefig(path, dpi=90)
    plt.close(figure)


def draw_from_above(axes: Axes, moment: Moment, push: Push, cell: CellGeometry) -> None:
    """Blocks, finger tips where they are low, and the push, in ``table``; x points up, y to the left."""
    table_from_body = inverse(cell.body_from_table)
    for item in moment.arrangement.objects:
        axes.fill(item.outline[:, 1], item.outline[:, 0], color=_BLOCK, alpha=0.8)
    shapes = robot_faces(configuration(moment.postures, moment.openings))
    for (_, part), faces in shapes.items():
        low = [transform_points(table_from_body, face) for face in faces]
        for face in low if part == FINGER else []:
            if face[:, 2].max() < _LOW:
                axes.fill(face[:, 1], face[:, 0], color=_PART[FINGER])
    tip, tail = ((float(point[1]), float(point[0])) for point in (push.end, push.start))
    axes.annotate("", tip, tail, arrowprops={"arrowstyle": "->", "color": "#1d3f72", "lw": 1.5})
    middle = 0.5 * (push.start + push.end)
    axes.set_xlim(middle[1] + 0.09, middle[1] - 0.09)
    axes.set_ylim(middle[0] - 0.09, middle[0] + 0.09)
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])


def save_animation(path: Path, moments: Sequence[Moment], rate: int) -> None:
    """The moments one after the other, ``rate`` per second, as a GIF."""
    cell = CellGeometry()
    figure = plt.figure(figsize=(5.4, 4.6))
    axes = figure.add_subplot(projection="3d")
    figure.subplots_adjust(left=0.0, right=1.0, bottom=0.0, top=1.0)

    def show(index: int) -> list[Artist]:
        axes.clear()
        draw_scene(axes, moments[index], cell)
        look(axes, np.array((0.2, 0.0, 0.22)), 0.78, 20.0, 20.0)
        axes.text2D(0.02, 0.94, moments[index].title, transform=axes.transAxes)
        return []

    FuncAnimation(figure, show, frames=len(moments), blit=False).save(path, writer=PillowWriter(fps=rate))
    plt.close(figure)
