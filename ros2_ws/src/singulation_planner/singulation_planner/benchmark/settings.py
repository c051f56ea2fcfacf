"""Under which conditions policies are compared: scenes, jaws, length of a push, physics."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from singulation_core import InvalidInputError, PusherGeometry
from singulation_core.push_world import PushPhysics
from singulation_planner.benchmark.generators import UNIT
from singulation_planner.placement import Placement


@dataclass(frozen=True, slots=True)
class Setting:
    """Everything a comparison depends on besides policies and seeds.

    Args:
        name: of the setting.
        text: one line on it, printed above the tables.
        generator: of scenes, a key of ``GENERATORS``.
        pusher: jaws [m].
        push_distance: travel from start to end [m]; None: one bounding radius after contact.
        placement: of the start.
        physics: that simulates for planners, and what their pushes do.
        options: of policies, by name.
        judge: that simulates what the pushes do instead of ``physics``, which then only planners see.
    """

    name: str
    text: str
    generator: str
    pusher: PusherGeometry
    push_distance: float | None
    placement: Placement
    physics: PushPhysics
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    judge: PushPhysics | None = None


def _jaws(tip: float, width: float, thickness: float) -> PusherGeometry:
    return PusherGeometry(tip * UNIT, width * UNIT, thickness * UNIT)


# Steps as short as pymunk's fine preset has, for Brute Force over a thousand scenes.
_PRECISE = PushPhysics(engine="compiled", step=0.02, iterations=20, settle_steps=2)
_CLUTTER = Setting(
    "clutter",
    "touching clutter, push of one bounding radius after contact, tip radius 0.1, edge 0.8, two points 0.6 of the push "
    "object's bounding radius apart, quasi-static, friction 0.5; compiled engine, steps of 0.02",
    "clutter",
    _jaws(0.1, 0.8, 0.2),
    None,
    Placement(),
    _PRECISE,
)
_AUTHORS = Setting(
    "authors",
    "the authors' scenes (gaps 0 to 0.3), pushes of 4 bounding radii at 1 per second, velocity times 5/6 per 0.1 s, tip "
    "radius 0.1, edge 0.3, two points 0.6 apart, friction 0.5; pymunk",
    "authors",
    _jaws(0.1, 0.3, 0.2),
    4.0 * UNIT,
    Placement(),
    PushPhysics.authors(),
    {"brute_force": {"grid": "chords"}},
)
SETTINGS: Mapping[str, Setting] = {
    one.name: one
    for one in (
        _CLUTTER,
        replace(
            _CLUTTER,
            name="clutter_judged",
            text=f"{_CLUTTER.text} for planners, what their pushes do by pymunk in steps of 0.02",
            judge=PushPhysics.fine(),
        ),
        replace(
            _CLUTTER,
            name="clutter_pymunk",
            text=_CLUTTER.text.replace("compiled engine, steps of 0.02", "pymunk, steps of 0.05"),
            physics=PushPhysics.quasi_static(),
        ),
        _AUTHORS,
    )
}


def find_setting(name: str) -> Setting:
    """The setting of this name.

    Raises:
        InvalidInputError: listing the names there are.
    """
    if name not in SETTINGS:
        raise InvalidInputError(f"benchmark: no setting {name!r}; one of: {', '.join(SETTINGS)}")
    return SETTINGS[name]
