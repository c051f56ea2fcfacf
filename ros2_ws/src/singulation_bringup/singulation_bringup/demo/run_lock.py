"""One demo at a time in a clone."""

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from singulation_core import ResultCode, SingulationError


@contextmanager
def only_demo(lock_file: Path) -> Iterator[None]:
    """Hold the lock as long as the block runs; the kernel releases it however the demo ends.

    Raises:
        SingulationError: ``BUSY`` with the process number of the other demo.
    """
    with lock_file.open("a+") as holder:
        try:
            fcntl.flock(holder, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            holder.seek(0)
            other = holder.read().strip() or "unknown"
            raise SingulationError(
                ResultCode.BUSY, f"another demo (process {other}) is running in this clone; wait for its end or stop it"
            ) from None
        holder.truncate(0)
        holder.write(str(os.getpid()))
        holder.flush()
        yield
