"""``python -m singulation_bringup.reference ROOT``: writes parameter files and pages of the project at ROOT.

With ``--check`` nothing is written; what is out of date is listed and the exit code is 1.
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from singulation_bringup.reference.nodes import NODES
from singulation_bringup.reference.parameter_page import parameter_page
from singulation_bringup.reference.parameter_yaml import parameter_yaml

_CONFIG = Path("ros2_ws/src/singulation_bringup/config")


def written_files() -> dict[Path, str]:
    """What is written, by path relative to the project."""
    files = {_CONFIG / f"{node.executable}.yaml": parameter_yaml(node) for node in NODES}
    files[Path("docs/parameters.md")] = parameter_page()
    return files


def stale_files(root: Path) -> list[Path]:
    """Files below ``root`` that differ from what the code says."""
    return [
        path
        for path, text in written_files().items()
        if not (root / path).is_file() or (root / path).read_text(encoding="utf-8") != text
    ]


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry point."""
    parser = argparse.ArgumentParser(prog="python -m singulation_bringup.reference", description=__doc__)
    parser.add_argument("root", type=Path, help="folder of the project")
    parser.add_argument("--check", action="store_true", help="write nothing, list what is out of date")
    options = parser.parse_args(arguments)
    stale = stale_files(options.root)
    for path in stale:
        print(f"{'out of date' if options.check else 'written'}: {path}")
        if not options.check:
            (options.root / path).parent.mkdir(parents=True, exist_ok=True)
            (options.root / path).write_text(written_files()[path], encoding="utf-8")
    return 1 if stale and options.check else 0


if __name__ == "__main__":
    sys.exit(main())
