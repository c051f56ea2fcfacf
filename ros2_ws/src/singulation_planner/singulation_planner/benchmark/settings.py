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
        judge: that simulates the planned pushes once more, so that nobody is rewarded for errors of ``physics``.
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


_CLUTTER = Setting(
    "clutter",
    "touching clutter, push of one bounding radius after contact, tip radius 0.1, edge 0.8, two points 0.6 of the push "
    "object's bounding radius apart, quasi-static, friction 0.5; compiled engine, steps of 0.05",
    "clutter",
    _jaws(0.1, 0.8, 0.2),
    None,
    Placement(),
    PushPhysics(engine="compiled", step=0.05, settle_steps=2),
    judge=PushPhysics.fine(),
)
_AUTHORS = Setting(
    "authors",
    "the authors' scenes (gaps 0 to 0.3), pushes of 4 bounding radii at 1 per second, velocity times 5/6 per 0.1 s, "
    "tip radius 0.1, edge 0.3, two points 0.6 apart, friction 0.5; pymunk",
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
            name="clutter_pymunk",
            text=_CLUTTER.text.replace("compiled engine", "pymunk"),
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
