"""Change of the singulation distance."""

import numpy as np

from singulation_core.jit import compiled_part
from singulation_core.polygon import FloatArray

_MINOR = 0.1  # enough to decide where no push changes what counts fully: room is made then


@compiled_part
def log_change(before: FloatArray, after: FloatArray, moved: FloatArray, counted: FloatArray, floor: float) -> float:
    """Change of the mean log distance of all pairs; those of two blocks that do not count are taken as unchanged, those
    of one that does and one that does not as a tenth.

    Args:
        before, after: (n, 2 or more) positions [m].
        moved: (n,) 0 where both are the same.
        counted: (n,) 1 or 0.
        floor: smallest distance that counts [m].
    """
    n, total = len(before), 0.0
    for i in range(n):
        if moved[i] == 0.0:
            continue
        ratio, minor = 1.0, 1.0
        for j in range(n):
            if j == i or (moved[j] != 0.0 and j < i) or (counted[i] == 0.0 and counted[j] == 0.0):
                continue
            dx, dy = after[j, 0] - after[i, 0], after[j, 1] - after[i, 1]
            ex, ey = before[j, 0] - before[i, 0], before[j, 1] - before[i, 1]
            share = max(dx * dx + dy * dy, floor * floor) / max(ex * ex + ey * ey, floor * floor)
            if counted[i] != 0.0 and counted[j] != 0.0:
                ratio *= share
            else:
                minor *= share
        total += 0.5 * np.log(ratio)
        if minor != 1.0:
            total += 0.5 * _MINOR * np.log(minor)
    return float(total / (0.5 * n * (n - 1)))
