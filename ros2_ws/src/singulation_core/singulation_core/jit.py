"""How numerical inner loops are compiled."""

from collections.abc import Callable
from typing import Any, TypeVar

from numba import njit

Function = TypeVar("Function", bound=Callable[..., Any])

_USUAL = {"cache": True, "nogil": True, "error_model": "numpy"}


def compiled(function: Function) -> Function:
    """Compile a function that only reads and writes arrays which its caller holds.

    Such a function needs no reference counts. With them, calls that pass two dozen arrays took three quarters of the
    time of a push; a Numba that does not know the option compiles the same function, only slower.
    """
    try:
        done: Function = njit(**_USUAL, _nrt=False)(function)
    except (KeyError, TypeError):
        done = njit(**_USUAL)(function)
    return done
