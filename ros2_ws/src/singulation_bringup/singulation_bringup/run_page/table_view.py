"""Blocks on the table as SVG, as an operator sees them: the robot below, x up, y to the left."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from singulation_bringup.drawing import colour_of
from singulation_bringup.run_page.markup import Markup, tag

_MARGIN = 0.015  # m around everything that is shown
_SCALE = 1000.0  # SVG units are millimetres
_TIP = 8.7  # mm; the closed jaws are drawn as the disc around them


@dataclass(frozen=True, slots=True)
class Window:
    """Part of the table that is shown: x_min, x_max, y_min, y_max [m]."""

    x_min: float
    x_max: float
    y_min: float
    y_max: float

    @classmethod
    def around(cls, pushes: Sequence[dict[str, Any]]) -> "Window":
        """The same window for all pictures of a run, around all that happens in it."""
        points = [tuple(push[end]) for push in pushes for end in ("start", "end")]
        points += [
            tuple(corner)
            for push in pushes
            for side in ("before", "after")
            for block in push.get(side) or ()
            for corner in block["outline"]
        ]
        x, y = zip(*points, strict=True)
        return cls(min(x) - _MARGIN, max(x) + _MARGIN, min(y) - _MARGIN, max(y) + _MARGIN)

    def place(self, point: Sequence[float]) -> tuple[float, float]:
        """Right and down [mm] in the picture of a point x, y [m] in ``table``."""
        return round(_SCALE * (self.y_max - point[1]), 1), round(_SCALE * (self.x_max - point[0]), 1)

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the picture [mm]."""
        return round(_SCALE * (self.y_max - self.y_min), 1), round(_SCALE * (self.x_max - self.x_min), 1)


def table_view(
    window: Window,
    blocks: Sequence[dict[str, Any]],
    title: str,
    push: dict[str, Any] | None = None,
    ghosts: Sequence[dict[str, Any]] = (),
) -> Markup:
    """A picture of the table.

    Args:
        window: what part of it.
        blocks: as ``object_entry`` of the demo's summary.
        title: what it shows, for those who do not see it.
        push: drawn as an arrow from P to Q, with the jaws at P.
        ghosts: blocks where they were before.
    """
    width, height = window.size
    parts = [tag("title", title), tag("rect", width=width, height=height, class_="table")]
    parts += [tag("polygon", points=_corners(window, item), class_="ghost") for item in ghosts]
    for item in blocks:
        parts.append(tag("polygon", points=_corners(window, item), fill=_colour(item["id"]), class_="block"))
        x, y = window.place(item["centroid"])
        parts.append(tag("text", str(item["id"]), x=x, y=y + 4, text_anchor="middle", class_="name"))
    if push is not None:
        parts += _arrow(window, push)
    return tag("svg", *parts, viewBox=f"0 0 {width} {height}", role="img", class_="view")


def _corners(window: Window, item: dict[str, Any]) -> str:
    return " ".join("{},{}".format(*window.place(corner)) for corner in item["outline"])


def _colour(identity: int) -> str:
    return "#" + "".join(f"{round(255 * part):02x}" for part in colour_of(identity))


def _arrow(window: Window, push: dict[str, Any]) -> list[Markup]:
    """Jaws at P, line to Q, head at Q."""
    (x1, y1), (x2, y2) = window.place(push["start"]), window.place(push["end"])
    length = max(((x2 - x1) ** 2 + (y2 - y1) ** 2) ** 0.5, 1e-6)
    ux, uy = (x2 - x1) / length, (y2 - y1) / length
    jaws = [
        tag("circle", cx=round(px, 1), cy=round(py, 1), r=_TIP, class_="jaws") for px, py in _jaws(push, x1, y1, ux, uy)
    ]
    wings = [(x2 - 7 * ux + side * 4 * uy, y2 - 7 * uy - side * 4 * ux) for side in (-1, 1)]
    head = " ".join(f"{x:.1f},{y:.1f}" for x, y in ((x2, y2), *wings))
    line = tag("line", x1=x1, y1=y1, x2=round(x2 - 5 * ux, 1), y2=round(y2 - 5 * uy, 1), class_="arrow")
    return [*jaws, line, tag("polygon", points=head, class_="head")]


def _jaws(push: dict[str, Any], x: float, y: float, ux: float, uy: float) -> list[tuple[float, float]]:
    """Middles of the discs that stand for the jaws."""
    if push["contact_mode"] == "two_point":
        half = 0.5 * _SCALE * push["contact_width"]
        return [(x - half * uy, y + half * ux), (x + half * uy, y - half * ux)]
    behind = 6.0 if push["contact_mode"] == "edge" else 0.0  # P of an edge push is on the jaws' front
    return [(x - behind * ux, y - behind * uy)]
