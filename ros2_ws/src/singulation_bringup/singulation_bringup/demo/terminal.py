"""What the demo says while it works."""

import sys


def say(text: str) -> None:
    """One line of progress."""
    print(text, flush=True)


def complain(text: str) -> None:
    """One line about what went wrong."""
    print(f"error: {text}", file=sys.stderr, flush=True)
