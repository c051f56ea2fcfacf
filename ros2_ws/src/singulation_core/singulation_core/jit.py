"""How numerical inner loops are compiled.

The first start compiles all of them, and Numba's time goes with the length of the code. So entries for C callers are
left out everywhere, and entries for Python and a cache of their own where only compiled code calls. Three habits help
as much: ``math.sqrt`` instead of ``np.sqrt``, ``x * x`` instead of ``x ** 2``, and indices instead of views of rows.
"""

from collections.abc import Callable
from typing import Any, TypeVar

from numba import njit, version_info
from numba.core.dispatcher import Dispatcher

from singulation_core.claimed_cache import ClaimedCache
from singulation_core.compile_options import CompileOptions, said_at_once

_LATE = version_info.short == (0, 68)  # another Numba may lack what the late compiler replaces
if _LATE:
    from singulation_core.late_compiler import late_compiler

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """Compile a function that Python calls and that only reads and writes arrays which its caller holds.

    Such a function needs no reference counts. With them, calls that pass two dozen arrays took three quarters of the
    time of a push.
    """
    return _kept(_compiled(function, CompileOptions(counting=False)))


def compiled_maker(function: Function) -> Function:
    """As ``compiled``, for a function that makes arrays: it counts references."""
    return _kept(_compiled(function, CompileOptions()))


def compiled_sums(function: Function) -> Function:
    """As ``compiled_maker``, where sums may be added up in any order: that makes vector instructions of them."""
    return _kept(_compiled(function, CompileOptions(any_order=True)))


def compiled_part(function: Function) -> Function:
    """As ``compiled``, for a function that only compiled ones call: it is kept on disk as part of them.

    Without an entry for Python and a cache of its own it compiles in a fraction of the time. Python must not call it.
    """
    return _compiled(function, CompileOptions(part=True, counting=False))


def compiled_part_maker(function: Function) -> Function:
    """As ``compiled_part``, for a function that makes arrays."""
    return _compiled(function, CompileOptions(part=True))


def compiled_part_sums(function: Function) -> Function:
    """As ``compiled_sums``, for a function that only compiled ones call; it is written into its callers.

    A number that is known there, such as the words between two points, is then known inside.
    """
    return _compiled(function, CompileOptions(part=True, inline=True, any_order=True))


def compiled_inline(function: Function) -> Function:
    """As ``compiled_part``, written into its callers: worth it where there is one, or it is short.

    A call that passes on a few tuples of arrays copies some 200 words; for contacts of two blocks that took a third of
    the time of a push.
    """
    return _compiled(function, CompileOptions(part=True, inline=True, counting=False))


def _compiled(function: Function, options: CompileOptions) -> Function:
    told = {"pipeline_class": late_compiler(options)} if _LATE else said_at_once(options)
    done: Function = njit(nogil=True, error_model="numpy", no_cfunc_wrapper=True, **told)(function)
    return done


def _kept(function: Function) -> Function:
    """Keep on disk what is compiled of a function, in a cache that processes share."""
    if isinstance(function, Dispatcher):  # a plain function where Numba is switched off
        function._cache = ClaimedCache(function.py_func)  # type: ignore[attr-defined]  # where enable_caching puts it
    return function
