"""What the demo says while it works."""

import os
import sys


def say(text: str) -> None:
    """One line of progress. Nobody reading it any more (a closed pipe) is no reason to stop."""
    try:
        print(text, flush=True)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def complain(text: str) -> None:
    """One line about what went wrong."""
    print(f"error: {text}", file=sys.stderr, flush=True)
