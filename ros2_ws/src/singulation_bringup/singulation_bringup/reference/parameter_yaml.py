"""A parameter file with every parameter of a node at its default, each with meaning and range."""

import textwrap

from singulation_bringup.reference.nodes import GROUPS, NodeEntry
from singulation_bringup.reference.parameter_table import ParameterRow, rows

_WIDTH = 112
_HEADER = """\
# All parameters of {package} {executable}, at their defaults.
# Written by scripts/docs from {module}; do not edit.
# To change values, copy the folder of this file, edit the copy, and launch with config:=COPY.
/**:
  ros__parameters:
"""


def parameter_yaml(node: NodeEntry) -> str:
    """The text of ``config/<executable>.yaml``."""
    header = _HEADER.format(package=node.package, executable=node.executable, module=node.settings.__module__)
    entries = [_entry(row) for row in rows(node)]
    # A mapping without an entry is no mapping for rcl.
    return header + "".join(entries) + ("" if any(_is_active(row) for row in rows(node)) else "    autostart: false\n")


def _entry(row: ParameterRow) -> str:
    allowed = f"; {row.allowed}" if row.allowed else ""
    fixed = "; fixed once the node runs" if row.read_only else ""
    lines = textwrap.wrap(f"{row.text}{allowed}{fixed}", _WIDTH, break_long_words=False, break_on_hyphens=False)
    comment = "".join(f"    # {line}\n" for line in lines)
    return f"{comment}    {row.name}: {row.default}\n" if _is_active(row) else f"{comment}{_elsewhere(row)}"


def _is_active(row: ParameterRow) -> bool:
    return not any(row.name in names for names in GROUPS.values())


def _elsewhere(row: ParameterRow) -> str:
    group = next(group for group, names in GROUPS.items() if row.name in names)
    return f"    # (set in {group}/*.yaml) {row.name}: {row.default}\n"
