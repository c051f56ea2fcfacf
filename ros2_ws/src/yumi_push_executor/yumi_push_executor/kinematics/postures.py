"""Named joint-space postures."""

import numpy as np

from singulation_core.polygon import FloatArray


def _posture(degrees: tuple[float, ...]) -> FloatArray:
    angles = np.deg2rad(np.array(degrees))
    angles.setflags(write=False)
    return angles


# Arms folded beside the body: ABB's Home. Shoulder to flange (ABB axes 1, 2, 7, 3, 4, 5, 6) [rad].
CLEAR_VIEW: dict[str, FloatArray] = {
    "left": _posture((0.0, -130.0, 135.0, 30.0, 0.0, 40.0, 0.0)),
    "right": _posture((0.0, -130.0, -135.0, 30.0, 0.0, 40.0, 0.0)),
}
