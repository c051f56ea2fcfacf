"""How the functions of this package are compiled.

The first start compiles all of it, and Numba's time goes with the length of the code. So entries for C callers are left
out everywhere, and entries for Python and a cache of their own where only compiled code calls. Three habits help as
much: ``math.sqrt`` instead of ``np.sqrt``, ``x * x`` instead of ``x ** 2``, and indices instead of views of rows.
"""

from collections.abc import Callable
from typing import Any

from numba import njit

from singulation_core.jit import USUAL, kept

_ANY_ORDER = {"reassoc", "contract"}


def compiled(function: Callable[..., Any]) -> Any:
    """Compile a function that Python calls; kept on disk."""
    return kept(njit(**USUAL)(function))


def compiled_sums(function: Callable[..., Any]) -> Any:
    """As ``compiled``, where sums may be added up in any order: that makes vector instructions of them."""
    return kept(njit(**USUAL, fastmath=_ANY_ORDER)(function))


def compiled_part_sums(function: Callable[..., Any]) -> Any:
    """As ``compiled_sums``, for a function that only compiled functions call; kept on disk as part of them."""
    return njit(**USUAL, fastmath=_ANY_ORDER, no_cpython_wrapper=True)(function)


def compiled_part(function: Callable[..., Any]) -> Any:
    """Compile a function that only compiled functions call; kept on disk as part of them."""
    return njit(**USUAL, no_cpython_wrapper=True)(function)


def compiled_plain(function: Callable[..., Any]) -> Any:
    """As ``compiled_part``, for a function that makes no array and returns numbers or nothing.

    It needs no reference counts, which cost more than a short function does. A Numba that does not know the option
    compiles the same, only slower.
    """
    try:
        return njit(**USUAL, no_cpython_wrapper=True, _nrt=False)(function)
    except (KeyError, TypeError):
        return compiled_part(function)
