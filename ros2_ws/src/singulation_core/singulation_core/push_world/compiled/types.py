"""Arrays that the compiled functions share. Lengths in inner units, in the frame of a push (+x is its direction)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray

IntArray = NDArray[np.int64]


class Shapes(NamedTuple):
    """What does not change: n blocks, and the polygon of the pusher (if it has one) as shape n."""

    firsts: IntArray  # (n + 2,) where each outline begins in the arrays of vertices
    vertices: FloatArray  # (v, 2) outlines around their centroids
    normals: FloatArray  # (v, 2) outward, of the edge that begins at the vertex
    radii: FloatArray  # (n + 1,) around the centroid
    inner_radii: FloatArray  # (n + 1,) distance of the origin to the nearest edge
    mobility: FloatArray  # (n + 1, 2) 1 / mass, 1 / moment of inertia; 0 for the pusher
    discs: FloatArray  # (d, 3) round parts of the pusher: x, y, radius


class State(NamedTuple):
    """Where everything is; the pusher's pose is that of shape n."""

    poses: FloatArray  # (n + 1, 3) x, y, angle
    corners: FloatArray  # (v, 2) vertices at these poses
    outward: FloatArray  # (v, 2) normals at these poses
    motion: FloatArray  # (n + 1, 3) displacement in this step
    slack: FloatArray  # (n + 1, n + 1) overlap that was there at first and counts as touching
    axes: IntArray  # (n + 1, n + 1) edge that separated a pair last
    memory: FloatArray  # (n + 1, n + 1, 2, 3) key, normal and tangential impulse of a pair's contacts


class Numbers(NamedTuple):
    """Settings, see ``PushPhysics``."""

    friction: float
    healing: float  # share of an overlap that opens in a step
    healing_at_rest: float  # the same while the pusher stands
    slop: float
    step: float
    touching: float  # overlap of pusher and block at the start that is not yet an overlap
    iterations: int
    settle_steps: int
    retreat: float  # how far a pusher that would start on a block is moved back


class Scratch(NamedTuple):
    """Room to work in, so that nothing is allocated on the way."""

    island: IntArray  # (2, n) blocks that move with the pusher, in the order found; for each block: 1 found, 2 complete
    points: FloatArray  # (2, 4) x, y, gap, key of contacts
    normal: FloatArray  # (2,)


class Contacts(NamedTuple):
    """Contacts of a step; the normal points from the first to the second body."""

    bodies: IntArray  # (c, 3) first, second, slot in the memory of the pair
    normal: FloatArray  # (c, 2)
    arms: FloatArray  # (c, 4) from the two centroids to the contact
    gap: FloatArray  # (c,)
    key: FloatArray  # (c,) names the features that touch
    impulse: FloatArray  # (c, 2) normal, tangential
    resistance: FloatArray  # (c, 2) 1 / effective mobility: normal, tangential
    total: IntArray  # (1,) how many there are
