"""How numerical inner loops are compiled."""

from collections.abc import Callable
from typing import Any, TypeVar

from numba import njit
from numba.core.dispatcher import Dispatcher

from singulation_core.claimed_cache import ClaimedCache

Function = TypeVar("Function", bound=Callable[..., Any])

USUAL = {"nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}


def compiled(function: Function) -> Function:
    """Compile a function that Python calls and that only reads and writes arrays which its caller holds.

    Such a function needs no reference counts. With them, calls that pass two dozen arrays took three quarters of the
    time of a push; a Numba that does not know the option compiles the same function, only slower.
    """
    return kept(_compiled(function))


def compiled_part(function: Function) -> Function:
    """The same for a function that only compiled ones call: it is kept on disk as part of them.

    Without an entry for Python and a cache of its own it compiles in a fraction of the time.
    """
    return _compiled(function, no_cpython_wrapper=True)


def compiled_inline(function: Function) -> Function:
    """As ``compiled_part``, written into its callers: worth it where there is one, or it is short.

    A call that passes on a few tuples of arrays copies some 200 words; for contacts of two blocks that took a third of
    the time of a push.
    """
    return _compiled(function, no_cpython_wrapper=True, forceinline=True)


def compiled_maker(function: Function) -> Function:
    """As ``compiled``, for a function that makes arrays: it counts references."""
    done: Function = njit(**USUAL)(function)
    return kept(done)


def kept(function: Function) -> Function:
    """Keep on disk what is compiled of a function, in a cache that processes share."""
    if isinstance(function, Dispatcher):  # a plain function where Numba is switched off
        function._cache = ClaimedCache(function.py_func)  # type: ignore[attr-defined]  # where enable_caching puts it
    return function


def _compiled(function: Function, **options: bool) -> Function:
    try:
        done: Function = njit(**USUAL, **options, _nrt=False)(function)
    except (KeyError, TypeError):
        done = njit(**USUAL, **options)(function)
    return done
