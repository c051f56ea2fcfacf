"""How simulated time passes."""

import threading
import time
from typing import Any

import numpy as np
import pytest

from singulation_core import Arrangement
from singulation_node.testing import wait_until
from singulation_sim.cell import SimulatedCell
from singulation_sim.driver import PERIOD, SimulatedDriver
from singulation_sim.stepper import Stepper


class Watched:
    """A stepper and what it told."""

    def __init__(self, **options: Any) -> None:
        self.cell = SimulatedCell(Arrangement([]), driver=SimulatedDriver(start=5.0))
        self.lock = threading.Condition()
        self.told: list[float] = []
        self.delay = 0.0
        defaults = {"interval": 0.02, "speed": 50.0, "own_time": True}
        self.stepper = Stepper(self.cell, self.lock, tell=self._tell, clock=self._clock, **(defaults | options))

    def _tell(self, moved: bool) -> None:
        self.told.append(self.cell.now)

    def _clock(self) -> float:
        """Real time, which has leapt on by ``delay`` because the machine did something else."""
        return time.monotonic() + self.delay


@pytest.fixture
def watched() -> Any:
    """Makes steppers that are stopped at the end."""
    made: list[Watched] = []

    def make(**options: Any) -> Watched:
        made.append(Watched(**options))
        made[-1].stepper.start()
        return made[-1]

    yield make
    for item in made:
        item.stepper.stop()


def test_it_tells_after_every_interval(watched: Any) -> None:
    run = watched()
    wait_until(lambda: len(run.told) > 50)
    assert np.diff(run.told) == pytest.approx(0.02)
    assert run.told[0] == pytest.approx(5.02)


def test_intervals_need_not_be_whole_cycles(watched: Any) -> None:
    run = watched(interval=0.01)
    wait_until(lambda: len(run.told) > 100)
    assert run.told[99] == pytest.approx(6.0, abs=PERIOD)


def test_waiting_for_a_moment(watched: Any) -> None:
    run = watched()
    with run.lock:
        assert run.stepper.wait_for(run.cell.now + 1.0, 20.0)
        assert run.cell.now >= 6.0
        assert not run.stepper.wait_for(run.cell.now + 1e6, 0.05)
        assert run.stepper.wait_for(run.cell.now + 0.1, 20.0)


def test_stopping_wakes_whoever_waits(watched: Any) -> None:
    run = watched(speed=0.05)
    answers: list[bool] = []

    def wait() -> None:
        with run.lock:
            answers.append(run.stepper.wait_for(run.cell.now + 1e6, 60.0))

    waiting = threading.Thread(target=wait)
    waiting.start()
    run.stepper.stop()
    waiting.join(10.0)
    assert answers == [False]


def test_own_time_is_not_made_up_for_after_a_delay(watched: Any) -> None:
    run = watched(speed=1.0)
    wait_until(lambda: run.told)
    count, run.delay = len(run.told), 100.0
    wait_until(lambda: len(run.told) > count + 5)
    assert run.stepper.behind < 50.0
    assert run.cell.now < 50.0


def test_wall_time_is_made_up_for_after_a_short_delay(watched: Any) -> None:
    run = watched(speed=1.0, own_time=False)
    wait_until(lambda: run.told)
    run.delay = 2.0
    wait_until(lambda: run.cell.now > 7.0)
    assert np.diff(run.told) == pytest.approx(0.02)


def test_wall_time_leaps_when_the_machine_slept(watched: Any) -> None:
    run = watched(speed=1.0, own_time=False)
    wait_until(lambda: run.told)
    run.delay = 1000.0
    wait_until(lambda: run.cell.now > 1005.0)
    assert len(run.told) < 500
