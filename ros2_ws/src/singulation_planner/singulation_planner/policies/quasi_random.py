"""Quasi-random: a random object in a random direction through its centroid (paper, section V-B)."""

from collections.abc import Iterator

import numpy as np

from singulation_planner.candidates import Candidates, through_centroid
from singulation_planner.directions import away
from singulation_planner.policy import NoOptions, Task, policy

_PORTION = 8
_DRAWS = 64  # per object; who finds no push in so many will hardly find one


@policy(NoOptions)
def rank(task: Task, options: NoOptions) -> Iterator[Candidates]:
    """Independent draws; directions are drawn against the one that points away from the other objects."""
    scene, random = task.scene, task.random()
    for _ in range(_DRAWS * len(scene) // _PORTION):
        objects = random.integers(len(scene), size=_PORTION)
        angles = random.uniform(0.0, 2.0 * np.pi, _PORTION)
        first = np.array([away(scene, index) for index in objects.tolist()])
        cosines, sines = np.cos(angles), np.sin(angles)
        x, y = first[:, 0], first[:, 1]
        yield through_centroid(objects, np.column_stack((x * cosines - y * sines, x * sines + y * cosines)))
