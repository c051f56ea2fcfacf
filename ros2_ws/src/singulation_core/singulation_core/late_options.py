"""Options of compiled functions that Numba hears of late, so that a first start compiles less.

Numba remembers what it found out about a call (which of some forty ways to add two numbers fits, what ``np.empty``
compiles to) for each set of options anew. The options here matter only when machine code is made: without them until
then, all functions share what is remembered. And a function that only others call needs no machine code of its own,
and need not be optimised before it is part of one of them. Together this takes a sixth off the compiling of
singulation_perception, and its functions run as fast.

Numba documents pipelines and passes of one's own ("Customizing the compiler"), but the methods of its code library that
are replaced here are internal. So this is done with the versions that it was tried with; any other hears of the options
at once and compiles longer.
"""

from functools import cache
from typing import Any, NamedTuple

from numba import version_info
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import AnalysisPass, PassManager, register_pass
from numba.core.cpu import FastMathOptions
from numba.core.typed_passes import IRLegalization

_TRIED = ((0, 68),)
_ANY_ORDER = {"reassoc", "contract"}


class LateOptions(NamedTuple):
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


def arguments(options: LateOptions) -> dict[str, Any]:
    """Keyword arguments of ``numba.njit`` for these options."""
    if version_info.short in _TRIED:
        return {"pipeline_class": _pipeline(options)}
    fastmath = _ANY_ORDER if options.any_order else False
    return {"no_cpython_wrapper": options.part, "forceinline": options.inline, "fastmath": fastmath}


@cache
def _pipeline(options: LateOptions) -> type[CompilerBase]:

    @register_pass(mutates_CFG=False, analysis_only=True)
    class Set(AnalysisPass):  # type: ignore[misc]  # Numba has no types
        _name = f"late_{options}"

        def __init__(self) -> None:
            super().__init__()

        def run_pass(self, state: Any) -> bool:
            _set(options, state)
            return True

    class Late(CompilerBase):  # type: ignore[misc]
        def define_pipelines(self) -> list[PassManager]:
            passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
            passes.add_pass_after(Set, IRLegalization)
            passes.finalize()
            return [passes]

    return Late


def _set(options: LateOptions, state: Any) -> None:
    flags = state.flags
    flags.forceinline = options.inline
    if options.part:
        flags.no_cpython_wrapper = True
        state.library = _PartLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
    if options.any_order:
        flags.fastmath = FastMathOptions(_ANY_ORDER)
        state.targetctx = state.targetctx.subtarget(fastmath=flags.fastmath)
    if not options.counting:
        flags.nrt = False
        state.targetctx = state.targetctx.subtarget(enable_nrt=False)


class _PartLibrary(JITCodeLibrary):  # type: ignore[misc]
    """Code that is linked into that of other functions, and is optimised and translated there."""

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        self._ensure_finalized()
        return 0  # none

    @property
    def codegen(self) -> "type[_NoMachineCode]":
        return _NoMachineCode


class _NoMachineCode:
    @staticmethod
    def set_env(name: str, environment: object) -> None:
        """The environment is for what Python calls."""
