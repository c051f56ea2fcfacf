"""Quasi-random: a random object in a random direction through its centroid (paper, section V-B)."""

from collections.abc import Iterator

import numpy as np

from singulation_planner.candidates import Candidates, through_centroid
from singulation_planner.directions import away
from singulation_planner.policy import NoOptions, Task, policy

_FIRST = 8  # drawn at once; they nearly always contain a feasible push
_DRAWS = 64  # per object; who finds no push in so many will hardly find one


@policy(NoOptions)
def rank(task: Task, options: NoOptions) -> Iterator[Candidates]:
    """Independent draws; directions are drawn against the one that points away from the other objects."""
    scene, random = task.scene, task.random()
    for count in (_FIRST, _DRAWS * len(scene) - _FIRST):
        objects = random.integers(len(scene), size=count)
        angles = random.uniform(0.0, 2.0 * np.pi, count)
        known = {index: away(scene, index) for index in set(objects.tolist())}
        x, y = np.array([known[index] for index in objects.tolist()]).T
        cosines, sines = np.cos(angles), np.sin(angles)
        yield through_centroid(objects, np.column_stack((x * cosines - y * sines, x * sines + y * cosines)))
