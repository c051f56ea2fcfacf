"""What the decorators of ``jit`` ask of Numba."""

from typing import Any, NamedTuple

from numba.core.options import DefaultOptions

ANY_ORDER = {"reassoc", "contract"}


class CompileOptions(NamedTuple):
    """What becomes of a function.

    Args:
        part: only compiled functions call it.
        inline: it is written into its callers.
        any_order: sums may be added up in any order, which makes vector instructions of them.
        counting: it counts references to arrays, as a function that makes some must.
    """

    part: bool = False
    inline: bool = False
    any_order: bool = False
    counting: bool = True


def said_at_once(options: CompileOptions) -> dict[str, Any]:
    """The options as keyword arguments of ``numba.njit``; counting cannot be told to every version."""
    fastmath = ANY_ORDER if options.any_order else False
    told = {"no_cpython_wrapper": options.part, "forceinline": options.inline, "fastmath": fastmath}
    return told | ({"_nrt": options.counting} if hasattr(DefaultOptions, "_nrt") else {})
