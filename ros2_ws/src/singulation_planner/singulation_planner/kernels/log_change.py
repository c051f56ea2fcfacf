"""Change of the singulation distance."""

import numpy as np

from singulation_core.jit import compiled_part
from singulation_core.polygon import FloatArray

_MINOR = 0.1  # enough to decide where no push changes what counts fully: room is made then


@compiled_part
def inverse_squares(points: FloatArray, floor: float, inverse: FloatArray) -> None:
    """Write one over the squared distances of all pairs to ``inverse`` (n, n) [1/m^2].

    Args:
        points: (n, 2 or more) positions [m].
        floor: smallest distance that counts [m].
        inverse: its diagonal is not written.
    """
    for i in range(len(points)):
        for j in range(i):
            dx, dy = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1]
            inverse[i, j] = 1.0 / max(dx * dx + dy * dy, floor * floor)
            inverse[j, i] = inverse[i, j]


@compiled_part
def log_change(after: FloatArray, inverse: FloatArray, moved: FloatArray, counted: FloatArray, floor: float) -> float:
    """Change of the mean log distance of all pairs; those of two blocks that do not count are taken as unchanged, those
    of one that does and one that does not as a tenth.

    Args:
        after: (n, 2 or more) positions [m].
        inverse: (n, n) ``inverse_squares`` of where they were before.
        moved: (n,) 0 where both are the same.
        counted: (n,) 1 or 0.
        floor: smallest distance that counts [m].
    """
    n, total = len(after), 0.0
    for i in range(n):
        if moved[i] == 0.0:
            continue
        ratio, minor = 1.0, 1.0
        x, y = after[i, 0], after[i, 1]
        for j in range(n):
            if j == i or (moved[j] != 0.0 and j < i) or (counted[i] == 0.0 and counted[j] == 0.0):
                continue
            dx, dy = after[j, 0] - x, after[j, 1] - y
            share = max(dx * dx + dy * dy, floor * floor) * inverse[i, j]
            if counted[i] != 0.0 and counted[j] != 0.0:
                ratio *= share
            else:
                minor *= share
        total += 0.5 * np.log(ratio)
        if minor != 1.0:
            total += 0.5 * _MINOR * np.log(minor)
    return float(total / (0.5 * n * (n - 1)))
