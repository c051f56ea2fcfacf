"""What a policy is, how it takes part, and how its options are read."""

import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields
from typing import Any, Literal, get_args, get_origin, get_type_hints

import numpy as np

from singulation_core import InvalidInputError
from singulation_core.push_world.physics import PushPhysics
from singulation_planner.candidates import Candidates
from singulation_planner.placer import Placer
from singulation_planner.scene import Scene


@dataclass(frozen=True, slots=True)
class Task:
    """What a policy works on.

    Attributes:
        scene: the objects.
        placer: can tell which candidates are feasible, for policies that need to know before ranking.
        seed: of everything random.
        physics: of simulated pushes; None: the default preset.
        share: of its budget that a policy may spend; less than 1 where several contact modes are planned for.
    """

    scene: Scene
    placer: Placer
    seed: int
    physics: PushPhysics | None = None
    share: float = 1.0

    def random(self) -> np.random.Generator:
        """A fresh generator: the same numbers at each call."""
        return np.random.default_rng(self.seed)


# A policy yields candidates best first, in portions, so that what is not needed is not computed.
Rank = Callable[[Task, Any], Iterator[Candidates]]


@dataclass(frozen=True, slots=True)
class Policy:
    """A way to choose pushes.

    Attributes:
        name: as given to ``plan_push``.
        rank: yields candidates best first.
        options: frozen dataclass of its options.
        defaults: an instance of it.
        summary: first line of its docstring.
    """

    name: str
    rank: Rank
    options: type[Any]
    defaults: Any
    summary: str

    def read_options(self, given: Mapping[str, Any]) -> Any:
        """Options from keyword arguments (strings are converted to the type of the field).

        Raises:
            InvalidInputError: an unknown option or value; the text lists the valid ones.
        """
        if not given:
            return self.defaults
        kinds, lows = get_type_hints(self.options), {one.name: one.metadata.get("low") for one in fields(self.options)}
        for name in given:
            if name not in kinds:
                valid = ", ".join(kinds) or "none"
                raise InvalidInputError(f"policy {self.name}: unknown option {name!r}; its options: {valid}")
        return self.options(
            **{name: _converted(f"{self.name}.{name}", kinds[name], value, lows[name]) for name, value in given.items()}
        )


REGISTERED: dict[str, Policy] = {}


def policy(options: type[Any]) -> Callable[[Rank], Rank]:
    """Decorator: registers a ranking function under its module's name.

    Args:
        options: frozen dataclass; a field is a ``Literal`` of choices, a bool, a positive int or a positive float (or
            one >= 0, if its metadata say ``{"low": 0.0}``). A property ``start_room`` [mean bounding radii] asks for
            starts with that gap to all objects, where there are any.
    """

    def register(rank: Rank) -> Rank:
        name = rank.__module__.rpartition(".")[2]
        summary = (inspect.getdoc(inspect.getmodule(rank)) or "").partition("\n")[0]
        REGISTERED[name] = Policy(name, rank, options, options(), summary)
        return rank

    return register


@dataclass(frozen=True, slots=True)
class NoOptions:
    """For policies without options."""


def _converted(name: str, kind: Any, value: Any, low: float | None = None) -> Any:
    if get_origin(kind) is Literal:
        if value not in get_args(kind):
            raise InvalidInputError(f"option {name}: {value!r}, need one of {', '.join(map(repr, get_args(kind)))}")
        return value
    if kind is bool:
        if value not in (True, False, "true", "false"):
            raise InvalidInputError(f"option {name}: {value!r}, need true or false")
        return value in (True, "true")
    try:
        number = kind(value)
    except (TypeError, ValueError):
        number = kind(-1)
    if not ((number > 0 or number == low) and number < float("inf")):
        wanted = f"a positive {kind.__name__}" if low is None else f"a finite {kind.__name__} >= {low:g}"
        raise InvalidInputError(f"option {name}: {value!r}, need {wanted}")
    return number
