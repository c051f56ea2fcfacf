"""From a found block to the object that is published."""

import numpy as np
import pytest

from singulation_core import InvalidInputError, PlanarObject
from singulation_perception.found_block import FoundBlock
from singulation_perception.shapes import shape_of

SQUARE = np.array(((0.0, 0.0), (0.04, 0.0), (0.04, 0.04), (0.0, 0.04)))
BENT_BY_ROUNDING = np.array(((0.1, 0.2), (0.25, 0.05), (0.3, 0.0), (0.3, 0.3)))


def found(outline):
    return FoundBlock(outline, shape_of(outline), 0.02, 33, 0.75, 0, 0)


@pytest.mark.parametrize(("outline", "plain"), [(SQUARE, True), (BENT_BY_ROUNDING, False)])
def test_the_object_is_the_one_of_the_outline_whether_that_is_plain_or_has_to_be_looked_at(outline, plain):
    block = found(outline)
    assert (block.shape.area > 0.0) is plain
    item, expected = block.planar_object(5), PlanarObject(5, outline, 0.02, 33, 0.75)
    for name, value in vars(expected).items():
        np.testing.assert_allclose(getattr(item, name), value, rtol=1e-12)
    with pytest.raises(ValueError, match="read-only"):
        item.outline[0, 0] = 1.0


def test_what_is_no_polygon_is_refused():
    with pytest.raises(InvalidInputError, match="object 5: clockwise, need counter-clockwise"):
        found(np.ascontiguousarray(SQUARE[::-1])).planar_object(5)
    assert found(SQUARE).planar_object(5).id == 5
