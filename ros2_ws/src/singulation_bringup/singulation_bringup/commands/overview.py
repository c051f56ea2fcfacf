"""What is known of a running cell, and how it looks on one screen."""

import math
from collections import deque
from dataclasses import dataclass, field

WORDS = ("ok", "warning", "ERROR", "stale")  # by level of diagnostic_msgs/DiagnosticStatus
_WIDTH = 110
_NAME, _STATE = 22, 13


@dataclass(slots=True)
class Component:
    """What a node last said of a part of itself."""

    level: int
    text: str
    values: dict[str, str]
    heard: float


@dataclass(slots=True)
class Traffic:
    """Messages of a topic."""

    arrivals: deque[float] = field(default_factory=lambda: deque(maxlen=500))
    last: str = ""

    def note(self, now: float, last: str = "") -> None:
        """A message came."""
        self.arrivals.append(now)
        self.last = last

    def rate(self, now: float, window: float) -> float:
        """Messages per second over the last ``window`` [s]; 0 for fewer than two, which have no distance."""
        recent = [one for one in self.arrivals if now - one <= window]
        if len(recent) < 2 or not (recent[-1] > recent[0]):
            return 0.0
        return (len(recent) - 1) / (recent[-1] - recent[0])


@dataclass(slots=True)
class Overview:
    """Everything the screen shows.

    Args:
        wanted: nodes a cell cannot do without.
        components: by node, then by name of the part.
        present: nodes that discovery knows.
        topics: by name.
    """

    wanted: tuple[str, ...]
    components: dict[str, dict[str, Component]] = field(default_factory=dict)
    present: set[str] = field(default_factory=set)
    topics: dict[str, Traffic] = field(default_factory=dict)

    def hear(self, full_name: str, component: Component) -> None:
        """Take a status named ``node: part``."""
        node, _, part = full_name.partition(": ")
        self.components.setdefault(node, {})[part] = component

    def state(self, node: str, now: float, patience: float) -> str:
        """``active``, ``inactive``, ``unconfigured``, ``running``, ``failed``, ``silent`` or ``missing``."""
        parts = self.components.get(node, {})
        if not any(now - one.heard <= patience for one in parts.values()):
            return "silent" if node in self.present else "missing"
        lifecycle = parts.get("state")
        if lifecycle is None:
            return "running"
        return "failed" if lifecycle.level >= 2 else lifecycle.text

    def worst(self, node: str) -> tuple[str, Component] | None:
        """The part of a node with the highest level."""
        parts = self.components.get(node, {})
        return max(parts.items(), key=lambda item: item[1].level) if parts else None

    def problems(self, now: float, patience: float) -> list[str]:
        """Why this cell could not push now; empty if it could."""
        found = [
            f"{node} is {state}"
            for node in self.wanted
            if (state := self.state(node, now, patience)) not in ("active", "running")
        ]
        for node, parts in sorted(self.components.items()):
            found += [f"{node}: {name}: {one.text}" for name, one in parts.items() if one.level >= 2]
        return found


def screen(overview: Overview, now: float, window: float, title: str, everything: bool = False) -> str:
    """The overview as text, at most one screen unless ``everything`` is asked for."""
    lines = [title, "", _row("NODE", "STATE", "SAYS")]
    others = sorted(set(overview.components) - set(overview.wanted))
    for node in (*overview.wanted, *others):
        lines += _node_lines(overview, node, now, window, everything)
    lines += ["", _row("TOPIC", "RATE", "LAST")]
    lines += [_topic_line(name, traffic, now, window) for name, traffic in overview.topics.items()]
    problems = overview.problems(now, window)
    lines += ["", _verdict(overview) if not problems else f"{len(problems)} to look at:"]
    lines += [_cut(f"  - {one}") for one in problems[:8]]
    return "\n".join(lines)


def _verdict(overview: Overview) -> str:
    """Of a cell that could push now."""
    warnings = sum(one.level == 1 for parts in overview.components.values() for one in parts.values())
    if not warnings:
        return "everything is well"
    return f"the cell could push now, with {warnings} warning{'s' if warnings > 1 else ''} (--all shows every part)"


def _node_lines(overview: Overview, node: str, now: float, window: float, everything: bool) -> list[str]:
    state = overview.state(node, now, window)
    worst = overview.worst(node)
    said = "" if worst is None else f"{WORDS[min(worst[1].level, 3)]}  {worst[0]}: {worst[1].text}"
    if worst is not None and worst[1].level == 0:
        parts = overview.components[node]
        said = "ok  " + ", ".join(name for name in parts if name != "state")
    lines = [_row(node, state, said)]
    if everything:
        for name, part in overview.components.get(node, {}).items():
            values = ", ".join(f"{key} {value}" for key, value in part.values.items())
            lines.append(f"    {WORDS[min(part.level, 3)]:<8}{name}: {part.text}" + (f" ({values})" if values else ""))
    return lines


def _topic_line(name: str, traffic: Traffic, now: float, window: float) -> str:
    if not traffic.arrivals:
        return _row(name, "-", "nothing heard")
    rate, age = traffic.rate(now, window), now - traffic.arrivals[-1]
    shown = f"{rate:.1f} Hz" if rate > 0.0 else "-"
    when = "" if age < 1.0 else f", {_duration(age)} ago"
    return _row(name, shown, f"{traffic.last}{when}".removeprefix(", "))


def _row(first: str, second: str, third: str) -> str:
    return _cut(f"{first:<{_NAME - 1}} {second:<{_STATE - 1}} {third}")


def _cut(line: str) -> str:
    """One line of the screen, whatever a node has to say."""
    flat = line.replace("\n", " ").rstrip()
    return flat if len(flat) <= _WIDTH else f"{flat[: _WIDTH - 4]} ..."


def _duration(seconds: float) -> str:
    if not math.isfinite(seconds):
        return "never"
    return f"{seconds:.0f} s" if seconds < 120.0 else f"{seconds / 60.0:.0f} min"
