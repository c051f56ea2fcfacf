"""The warm-up of a node that calls compiled functions: what it says, who helps, what becomes of the garbage."""

import gc
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any, TypeVar

from singulation_core.compiling import compiling_told, helpers

Result = TypeVar("Result")


def warm(node: Any, warm_up: Callable[[], Result], takes: str, module: str | None = None) -> Result:
    """Run a warm-up; the log says when it has to compile and how long it took.

    Args:
        node: a managed node.
        warm_up: loads, or compiles, what the node needs.
        takes: the time that compiling everything takes, for the log.
        module: whose ``STEPS`` processes of their own may compile ahead, on further cores.

    Returns:
        What the warm-up returns.
    """
    started = time.monotonic()
    with ExitStack() as stack:

        def begun() -> None:
            node.get_logger().info(f"compiling what is not kept on disk yet; all of it takes {takes}, once")
            if module is not None:
                stack.enter_context(helpers(module))

        stack.enter_context(_no_garbage_collection(node.own_process))
        stack.enter_context(compiling_told(begun))
        result = warm_up()
    node.get_logger().info(f"warm after {time.monotonic() - started:.1f} s")
    return result


@contextmanager
def _no_garbage_collection(own_process: bool) -> Iterator[None]:
    """Nearly everything that is loaded stays.

    Looking for garbage in it costs time now, and later on would stop all threads for 0.1 s: in a process of its own the
    node need never look there again.
    """
    if not own_process:
        yield
        return
    gc.disable()
    try:
        yield
    finally:
        gc.collect()
        gc.freeze()
        gc.enable()
