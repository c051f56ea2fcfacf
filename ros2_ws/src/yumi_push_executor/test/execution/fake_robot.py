"""A scripted robot: arms that follow trajectories as a JointTrajectoryController makes them, and short motions."""

from dataclasses import dataclass, field

import numpy as np

from yumi_push_executor.kinematics import CLEAR_VIEW, YumiArm
from yumi_push_executor.supervision import JointRange, Phase, Segment, Trajectory

ARMS = ("left", "right")
CYCLE = 0.008  # s; 125 Hz
MODEL = {arm: YumiArm(arm) for arm in ARMS}
RANGES = {arm: JointRange(MODEL[arm].lower, MODEL[arm].upper) for arm in ARMS}
SPEEDS = {arm: MODEL[arm].velocity for arm in ARMS}


def smooth(start, end, duration):
    """From rest to rest with the fifth-order polynomial of least jerk, as ten points with velocities."""
    times = np.linspace(0.0, duration, 11)
    u = (times / duration)[:, None]
    way = np.asarray(end) - np.asarray(start)
    positions = np.asarray(start) + way * (10 * u**3 - 15 * u**4 + 6 * u**5)
    velocities = way * (30 * u**2 - 60 * u**3 + 30 * u**4) / duration
    return Trajectory(times, positions, velocities)


def offsets(*values):
    return np.array((*values, *[0.0] * (7 - len(values))))


HOME = {arm: np.array(CLEAR_VIEW[arm]) for arm in ARMS}
ABOVE = HOME["left"] + offsets(0.3, 0.4, -0.2, 0.1, 0.3)
START = ABOVE + offsets(0.05, 0.1)
END = START + offsets(0.15, 0.05, 0.1)
HIGH = END - offsets(0.05, 0.1)


def push_segments(arm="left", opening=0.02, turn=1.0):
    """Six segments like those of a push; ``turn`` scales all distances."""
    points = [HOME[arm] + turn * (point - HOME["left"]) for point in (HOME["left"], ABOVE, START, END, HIGH)]
    above, start, end, high = points[1:]
    return (
        Segment(Phase.GRIPPER, arm, opening=opening),
        Segment(Phase.APPROACH, arm, smooth(HOME[arm], above, 1.0)),
        Segment(Phase.DESCEND, arm, smooth(above, start, 0.3)),
        Segment(Phase.PUSH, arm, smooth(start, end, 1.0)),
        Segment(Phase.RETREAT, arm, smooth(end, high, 0.3)),
        Segment(Phase.CLEAR_VIEW, arm, smooth(high, HOME[arm], 1.0)),
    )


@dataclass
class FakeArm:
    """Follows trajectories with a first-order lag; ``stuck`` (of all or of each joint) makes it stand,
    ``fastest`` limits its joint speeds,
    ``pull`` is how far it is pressed away from its command."""

    q: np.ndarray
    lag: float = 0.02
    latency: float = 0.006
    fastest: float = 3.0
    stuck: bool | np.ndarray = False
    deaf: bool = False
    pull: np.ndarray = field(default_factory=lambda: np.zeros(7))
    trajectory: Trajectory | None = None
    started: float = 0.0
    reference: np.ndarray | None = None

    def __post_init__(self):
        self.v = np.zeros(7)
        self.reference = np.array(self.q)
        self.pending, self.references = [], []
        self.pulled = np.zeros(7)

    def order(self, trajectory, now):
        if not self.deaf:
            self.pending.append((now + self.latency, trajectory))

    def cycle(self, now, enabled=True):
        if not enabled:  # brakes, and forgets what it was told
            self.pending, self.trajectory = [], None
            self.v = np.sign(self.v) * np.maximum(np.abs(self.v) - 20.0 * CYCLE, 0.0)
            self.q = self.q + self.v * CYCLE
            self.reference = self.q
            return
        while self.pending and self.pending[0][0] <= now:
            self.started, trajectory = self.pending.pop(0)
            self.trajectory = self._from_here(trajectory)
        if self.trajectory is not None:
            elapsed, plan = now - self.started, self.trajectory
            self.reference = plan.end if elapsed >= plan.duration else plan.sample(elapsed)[0][0]
        self.references.append(self.reference)
        if not np.array_equal(self.pull, self.pulled):
            self.pulled = self.pulled + np.clip(self.pull - self.pulled, -0.6 * CYCLE, 0.6 * CYCLE)
        wanted = (self.reference + self.pulled - self.q) / max(self.lag, CYCLE)
        self.v = np.where(self.stuck, 0.0, np.minimum(np.maximum(wanted, -self.fastest), self.fastest))
        self.q = self.q + self.v * CYCLE

    def _from_here(self, trajectory):
        if trajectory.times[0] == 0.0:
            return trajectory
        return Trajectory(
            np.concatenate(((0.0,), trajectory.times)),
            np.vstack((self.q, trajectory.positions)),
            np.vstack((self.v, trajectory.velocities)),
        )
