"""The executable as a process: options, and an end without traces."""

import signal
import subprocess
import sys
from collections.abc import Iterator

import pytest

from singulation_node.testing import reserved_domain
from singulation_sim.sim_cell import main

LIMIT = 60.0  # s


@pytest.fixture
def domain(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A ROS domain of its own."""
    with reserved_domain() as number:
        monkeypatch.setenv("ROS_DOMAIN_ID", str(number))
        yield


@pytest.mark.usefixtures("domain")
def test_it_ends_cleanly_on_a_signal() -> None:
    command = [sys.executable, "-m", "singulation_sim.sim_cell", "--seed", "3", "--objects", "5", "--speed", "2"]
    with subprocess.Popen([*command, "--autostart"], stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        assert "5 blocks (mixed, seed 3), 2 x real time" in process.stderr.readline()
        process.send_signal(signal.SIGINT)
        _, rest = process.communicate(timeout=LIMIT)
    assert process.returncode == 0
    assert rest == ""


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [(["--help"], 0, "--speed"), (["--scene", "pile"], 2, "invalid choice"), (["--speed", "fast"], 2, "invalid float")],
)
def test_options(arguments: list[str], code: int, words: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(["sim_cell", *arguments])
    assert end.value.code == code
    shown = capsys.readouterr()
    assert words in shown.out + shown.err


@pytest.mark.usefixtures("domain")
@pytest.mark.parametrize(
    ("arguments", "words"),
    [(["--speed", "0"], "parameter speed"), (["--ros-args", "-p", "physics:=magic"], "no preset 'magic'")],
)
def test_wrong_parameters_end_it(arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]) -> None:
    handlers = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)]
    try:
        assert main(["sim_cell", *arguments]) == 1
    finally:
        for number, handler in zip((signal.SIGINT, signal.SIGTERM), handlers, strict=True):
            signal.signal(number, handler)
    assert words in capsys.readouterr().err
