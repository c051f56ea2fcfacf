"""The parts of the page, each from the summary of a run."""

from typing import Any

from singulation_bringup.run_page.cards import cloud_card, code_of, count, push_card
from singulation_bringup.run_page.curve import curve
from singulation_bringup.run_page.folder import RunFolder
from singulation_bringup.run_page.markup import Markup, number, table, tag
from singulation_bringup.run_page.table_view import Window

_MM = 1e3
_STAGES = {"look": "trigger, cloud, segmentation", "plan": "the next push", "push": "motion plan and motion"}


def heading(run: RunFolder) -> Markup:
    """What was done and how it ended."""
    summary = run.summary
    lines = [tag("h1", "Planar singulation: a run"), tag("p", f"{run.written:%Y-%m-%d %H:%M}", class_="soft")]
    if summary.get("loop"):
        lines.append(_verdict("Closed loop", summary["loop"]))
    if not summary.get("loop") or summary.get("code"):
        lines.append(_verdict("Demo", summary))
    return tag("header", *lines, _facts(summary))


def course(run: RunFolder) -> Markup:
    """s(A) and smallest gap over the pushes."""
    distances, gaps = run.summary["singulation_distance"], run.summary["smallest_gap"]
    if not distances:
        return Markup("")
    limit = run.summary.get("min_gap")
    millimetres = [None if gap is None else _MM * gap for gap in gaps]
    ends = [
        f"from {number(one[0], digits)} to {number(one[-1], digits)}"
        for one, digits in ((distances, 3), (millimetres, 1))
    ]
    reached = "" if limit is None else f" Dashed: {_MM * limit:g} mm, which counts as separated."
    rows = [
        [str(push), number(distance, 3), number(gap, 1, _MM)]
        for push, (distance, gap) in enumerate(zip(distances, gaps, strict=True))
    ]
    return tag(
        "section",
        tag("h2", "How far apart the blocks are"),
        tag(
            "div",
            curve("Singulation distance s(A)", f"After {len(rows) - 1} pushes {ends[0]}.", distances, "s"),
            curve(
                "Smallest gap between two blocks [mm]",
                f"After {len(rows) - 1} pushes {ends[1]} mm.{reached}",
                millimetres,
                "gap",
                None if limit is None else _MM * limit,
            ),
            class_="pair",
        ),
        tag(
            "details",
            tag("summary", "The numbers"),
            table("s(A) and smallest gap before the first push (0) and after each", ["push", "s(A)", "gap [mm]"], rows),
        ),
    )


def film(run: RunFolder) -> Markup:
    """The animation, if there is one."""
    picture = run.picture("run.gif")
    if picture is None:
        return Markup("")
    alt = "Animation of the table from above: blocks in colour, jaws as black dots, time in seconds in the corner"
    hint = "Your device asks for less motion, so the film is not shown; the pictures below show every push."
    return tag(
        "section",
        tag("h2", "Film"),
        tag("div", tag("img", src=picture, alt=alt), tag("p", hint, class_="still soft"), class_="film"),
    )


def pushes(run: RunFolder) -> Markup:
    """Every push with its outcome and its pictures."""
    entries = run.summary["pushes"]
    if not entries:
        return Markup("")
    drawn = all(entry.get("before") and entry.get("after") is not None for entry in entries)
    window = Window.around(entries) if drawn else None
    cards = [push_card(run, index, entry, window) for index, entry in enumerate(entries)]
    return tag("section", tag("h2", f"{count(len(entries), 'push', 'pushes')}"), *cards)


def clouds(run: RunFolder) -> Markup:
    """Recorded clouds with what was seen in them."""
    frames = run.summary["frames"]
    if not frames:
        return Markup("")
    cards = [cloud_card(run, index, frame) for index, frame in enumerate(frames, start=1)]
    return tag("section", tag("h2", count(len(frames), "recorded cloud", "recorded clouds")), *cards)


def timings(run: RunFolder) -> Markup:
    """Wall time of each part of the demo, and of each step of the loop."""
    seconds = {name: float(value) for name, value in run.summary["seconds"].items()}
    total = seconds.pop("total", sum(seconds.values())) or 1.0
    cells: list[Markup] = []
    for name, value in sorted(seconds.items(), key=lambda one: -one[1]):
        bar = tag("span", class_="bar", style=f"width: {100 * min(value / total, 1.0):.1f}%")
        cells += [tag("dt", name), tag("dd", f"{value:.1f} s"), tag("dd", bar, aria_hidden="true")]
    return tag(
        "section",
        tag("h2", f"Where the {total:.0f} seconds went"),
        tag("dl", *cells, class_="times"),
        _stages(run.summary.get("stages") or {}),
    )


def _stages(stages: dict[str, Any]) -> Markup:
    if not stages:
        return Markup("")
    rows = [
        [f"{name}: {_STAGES.get(name, '')}".rstrip(": "), str(stage["count"]), *_per_step(stage)]
        for name, stage in stages.items()
    ]
    return table("Steps of the closed loop, on the clock on the wall", ["step", "times", "each [s]", "all [s]"], rows)


def _per_step(stage: dict[str, Any]) -> tuple[str, str]:
    mean = stage["seconds"] / stage["count"] if stage["count"] else None
    return number(mean, 2), number(stage["seconds"], 1)


def _verdict(what: str, result: dict[str, Any]) -> Markup:
    good = int(result["code"]) == 0
    text = result.get("message") or ("everything went as it should" if good else "")
    return tag("p", f"{what}: ", code_of(result), " ", text)


def _facts(summary: dict[str, Any]) -> Markup:
    distances, gaps, entries = summary["singulation_distance"], summary["smallest_gap"], summary["pushes"]
    facts = []
    blocks = entries[0].get("before") if entries else None
    if blocks:
        facts.append(("blocks", str(len(blocks))))
    if distances:
        facts.append(("pushes", str(len(entries))))
        facts.append(("s(A)", f"{number(distances[0], 2)} → {number(distances[-1], 2)}"))
        facts.append(("smallest gap", f"{number(gaps[0], 1, _MM)} → {number(gaps[-1], 1, _MM)} mm"))
    if summary["frames"]:
        facts.append(("recorded clouds", str(len(summary["frames"]))))
    return tag("dl", *(tag("div", tag("dt", name), tag("dd", text)) for name, text in facts), class_="facts")
