import threading

from singulation_node.testing import wait_until
from singulation_perception.latest_worker import LatestWorker


class Bench:
    """A worker whose work waits until it is let through."""

    def __init__(self):
        self.done, self.given_up = [], []
        self.begun = threading.Semaphore(0)
        self.gate = threading.Semaphore(0)
        self.worker = LatestWorker(self._work, self.given_up.append, "bench")

    def _work(self, item):
        self.begun.release()
        assert self.gate.acquire(timeout=20)
        self.done.append(item)


def test_while_busy_only_the_newest_waits():
    bench = Bench()
    bench.worker.offer(1)
    assert bench.begun.acquire(timeout=20)
    for item in (2, 3, 4):
        bench.worker.offer(item)
    assert bench.given_up == [2, 3]
    bench.gate.release(2)
    wait_until(lambda: bench.done == [1, 4])
    assert bench.worker.stop(20)


def test_stopping_finishes_the_present_item_and_gives_up_the_waiting_one():
    bench = Bench()
    bench.worker.offer(1)
    assert bench.begun.acquire(timeout=20)
    bench.worker.offer(2)
    assert not bench.worker.stop(0.01)
    assert bench.given_up == [2]
    bench.gate.release()
    assert bench.worker.stop(20)
    bench.worker.offer(3)
    assert bench.given_up == [2, 3]
    assert bench.done == [1]


def test_an_idle_worker_stops_at_once():
    assert Bench().worker.stop(20)
