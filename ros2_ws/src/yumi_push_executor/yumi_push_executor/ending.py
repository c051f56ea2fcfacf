"""How a push ended."""

import math
from dataclasses import dataclass

import numpy as np

from singulation_core import Arrangement, ResultCode
from singulation_core.polygon import FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class Ending:
    """The one ending of a push.

    Args:
        code: one of the result codes.
        text: why.
        reached: (3,) where the tip of the arm that pushed is now, in the table frame [m]; NaN if no arm was chosen.
        before: the arrangement that was kept clear of, None if it did not come to that.
        defect: what was thrown, if the code is ``INTERNAL``.
        planning_time: of the motion [s], NaN if none was planned.
    """

    code: ResultCode
    text: str
    reached: FloatArray
    before: Arrangement | None = None
    defect: Exception | None = None
    planning_time: float = math.nan

    @classmethod
    def failed(cls, code: ResultCode, text: str) -> "Ending":
        """It did not come to anything."""
        return cls(code, text, np.full(3, np.nan))


@dataclass(slots=True)
class Attempt:
    """What became known on the way, for the ending."""

    arm: str = ""
    planning_time: float = math.nan
    before: Arrangement | None = None
