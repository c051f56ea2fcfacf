"""The parameters of a settings class as rows of text."""

import dataclasses
from dataclasses import dataclass
from typing import Any

from singulation_bringup.reference.nodes import NodeEntry
from singulation_bringup.yaml_values import yaml_value


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
