"""Where scenes are worked on: the cores of this machine, or a Dask cluster."""

import itertools
import multiprocessing
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from typing import TypeVar

from singulation_core import ResultCode, SingulationError

Task = TypeVar("Task")
Result = TypeVar("Result")
Engine = Callable[[Callable[[Task], Result], Sequence[Task]], Iterator[Result]]

_PATIENCE = 10.0  # s that a scheduler may take to answer
_AHEAD = 4  # tasks in the queue for each worker


def on_cores(workers: int, function: Callable[[Task], Result], tasks: Sequence[Task]) -> Iterator[Result]:
    """Results as they become known, in any order.

    Raises:
        SingulationError: ``INTERNAL`` if a worker process dies (out of memory, killed).
    """
    if workers == 1:
        yield from map(function, tasks)
        return
    context = multiprocessing.get_context("spawn")  # forks of a process with threads may lock up
    pool = ProcessPoolExecutor(workers, mp_context=context, initializer=_leave_interrupts_to_the_parent)
    try:
        waiting = iter(tasks)
        running = {pool.submit(function, task) for task in itertools.islice(waiting, _AHEAD * workers)}
        while running:
            finished, running = wait(running, return_when=FIRST_COMPLETED)
            running |= {pool.submit(function, task) for task in itertools.islice(waiting, len(finished))}
            yield from _results(finished)
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _results(finished: set[Future[Result]]) -> Iterator[Result]:
    try:
        for future in finished:
            yield future.result()
    except BrokenProcessPool as error:
        raise SingulationError(ResultCode.INTERNAL, f"a worker process ended: {error}; run again to go on") from error


def _leave_interrupts_to_the_parent() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def on_dask(address: str, function: Callable[[Task], Result], tasks: Sequence[Task]) -> Iterator[Result]:
    """The same on the workers of a Dask scheduler, which must have this package installed.

    Args:
        address: of the scheduler, ``tcp://host:8786``.
        function: applied to each task.
        tasks: any number; few are in flight at a time.

    Raises:
        SingulationError: ``TIMEOUT`` if no scheduler answers, ``NOT_READY`` if it has no workers, ``INTERNAL`` if they
            die.
    """
    import distributed  # noqa: PLC0415  takes a second, and few runs need it

    try:
        client = distributed.Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise SingulationError(ResultCode.TIMEOUT, f"no Dask scheduler at {address!r}: {error}") from error
    with client:
        threads = sum(client.nthreads().values())
        if threads == 0:
            raise SingulationError(ResultCode.NOT_READY, f"the Dask scheduler at {address!r} has no workers")
        waiting = iter(tasks)
        first = [client.submit(function, task, pure=False) for task in itertools.islice(waiting, _AHEAD * threads)]
        done = distributed.as_completed(first, loop=client.loop)
        try:
            for future in done:
                for task in itertools.islice(waiting, 1):
                    done.add(client.submit(function, task, pure=False))
                yield future.result()
        except (distributed.KilledWorker, distributed.CancelledError) as error:
            raise SingulationError(
                ResultCode.INTERNAL, f"workers of {address!r} ended: {error}; run again to go on"
            ) from error
