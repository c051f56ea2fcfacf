"""Functions compiled with options that Numba hears of late, or at once, do the same."""

import numpy as np
import pytest

from singulation_core import jit
from singulation_core.jit import (
    compiled,
    compiled_inline,
    compiled_maker,
    compiled_part,
    compiled_part_maker,
    compiled_part_sums,
    compiled_sums,
)


@pytest.fixture(params=["a Numba that was tried", "another"])
def version(request, monkeypatch):
    if request.param == "another":
        monkeypatch.setattr(jit, "_LATE", False)


def made(decorator):
    @compiled_inline
    def twice(x):
        return x + x

    @compiled_part
    def fill(values, x):
        for k in range(len(values)):
            values[k] = twice(x) + k

    @compiled_part_maker
    def filled(count, x):
        values = np.empty(count)
        fill(values, x)
        return values

    @decorator
    def total(count, x):
        return summed(filled(count, x))

    def summed(values):
        result = 0.0
        for k in range(len(values)):
            result += values[k]
        return result

    summed = compiled_part_sums(summed) if decorator is compiled_sums else compiled_part_maker(summed)
    return total


@pytest.mark.usefixtures("version")
def test_what_only_writes_into_arrays_of_its_caller_is_called_from_python():
    def double(values):
        for k in range(len(values)):
            values[k] *= 2.0

    values = np.array((1.0, 2.0))
    compiled(double)(values)
    assert values.tolist() == [2.0, 4.0]


@pytest.mark.usefixtures("version")
@pytest.mark.parametrize("decorator", [compiled_maker, compiled_sums])
def test_parts_of_all_kinds_are_called(decorator):
    assert made(decorator)(4, 0.5) == pytest.approx(4 * 1.0 + 6.0)


@pytest.mark.usefixtures("version")
def test_sums_may_be_added_up_in_any_order_only_where_that_was_said():
    for decorator, wanted in ((compiled_maker, False), (compiled_sums, True)):
        total = made(decorator)
        total.compile("(i8, f8)")
        code = "".join(total.inspect_llvm().values())
        assert ("fadd reassoc" in code) is wanted


def test_the_numba_that_is_installed_was_tried():
    assert jit._LATE
