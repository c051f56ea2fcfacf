"""Asking for memory before it is needed.

A processor fetches ahead by itself where reading goes on in a line. Here it jumps from one stretch of a row to one in
the next, and would wait for the first words of each.
"""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

LINE = 16  # numbers of four bytes in what is fetched at once


@intrinsic
def prefetch(_: Any, numbers: Any, index: Any) -> Any:
    """Begins to fetch ``numbers[index]``, a one-dimensional contiguous array's; a wrong index does no harm."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        array = cgutils.create_struct_proxy(signature.args[0])(context, builder, arguments[0])
        place = builder.bitcast(builder.gep(array.data, [arguments[1]]), cgutils.voidptr_t)
        word = ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), (cgutils.voidptr_t, word, word, word))
        function = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch.p0i8")
        read, second_cache, data = word(0), word(2), word(1)  # more can be under way than to the first cache
        builder.call(function, [place, read, second_cache, data])
        return context.get_dummy_value()

    return types.void(numbers, types.intp), generate
