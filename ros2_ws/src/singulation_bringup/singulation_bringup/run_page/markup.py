"""Elements of the page. Text and attribute values are escaped here and nowhere else."""

from collections.abc import Iterable, Sequence
from html import escape

Value = str | int | float
_NONE = "\N{EN DASH}"
_VOID = ("img", "meta", "line", "rect", "circle", "path", "polyline", "polygon")


class Markup(str):
    """Text that is markup already."""

    __slots__ = ()


def tag(name: str, /, *content: str, **attributes: Value) -> Markup:
    """An element. A trailing underscore of an attribute's name is dropped, others become hyphens."""
    pairs = "".join(f' {_name(key)}="{escape(str(value))}"' for key, value in attributes.items())
    if name in _VOID and not content:
        return Markup(f"<{name}{pairs}>" if name in ("img", "meta") else f"<{name}{pairs}/>")
    return Markup(f"<{name}{pairs}>{join(content)}</{name}>")


def join(parts: Iterable[str]) -> Markup:
    """Several elements or texts after one another."""
    return Markup("".join(part if isinstance(part, Markup) else escape(part, quote=False) for part in parts))


def table(caption: str, header: Sequence[str], rows: Sequence[Sequence[str]]) -> Markup:
    """A table whose first column names its rows; it scrolls sideways where it does not fit."""
    head = tag("tr", *(tag("th", text, scope="col") for text in header))
    body = [tag("tr", tag("th", first, scope="row"), *(tag("td", cell) for cell in cells)) for first, *cells in rows]
    inside = tag("table", tag("caption", caption), tag("thead", head), tag("tbody", *body))
    return tag("div", inside, class_="scroll", tabindex=0, role="region", aria_label=caption)


def number(value: float | None, digits: int, factor: float = 1.0, unit: str = "") -> str:
    """A number with a fixed number of digits, a dash if there is none."""
    return _NONE if value is None else f"{factor * value:.{digits}f}{unit}"


def _name(key: str) -> str:
    return key.rstrip("_").replace("_", "-") if key != "viewBox" else key
