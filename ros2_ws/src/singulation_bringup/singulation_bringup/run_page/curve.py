"""A small line chart as SVG: one value before the first push and one after each."""

import math
from collections.abc import Sequence

from singulation_bringup.run_page.markup import Markup, tag

_WIDTH, _HEIGHT = 360, 200
_RIGHT, _TOP, _BOTTOM = 12, 12, 34
_LETTER = 7.5  # width of a digit
_TICKS = 4  # at most so many intervals on the axis of values


def curve(
    title: str, description: str, values: Sequence[float | None], style: str, limit: float | None = None
) -> Markup:
    """A chart.

    Args:
        title: above it.
        description: what it shows, for those who do not see it.
        values: in order; None leaves a gap.
        style: class of the line.
        limit: a level to be reached, drawn dashed.
    """
    known = [value for value in values if value is not None] + ([] if limit is None else [limit])
    steps = _levels(min(known, default=0.0), max(known, default=1.0))
    low, high = steps[0], steps[-1]
    digits = max(len(f"{level:g}".partition(".")[2]) for level in steps)
    left = 12 + _LETTER * max(len(f"{level:.{digits}f}") for level in steps)

    def x(push: float) -> float:
        return round(left + push * (_WIDTH - left - _RIGHT) / max(len(values) - 1, 1), 1)

    def y(value: float) -> float:
        return round(_TOP + (high - value) / (high - low) * (_HEIGHT - _TOP - _BOTTOM), 1)

    parts = [tag("title", f"{title}. {description}")]
    for level in steps:
        parts.append(tag("line", x1=left, x2=_WIDTH - _RIGHT, y1=y(level), y2=y(level), class_="grid"))
        parts.append(tag("text", f"{level:.{digits}f}", x=left - 6, y=y(level) + 4, text_anchor="end"))
    every = max(1, math.ceil(len(values) / 11))
    for push in range(0, len(values), every):
        parts.append(tag("text", str(push), x=x(push), y=_HEIGHT - _BOTTOM + 16, text_anchor="middle"))
    middle = (left + _WIDTH - _RIGHT) / 2
    parts.append(tag("text", "pushes", x=middle, y=_HEIGHT - 3, text_anchor="middle", class_="axis"))
    if limit is not None:
        parts.append(tag("line", x1=left, x2=_WIDTH - _RIGHT, y1=y(limit), y2=y(limit), class_="limit"))
    for run in _runs(values):
        parts.append(tag("polyline", points=" ".join(f"{x(k)},{y(v)}" for k, v in run), class_=f"curve {style}"))
        parts += [tag("circle", cx=x(k), cy=y(v), r=3.5, class_=f"dot {style}") for k, v in run]
    chart = tag("svg", *parts, viewBox=f"0 0 {_WIDTH} {_HEIGHT}", role="img", class_="chart")
    return tag("figure", tag("figcaption", title), chart)


def _runs(values: Sequence[float | None]) -> list[list[tuple[int, float]]]:
    """Stretches without a gap: number of the push, value."""
    runs: list[list[tuple[int, float]]] = [[]]
    for push, value in enumerate(values):
        if value is not None:
            runs[-1].append((push, value))
        elif runs[-1]:
            runs.append([])
    return [run for run in runs if run]


def _levels(low: float, high: float) -> list[float]:
    """Round numbers that enclose low and high, at most ``_TICKS`` intervals."""
    span = max(high - low, 1e-9 * max(abs(low), abs(high), 1.0))
    rough = span / _TICKS
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(power * factor for factor in (1.0, 2.0, 2.5, 5.0, 10.0) if power * factor >= rough * (1.0 - 1e-9))
    first, last = math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9)
    return [round(k * step, 12) for k in range(first, max(last, first + 1) + 1)]
