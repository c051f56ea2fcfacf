"""Named joint-space postures."""

import numpy as np

from singulation_core.polygon import FloatArray


def _posture(degrees: tuple[float, ...]) -> FloatArray:
    angles = np.deg2rad(np.array(degrees))
    angles.setflags(write=False)
    return angles


def _both(left: tuple[float, ...]) -> dict[str, FloatArray]:
    """A posture of the left arm and its mirror image."""
    mirror = (-1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0)
    return {"left": _posture(left), "right": _posture(tuple(a * b for a, b in zip(left, mirror, strict=True)))}


# Shoulder to flange (ABB axes 1, 2, 7, 3, 4, 5, 6), degrees of the left arm.

# ABB's Home: arms folded in front of the body.
FOLDED = _both((0.0, -130.0, 135.0, 30.0, 0.0, 40.0, 0.0))

# High beside the table, jaws down: nothing of the arm beyond the shoulder comes within 5 cm of the camera's view, and
# moves that are straight in joint space from here to almost everywhere over the workspace stay high above the table.
CLEAR_VIEW = _both((-34.0, -98.0, -8.0, 43.0, 57.0, 114.0, 0.0))

# Postures over the table with the jaws down, one for each way to hold the elbow and the wrist. Inverse kinematics
# starts from them and stays as near to them as the task allows. The first serves nearly the whole workspace.
BRANCHES = (
    _both((-117.0, -67.0, 82.0, -7.0, 127.0, 83.0, 0.0)),
    _both((-92.0, -44.0, 96.0, 13.0, 110.0, 55.0, 0.0)),
    _both((-99.0, -38.0, 120.0, 21.0, -55.0, -43.0, 0.0)),
)
