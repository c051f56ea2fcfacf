"""Ends of runs of bytes, against looking at one byte after another."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from singulation_perception.byte_scan import end_of, repeated

BYTES = st.lists(st.tuples(st.integers(0, 2), st.integers(1, 20)), min_size=1, max_size=8).map(
    lambda runs: [value for value, length in runs for _ in range(length)]
)


def slow_end(values, first, value):
    while first < len(values) and values[first] == value:
        first += 1
    return first


@given(values=BYTES, data=st.data())
def test_the_end_is_the_first_other_byte_whatever_lies_beyond_those_that_count(values, data):
    room = np.full(-(-len(values) // 8) * 8, data.draw(st.integers(0, 2)), dtype=np.uint8)
    room[: len(values)] = values
    first, value = data.draw(st.integers(0, len(values) - 1)), data.draw(st.integers(0, 2))
    found = end_of.py_func(room.view(np.uint64), np.uintp(first), np.uintp(len(values)), repeated(value))
    assert found == slow_end(values, first, value)
