"""LZF decompression, the coding of PCD ``binary_compressed`` (Marc Lehmann's liblzf)."""

import numpy as np
from numpy.typing import NDArray

from singulation_core import InvalidInputError
from singulation_perception.jit import compiled_maker

_CORRUPT = -1


def decompress_lzf(packed: NDArray[np.uint8], size: int) -> NDArray[np.uint8]:
    """The (size,) bytes that were packed.

    Raises:
        InvalidInputError: the stream is damaged or holds another number of bytes.
    """
    unpacked = np.empty(size, dtype=np.uint8)
    written = _unpack(packed, unpacked)
    if written != size:
        text = "it is damaged" if written == _CORRUPT else f"it holds {written} bytes"
        raise InvalidInputError(f"compressed data: {size} bytes were announced, but {text}")
    return unpacked


@compiled_maker
def _unpack(source: NDArray[np.uint8], target: NDArray[np.uint8]) -> int:
    """Number of bytes written, or ``_CORRUPT`` if a run leads outside either buffer.

    A control byte below 32 announces that many + 1 literal bytes; else its upper three bits are the length - 2 of
    a repetition (7: one more byte to add), its lower five and the next byte how far back it starts.
    """
    read, written = 0, 0
    while read < len(source):
        control = int(source[read])
        read += 1
        if control < 32:
            length = control + 1
            if read + length > len(source) or written + length > len(target):
                return _CORRUPT
            target[written : written + length] = source[read : read + length]
            read += length
        else:
            length = control >> 5
            if read + (2 if length == 7 else 1) > len(source):
                return _CORRUPT
            if length == 7:
                length += int(source[read])
                read += 1
            start = written - ((control & 31) << 8) - int(source[read]) - 1
            read += 1
            length += 2
            if start < 0 or written + length > len(target):
                return _CORRUPT
            for place in range(length):  # byte by byte: a repetition may overlap itself
                target[written + place] = target[start + place]
        written += length
    return written
