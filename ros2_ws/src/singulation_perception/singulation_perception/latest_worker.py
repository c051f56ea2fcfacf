"""One thread that works on the newest item only: while it is busy, a waiting item is replaced by its successor."""

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

Item = TypeVar("Item")


class LatestWorker(Generic[Item]):
    """Keeps at most one item waiting.

    Args:
        work: called in the worker's thread for each item it gets to; must not raise.
        superseded: called for each item that is given up, in the thread that gives it up.
        name: of the thread.
    """

    def __init__(self, work: Callable[[Item], None], superseded: Callable[[Item], None], name: str) -> None:
        self._work = work
        self._superseded = superseded
        self._changed = threading.Condition()
        self._waiting: list[Item] = []  # none or one
        self._stopping = False
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def offer(self, item: Item) -> None:
        """Make this the next item; one that is waiting, or this one if the worker is stopped, is superseded."""
        with self._changed:
            given_up = [item] if self._stopping else self._waiting
            if not self._stopping:
                self._waiting = [item]
                self._changed.notify()
        for old in given_up:
            self._superseded(old)

    def stop(self, timeout: float) -> bool:
        """Give up what is waiting and end after the present item; whether that came to its end in ``timeout`` [s]."""
        with self._changed:
            self._stopping = True
            given_up, self._waiting = self._waiting, []
            self._changed.notify()
        for old in given_up:
            self._superseded(old)
        self._thread.join(timeout)
        return not self._thread.is_alive()

    def _run(self) -> None:
        while True:
            with self._changed:
                # The timeout only bounds the wait; the loop looks again.
                while not (self._waiting or self._stopping):
                    self._changed.wait(timeout=1.0)
                if self._stopping:
                    return
                item = self._waiting.pop()
            self._work(item)
