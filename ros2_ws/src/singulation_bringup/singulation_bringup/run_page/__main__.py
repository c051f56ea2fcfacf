"""Makes the page of a result folder: ``python -m singulation_bringup.run_page FOLDER``."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from singulation_bringup.run_page.page import write_page
from singulation_core import SingulationError


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry point; 0, or 1 with a text on standard error."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="result folder of scripts/demo")
    try:
        print(write_page(parser.parse_args(arguments).folder))
    except SingulationError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
