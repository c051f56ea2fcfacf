"""Where a value ends in a row of bytes, looked for eight bytes at a time.

Byte by byte, finding the ends of the runs of a cloud took as long as computing the coordinates of its points.
"""

import numpy as np
from numpy.typing import NDArray

from singulation_perception.jit import compiled_part

Words = NDArray[np.uint64]

_ONE, _TWO, _THREE, _FOUR, _SEVEN = np.uintp(1), np.uintp(2), np.uintp(3), np.uintp(4), np.uint64(7)
_HALF, _QUARTER, _BYTE = np.uint64(0xFFFFFFFF), np.uint64(0xFFFF), np.uint64(0xFF)
_HALF_BITS, _QUARTER_BITS = np.uint64(32), np.uint64(16)


def repeated(value: int) -> np.uint64:
    """A word of eight bytes that all have one value."""
    return np.uint64(value * 0x0101010101010101)


@compiled_part
def end_of(words: Words, first: np.uintp, size: np.uintp, value: np.uint64) -> np.uintp:
    """The first byte from ``first`` on that is another than ``value`` has; ``size`` if there is none.

    Args:
        words: the bytes, eight in a word, the first one lowest.
        first: byte to begin with, below ``size``.
        size: bytes that count; the words may hold more.
        value: see ``repeated``.
    """
    at, stop = first >> _THREE, (size + np.uintp(7)) >> _THREE
    other = (words[at] ^ value) >> ((np.uint64(first) & _SEVEN) << np.uint64(3))
    byte = first
    if other == 0:
        at += _ONE
        while at < stop and words[at] == value:
            at += _ONE
        if at >= stop:
            return size
        other, byte = words[at] ^ value, at << _THREE
    if other & _HALF == 0:
        byte, other = byte + _FOUR, other >> _HALF_BITS
    if other & _QUARTER == 0:
        byte, other = byte + _TWO, other >> _QUARTER_BITS
    if other & _BYTE == 0:
        byte += _ONE
    return min(byte, size)
