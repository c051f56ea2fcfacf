import importlib
import os
import sys
import time

import pytest

from singulation_core.compiling import compiling_told, helpers
from singulation_core.jit import compiled_part

STEPS = """
import pathlib, time

def note(name):
    pathlib.Path(__file__).with_name(f"{name}.done").touch()

def fail():
    note("failed")
    raise RuntimeError("never mind")

def wait():
    note("waiting")
    time.sleep(600)

STEPS = (lambda: note("first"), %s)
"""


@pytest.fixture
def steps(tmp_path, monkeypatch):
    """Makes the module ``made_steps`` with a second step of this name, known to child processes too."""
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")]))
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1, 2, 3})

    def make(name):
        (tmp_path / "made_steps.py").write_text(STEPS % name)
        importlib.invalidate_caches()
        return tmp_path

    yield make
    sys.modules.pop("made_steps", None)


def until(path):
    deadline = time.monotonic() + 60.0
    while not path.exists():
        assert time.monotonic() < deadline, f"{path.name} did not come"
        time.sleep(0.01)


def test_a_helper_runs_the_other_steps_first(steps):
    folder = steps('lambda: note("second")')
    with helpers("made_steps"):
        until(folder / "first.done")
    assert (folder / "second.done").exists()


def test_a_helper_that_fails_does_not_matter(steps):
    folder = steps("fail")
    with helpers("made_steps"):
        until(folder / "failed.done")
    assert not (folder / "first.done").exists()


def test_a_helper_ends_with_the_block(steps):
    folder = steps("wait")
    began = time.monotonic()
    with helpers("made_steps"):
        until(folder / "waiting.done")
    assert time.monotonic() - began < 60.0


def test_with_one_core_nobody_helps(steps, monkeypatch):
    folder = steps('lambda: note("second")')
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0})
    with helpers("made_steps"):
        pass
    assert not list(folder.glob("*.done"))


def test_only_compiling_is_told_and_only_once():
    def double(values):
        for k in range(len(values)):
            values[k] *= 2

    told = []
    function = compiled_part(double)
    with compiling_told(lambda: told.append("now")):
        function.compile("(f8[::1],)")
        function.compile("(f4[::1],)")
    assert told == ["now"]
    with compiling_told(lambda: told.append("again")):
        function.compile("(f8[::1],)")
    assert told == ["now"]
