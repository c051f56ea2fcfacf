import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from singulation_core import InvalidInputError
from singulation_perception.decoding import decode_points
from singulation_perception.encoding import encode_coloured, label_colours


@given(height=st.integers(1, 4), width=st.integers(1, 5), seed=st.integers(0, 99))
def test_points_and_colours_can_be_read_back(height, width, seed):
    random = np.random.default_rng(seed)
    points = random.normal(size=(height, width, 3)).astype(np.float32)
    points[0, 0] = np.nan
    labels = random.integers(-1, 4, size=(height, width))
    layout, data = encode_coloured(points, labels)
    np.testing.assert_array_equal(decode_points(data, layout).reshape(points.shape), points)
    colours = np.frombuffer(data, "<u4").reshape(height, width, 4)[..., 3]
    palette = label_colours(int(labels.max()) + 1)
    np.testing.assert_array_equal(colours, palette[labels])


def test_no_two_of_forty_objects_and_the_table_share_a_colour():
    colours = label_colours(40)
    assert len(set(colours.tolist())) == 41
    channels = np.stack([(colours >> shift) & 255 for shift in (16, 8, 0)], axis=-1).astype(int)
    near = np.abs(channels[:-2] - channels[1:-1]).sum(axis=1)
    assert near.min() > 60


def test_a_flat_cloud_without_objects_has_one_colour():
    layout, data = encode_coloured(np.zeros((5, 3)), np.full(5, -1))
    assert (layout.height, layout.width, layout.point_step) == (1, 5, 16)
    assert len(set(np.frombuffer(data, "<u4").reshape(5, 4)[:, 3])) == 1


@pytest.mark.parametrize(("points", "labels"), [((4, 3), (5,)), ((4, 2), (4,)), ((2, 2, 2, 3), (2, 2, 2))])
def test_shapes_that_do_not_fit(points, labels):
    with pytest.raises(InvalidInputError, match="shape"):
        encode_coloured(np.zeros(points), np.zeros(labels, dtype=int))
    encode_coloured(np.zeros((4, 3)), np.zeros(4, dtype=int))
