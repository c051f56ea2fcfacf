"""Numba's compiler, told some options late, so that a first start compiles less.

Numba remembers what it found out about a call (which of some forty ways to add two numbers fits, what ``np.empty``
compiles to) for each set of options anew. The options here matter only when machine code is made: as long as it does
not know them, all functions share what is remembered. And a function that only others call needs no machine code of its
own, and need not be optimised before it is part of one of them. Together this takes a sixth off the compiling of
singulation_perception, and its functions run as fast.

Numba documents pipelines and passes of one's own ("Customizing the compiler"), but what is replaced of its code library
is internal.
"""

from functools import cache
from typing import Any

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import AnalysisPass, PassManager, register_pass
from numba.core.cpu import FastMathOptions
from numba.core.typed_passes import IRLegalization

from singulation_core.compile_options import ANY_ORDER, CompileOptions


@cache
def late_compiler(options: CompileOptions) -> type[CompilerBase]:
    """The compiler with these options, as ``pipeline_class`` of ``numba.njit``."""

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


def _set(options: CompileOptions, state: Any) -> None:
    flags = state.flags
    flags.forceinline = options.inline
    if options.part:
        flags.no_cpython_wrapper = True
        state.library = _PartLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
    if options.any_order:
        flags.fastmath = FastMathOptions(ANY_ORDER)
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
