"""Blocks together."""

import numpy as np
import pytest

from singulation_core import Arrangement, InvalidInputError, PlanarObject

TRIANGLE = np.array(((0.0, 0.0), (0.03, 0.0), (0.0, 0.03)))


def block(number, x=0.0):
    return PlanarObject(number, TRIANGLE + (x, 0.0))


def test_centroids_and_radii_are_in_the_order_of_the_objects():
    scene = Arrangement([block(7, 0.1), block(2)], stamp=3.5)
    assert scene.centroids == pytest.approx(np.array(((0.11, 0.01), (0.01, 0.01))))
    assert scene.bounding_radii == pytest.approx([np.hypot(0.02, 0.01)] * 2)
    assert (len(scene), scene.frame, scene.stamp) == (2, "table", 3.5)
    assert scene.index(2) == 1


def test_no_objects_are_an_arrangement_too():
    empty = Arrangement([])
    assert (len(empty), empty.centroids.shape, empty.bounding_radii.shape) == (0, (0, 2), (0,))


def test_arrays_are_read_only_and_the_list_given_is_copied():
    blocks = [block(0)]
    scene = Arrangement(blocks)
    blocks.append(block(1))
    assert len(scene) == 1
    with pytest.raises(ValueError, match="read-only"):
        scene.centroids[0, 0] = 1.0


def test_ids_used_twice_are_refused_and_listed():
    with pytest.raises(InvalidInputError, match=r"\[4\] are used more than once"):
        Arrangement([block(4), block(1), block(4, 0.1)])
    assert len(Arrangement([block(4), block(1)])) == 2


def test_an_unknown_id_is_refused_with_those_there_are():
    with pytest.raises(InvalidInputError, match=r"no object 9; there are \[4, 1\]"):
        Arrangement([block(4), block(1)]).index(9)
