"""The retreat after a fault: straight up from wherever the tool is."""

import numpy as np

from singulation_core import ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics import YumiArm
from yumi_push_executor.supervision import Trajectory

_STEP = 0.005  # m between way-points
_SHORTEST = 0.01  # m; less than this is no retreat
_JUMP = 0.3  # rad between two way-points: another branch


def plan_lift(arm: YumiArm, q: FloatArray, up: FloatArray, rise: float, speed: float) -> Trajectory:
    """Lift the tool without turning it, as far as the arm reaches.

    Args:
        arm: that is to be lifted.
        q: (7,) where it stands [rad].
        up: (3,) unit normal of the table in ``yumi_body``.
        rise: wanted height gain [m].
        speed: of the tool in the middle of the way [m/s].

    Raises:
        SingulationError: ``UNREACHABLE``; it cannot even go up by a centimetre.
    """
    points = [np.clip(q, arm.lower, arm.upper)]
    pose = arm.forward(points[0])
    for _ in range(max(1, round(rise / _STEP))):
        pose[:3, 3] += _STEP * up
        try:
            solution = arm.inverse(pose, points[-1])
        except SingulationError:
            break
        if not (float(np.abs(solution - points[-1]).max()) <= _JUMP):
            break
        points.append(solution)
    height = (len(points) - 1) * _STEP
    if not (height >= _SHORTEST):
        raise SingulationError(
            ResultCode.UNREACHABLE, f"the {arm.name} arm reaches {height * 1e3:.0f} mm above where it is"
        )
    return _timed(np.array(points), _slow_enough(np.array(points), height, speed, arm.velocity))


def _slow_enough(points: FloatArray, height: float, speed: float, fastest: FloatArray) -> float:
    """Duration at which the tool keeps its speed and the joints half of theirs [s]."""
    steepest = np.abs(np.gradient(points, axis=0)).max(axis=0) * (len(points) - 1)  # rad per whole way
    return 1.5 * max(height / speed, float((steepest / (0.5 * fastest)).max()))


def _timed(points: FloatArray, duration: float) -> Trajectory:
    """From rest to rest: the way is 3 u^2 - 2 u^3 of the time."""
    times = duration * np.linspace(0.0, 1.0, len(points))
    u = times / duration
    way = (3.0 * u**2 - 2.0 * u**3) * (len(points) - 1)
    slopes = np.gradient(points, axis=0)
    columns = range(points.shape[1])
    knots = np.arange(len(points))
    positions = np.column_stack([np.interp(way, knots, points[:, column]) for column in columns])
    rates = np.column_stack([np.interp(way, knots, slopes[:, column]) for column in columns])
    velocities = rates * ((6.0 * u - 6.0 * u**2) * (len(points) - 1) / duration)[:, None]
    return Trajectory(times, positions, velocities)
