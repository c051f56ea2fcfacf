"""The parameters of a settings class as rows of text."""

import dataclasses
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

from singulation_bringup.reference.nodes import NodeEntry


@dataclass(frozen=True, slots=True)
class ParameterRow:
    """One parameter.

    Args:
        name: of it.
        kind: bool, int, float, str, or list of float or str.
        default: as YAML.
        allowed: range or choices, empty if there is no limit.
        text: meaning and unit.
        read_only: fixed once the node runs.
    """

    name: str
    kind: str
    default: str
    allowed: str
    text: str
    read_only: bool


def rows(node: NodeEntry) -> list[ParameterRow]:
    """All parameters of a node, in the order of its settings class."""
    return [_row(item) for item in dataclasses.fields(node.settings)]


def yaml_value(value: Any) -> str:
    """A value as YAML that rcl reads with the same type; floats keep a dot and have no exponent."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        plain = format(Decimal(repr(value)), "f")
        return plain if "." in plain else f"{plain}.0"
    if isinstance(value, tuple | list):
        return f"[{', '.join(yaml_value(item) for item in value)}]"
    return f'"{value}"' if isinstance(value, str) else str(value)


def _row(item: Any) -> ParameterRow:
    spec = item.metadata["parameter"]
    return ParameterRow(
        item.name, _kind(item.default), yaml_value(item.default), _allowed(spec), spec.text, spec.read_only
    )


def _kind(value: Any) -> str:
    if isinstance(value, tuple):
        return f"list of {_kind(value[0])}" if value else "list"
    return type(value).__name__


def _allowed(spec: Any) -> str:
    if spec.choices is not None:
        return ", ".join(str(choice) for choice in spec.choices)
    if spec.low is not None and spec.high is not None:
        return f"{spec.low:g} to {spec.high:g}"
    if spec.low is not None:
        return f"at least {spec.low:g}"
    return "" if spec.high is None else f"at most {spec.high:g}"
