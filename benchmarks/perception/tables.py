"""Tables of results as Markdown and CSV."""

import csv
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Table:
    """Rows of cells, as many each as there are columns; numbers are rounded for reading in Markdown only.

    Args:
        name: of the CSV file.
        title: heading in Markdown.
        columns: with their units.
        notes: what one must know to read it, one paragraph each.
    """

    name: str
    title: str
    columns: list[str]
    rows: list[list[Any]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def markdown(self) -> str:
        """Heading, notes, table."""
        lines = [f"## {self.title}", ""]
        for note in self.notes:
            lines += [note, ""]
        lines += ["| " + " | ".join(self.columns) + " |", "|---" * len(self.columns) + "|"]
        lines += ["| " + " | ".join(_cell(value) for value in row) + " |" for row in self.rows]
        return "\n".join(lines) + "\n"

    def write(self, folder: Path) -> None:
        """``NAME.csv`` and ``NAME.md`` in the folder."""
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"{self.name}.md").write_text(self.markdown(), encoding="utf-8")
        with (folder / f"{self.name}.csv").open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([self.columns, *self.rows])


def _cell(value: Any) -> str:
    if not isinstance(value, float):
        return str(value)
    if value != value:  # noqa: PLR0124  # NaN: nothing to state
        return "-"
    for limit, digits in ((0.9995, 3), (9.995, 2), (99.95, 1)):
        if abs(value) < limit:
            return f"{value:.{digits}f}"
    return f"{value:.0f}"
