"""The decorators of ``singulation_core.jit``, for functions whose whole numbers may also be of NumPy's kinds.

They hide the types of the arguments: a checker would take every ``np.int64`` for a mistake where ``int`` is written,
and for Numba both are the same.
"""

from collections.abc import Callable
from typing import Any

from singulation_core import jit

_Decorator = Callable[[Callable[..., Any]], Any]

compiled_maker: _Decorator = jit.compiled_maker
compiled_sums: _Decorator = jit.compiled_sums
compiled_part: _Decorator = jit.compiled_part
compiled_part_maker: _Decorator = jit.compiled_part_maker
compiled_part_sums: _Decorator = jit.compiled_part_sums
compiled_inline: _Decorator = jit.compiled_inline
