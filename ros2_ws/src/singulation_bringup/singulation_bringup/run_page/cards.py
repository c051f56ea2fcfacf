"""One card for each push and each recorded cloud."""

from collections.abc import Sequence
from typing import Any

from singulation_bringup.run_page.folder import RunFolder
from singulation_bringup.run_page.markup import Markup, number, tag
from singulation_bringup.run_page.table_view import Window, table_view

_MM = 1e3


def push_card(run: RunFolder, index: int, entry: dict[str, Any], window: Window | None) -> Markup:
    """A push with its outcome and its pictures; drawn from the summary if there is a window, else the demo's own."""
    s, gaps = run.summary["singulation_distance"], run.summary["smallest_gap"]
    number_of = index + 1
    target = "no block in particular" if entry["target_id"] is None else f"block {entry['target_id']}"
    mode = entry["contact_mode"].replace("_", " ")
    travel = 100.0 * _length(entry["start"], entry["end"])
    change = (
        f"s(A) {number(s[index], 3)} → {number(s[number_of], 3)}, smallest gap {number(gaps[index], 1, _MM)} → "
        f"{number(gaps[number_of], 1, _MM)} mm"
    )
    said = f"{entry['policy'] or 'no policy'}, {mode}: push of {target} over {travel:.1f} cm"
    lines = [
        tag("h3", f"Push {number_of} ", code_of(entry)),
        tag("p", said),
        *([tag("p", entry["message"])] if entry["message"] else []),
        tag("p", change, class_="soft"),
    ]
    if window is None:
        pictures = _fallback(run, number_of, said, change)
    else:
        pictures = _drawn(window, number_of, entry, said, change)
    return tag("article", *lines, pictures, class_="card")


def _drawn(window: Window, push: int, entry: dict[str, Any], said: str, change: str) -> Markup:
    before, after = entry["before"], entry["after"]
    plan = f"Table before push {push}: {count(len(before), 'block', 'blocks')}; {said}"
    outcome = f"Table after push {push}: {count(len(after), 'block', 'blocks')}; {change}"
    return tag(
        "div",
        tag("figure", tag("figcaption", "before, and the plan"), table_view(window, before, plan, push=entry)),
        tag("figure", tag("figcaption", "after (dashed: before)"), table_view(window, after, outcome, ghosts=before)),
        class_="pair",
    )


def _fallback(run: RunFolder, push: int, said: str, change: str) -> Markup:
    """The demo's own picture, where the summary does not hold the arrangements."""
    picture = run.picture(f"push_{push:02d}.png")
    if picture is None:
        return Markup("")
    alt = f"Push {push}: table before, with the plan, and after; {said}; {change}"
    return _wide(tag("img", src=picture, alt=alt, loading="lazy"), f"Pictures of push {push}")


def cloud_card(run: RunFolder, index: int, frame: dict[str, Any]) -> Markup:
    """A recorded cloud with what was seen in it and planned on it."""
    push = frame["push"]
    plan = (
        f"planned: push object {push['target_id']} ({push['policy']}, {push['contact_mode'].replace('_', ' ')})"
        if push
        else frame["message"]
    )
    seen = count(len(frame["objects"]), "object", "objects")
    title = tag("h3", f"Cloud {index} ", code_of(frame))
    lines = [title, tag("p", f"{seen}; {plan}"), tag("p", frame["source"], class_="soft")]
    picture = run.picture(f"cloud_{index:02d}.png")
    if picture is not None:
        alt = f"Cloud {index}: camera view with segments in colour beside their polygons on the table; {seen}; {plan}"
        lines.append(_wide(tag("img", src=picture, alt=alt, loading="lazy"), f"Picture of cloud {index}"))
    return tag("article", *lines, class_="card")


def _wide(picture: Markup, name: str) -> Markup:
    """A picture that a phone scrolls sideways instead of shrinking it beyond reading."""
    return tag("div", picture, class_="scroll wide", tabindex=0, role="region", aria_label=name)


def _length(start: Sequence[float], end: Sequence[float]) -> float:
    return float(((end[0] - start[0]) ** 2 + (end[1] - start[1]) ** 2) ** 0.5)


def code_of(result: dict[str, Any]) -> Markup:
    """A result code as a label."""
    style = "good" if int(result["code"]) == 0 else "bad"
    return tag("span", f"{result['code_name']} ({result['code']})", class_=f"code {style}")


def count(n: int, one: str, many: str) -> str:
    """A number with its noun."""
    return f"{n} {one if n == 1 else many}"
