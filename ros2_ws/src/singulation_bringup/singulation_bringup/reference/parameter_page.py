"""The page of all parameters, ``docs/parameters.md``."""

from singulation_bringup.reference.nodes import NODES, NodeEntry
from singulation_bringup.reference.parameter_table import ParameterRow, rows

_INTRODUCTION = """\
# Parameters

Written by `scripts/docs` from the settings classes of the nodes; a test fails when this page is out of date.

Values come, the last one winning, from the node's defaults below, the files of
[`singulation_bringup/config`](../ros2_ws/src/singulation_bringup/config) that the launch file names, and
`--ros-args -p name:=value`. `ros2 param describe NODE NAME` shows the same text and range. A value of the wrong type
or out of range stops the node at the start with a text that names it, and is refused while the node runs.
*Fixed* parameters cannot be changed once the node runs.

Every node also has `use_sim_time`, and lifecycle nodes have `autostart` (configure and activate without a manager).
"""


def parameter_page() -> str:
    """The whole page as Markdown."""
    return _INTRODUCTION + "".join(_section(node) for node in NODES)


def _section(node: NodeEntry) -> str:
    kind = " (lifecycle)" if node.lifecycle else ""
    head = f"\n## `{node.package} {node.executable}`{kind}\n\n"
    table = "| parameter | type | default | allowed | meaning |\n|---|---|---|---|---|\n"
    return head + table + "".join(_line(row) for row in rows(node))


def _line(row: ParameterRow) -> str:
    meaning = f"{row.text}; *fixed*" if row.read_only else row.text
    cells = (f"`{row.name}`", row.kind, f"`{row.default}`", row.allowed, meaning)
    return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |\n"
