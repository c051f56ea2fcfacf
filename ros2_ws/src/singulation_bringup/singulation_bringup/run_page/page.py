"""Puts the page together."""

from pathlib import Path

from singulation_bringup.run_page.folder import RunFolder
from singulation_bringup.run_page.markup import Markup, tag
from singulation_bringup.run_page.sections import clouds, course, film, heading, pushes, timings
from singulation_bringup.run_page.style import STYLE
from singulation_core import ResultCode, SingulationError

PAGE = "index.html"
# The page may show only what it carries, wherever it is put.
_POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'"


def write_page(folder: Path) -> Path:
    """Write ``index.html`` into a result folder of the demo, from its ``summary.json`` and pictures.

    Returns:
        The page: one file, pictures inside.

    Raises:
        SingulationError: ``BAD_FILE`` if the folder holds no summary, or cannot be written.
    """
    text = page_of(RunFolder.read(folder))
    target = folder / PAGE
    try:
        target.write_text(text, encoding="utf-8")
    except OSError as error:
        raise SingulationError(ResultCode.BAD_FILE, f"{target}: {error}") from None
    return target


def page_of(run: RunFolder) -> str:
    """The page as text."""
    head = tag(
        "head",
        tag("meta", charset="utf-8"),
        tag("meta", name="viewport", content="width=device-width, initial-scale=1"),
        tag("meta", name="color-scheme", content="light dark"),
        tag("meta", http_equiv="Content-Security-Policy", content=_POLICY),
        tag("title", f"Planar singulation: run of {run.written:%Y-%m-%d %H:%M}"),
        tag("style", Markup(STYLE)),
    )
    main = tag("main", heading(run), course(run), film(run), pushes(run), clouds(run), timings(run), _footer(run))
    return f"<!DOCTYPE html>\n{tag('html', head, tag('body', main), lang='en')}\n"


def _footer(run: RunFolder) -> Markup:
    beside = ", ".join(["summary.json", "summary.txt", "logs", *sorted(run.summary["files"])])
    return tag("footer", f"This page is one file and needs nothing else. Beside it in the result folder: {beside}.")
