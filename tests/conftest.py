"""What tests with several processes share."""

import pytest

from running_demo import Demo


@pytest.fixture
def demo(tmp_path):
    """Start a demo whose results go to a fresh folder; it is killed if the test ends before it."""
    started = []

    def start(*arguments, out=None):
        started.append(Demo(out or tmp_path / f"results_{len(started)}", *arguments))
        return started[-1]

    yield start
    for one in started:
        if one.process.poll() is None:
            one.process.kill()
            one.process.communicate(timeout=30)
