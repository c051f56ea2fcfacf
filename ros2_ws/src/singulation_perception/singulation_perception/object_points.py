"""What stands on the table, in table coordinates, as runs along the rows of the image."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.jit import compiled_part

IntArray = NDArray[np.int32]

ROW, START, STOP, FIRST = 0, 1, 2, 3  # columns of a table of runs
LOW, HIGH, SUM, SQUARES = 0, 1, 2, 3  # columns of the spans of runs


@dataclass(frozen=True, eq=False)
class ObjectPoints:
    """Points above the table, in the order of the image.

    Args:
        xyz: (n, 3) float32 in ``table`` [m].
        runs: (m, 4) int32: row, first column, column after the last, number of the first point. Neighbours inside a
            run differ by at most the height step.
        spans: (m, 4) least and greatest height in each run [m], sum of the heights [m] and of their squares [m^2].
        outside: object points left out because they lie outside the workspace.
    """

    xyz: NDArray[np.float32]
    runs: IntArray
    spans: FloatArray
    outside: int


@compiled_part
def widen(spans: FloatArray, run: int, height: float) -> None:
    """Takes one more point into the span of a run."""
    spans[run, LOW], spans[run, HIGH] = min(spans[run, LOW], height), max(spans[run, HIGH], height)
    spans[run, SUM] += height
    spans[run, SQUARES] += height * height
