import dataclasses
import struct
from array import array

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from singulation_core import ResultCode, SingulationError
from singulation_perception.clouds import CloudField, CloudLayout, ScalarType
from singulation_perception.decoding import decode_points

FORMATS = {ScalarType.FLOAT32: "f", ScalarType.FLOAT64: "d"}
SIZES = {ScalarType.FLOAT32: 4, ScalarType.FLOAT64: 8}


def packed(height=2, width=3):
    """A PhoXi-like cloud: packed float32, and its points."""
    points = np.arange(height * width * 3, dtype=np.float32).reshape(height, width, 3) / 10
    fields = tuple(CloudField(name, 4 * place) for place, name in enumerate("xyz"))
    return CloudLayout(height, width, 12, 12 * width, fields), array("B", points.tobytes()), points


def written(layout, values):
    """Bytes of a cloud, number by number, with every other byte set to 0xA5."""
    data = bytearray(b"\xa5" * (layout.row_step * layout.height))
    order = ">" if layout.is_bigendian else "<"
    for row in range(layout.height):
        for column in range(layout.width):
            base = row * layout.row_step + column * layout.point_step
            for field in layout.fields:
                number = values[field.name][row][column]
                struct.pack_into(order + FORMATS[field.datatype], data, base + field.offset, number)
    return bytes(data)


@st.composite
def layouts(draw):
    """Any arrangement of x, y, z within a point: order, gaps, types, padding, byte order."""
    names = draw(st.permutations("xyz"))
    offset, fields = 0, []
    for name in names:
        offset += draw(st.integers(0, 9))
        kind = draw(st.sampled_from(list(FORMATS)))
        fields.append(CloudField(name, offset, kind))
        offset += SIZES[kind]
    step = offset + draw(st.integers(0, 9))
    height, width = draw(st.integers(1, 4)), draw(st.integers(1, 5))
    row = step * width + draw(st.integers(0, 9))
    return CloudLayout(height, width, step, row, tuple(fields), draw(st.booleans()))


numbers = st.floats(width=32, allow_nan=True, allow_infinity=True)


@given(layout=layouts(), data=st.data())
def test_any_layout_gives_the_numbers_that_were_written(layout, data):
    values = {name: [[data.draw(numbers) for _ in range(layout.width)] for _ in range(layout.height)] for name in "xyz"}
    points = decode_points(written(layout, values), layout)
    expected = np.stack([np.array(values[name], dtype=np.float32) for name in "xyz"], axis=-1)
    assert points.dtype == np.float32
    assert points.shape == ((layout.height, layout.width, 3) if layout.height > 1 else (layout.width, 3))
    np.testing.assert_array_equal(points.reshape(expected.shape), expected)


@pytest.mark.parametrize("wrap", [bytes, bytearray, memoryview, lambda data: np.frombuffer(data, np.uint8)])
def test_a_phoxi_cloud_is_not_copied(wrap):
    layout, data, points = packed()
    source = wrap(data)
    decoded = decode_points(source, layout)
    np.testing.assert_array_equal(decoded, points)
    assert np.shares_memory(decoded, np.frombuffer(source, np.uint8))


def test_neighbouring_floats_in_a_larger_point_are_not_copied():
    fields = (CloudField("rgb", 0), *(CloudField(name, 4 + 4 * place) for place, name in enumerate("xyz")))
    layout = CloudLayout(2, 3, 32, 100, fields)
    data = array("B", bytes(200))
    assert np.shares_memory(decode_points(data, layout), np.frombuffer(data, np.uint8))


@pytest.mark.parametrize("shift", [1, 2, 3])
def test_floats_off_their_alignment_are_copied_right(shift):
    layout, data, points = packed()
    decoded = decode_points(memoryview(bytes(shift) + data.tobytes())[shift:], layout)
    assert decoded.flags.aligned
    np.testing.assert_array_equal(decoded, points)


def test_a_double_beyond_float32_is_an_invalid_point_not_a_warning():
    fields = tuple(CloudField(name, 8 * place, ScalarType.FLOAT64) for place, name in enumerate("xyz"))
    layout = CloudLayout(1, 1, 24, 24, fields)
    points = decode_points(struct.pack("<3d", 1e300, -1e300, 0.5), layout)
    np.testing.assert_array_equal(points, [[np.inf, -np.inf, 0.5]])


def field_changed(layout, **changes):
    return dataclasses.replace(layout, fields=(*layout.fields[:2], dataclasses.replace(layout.fields[2], **changes)))


WRONG = {
    "one byte short": lambda layout, data: (layout, data[:-1], "71 bytes of data, but row_step x height = 72"),
    "one byte too many": lambda layout, data: (layout, [*data, 0], "73 bytes of data"),
    "no data at all": lambda layout, data: (layout, b"", "0 bytes of data"),
    "zero width": lambda layout, data: (dataclasses.replace(layout, width=0), data, "width 0"),
    "zero height": lambda layout, data: (dataclasses.replace(layout, height=0), data, "height 0"),
    "negative width": lambda layout, data: (dataclasses.replace(layout, width=-3), data, "width -3"),
    "zero point_step": lambda layout, data: (dataclasses.replace(layout, point_step=0), data, "point_step 0"),
    "short rows": lambda layout, data: (dataclasses.replace(layout, row_step=35), data, "row_step 35 is less than"),
    "no z": lambda layout, data: (dataclasses.replace(layout, fields=layout.fields[:2]), data, "0 fields named 'z'"),
    "no fields": lambda layout, data: (dataclasses.replace(layout, fields=()), data, "0 fields named 'x'"),
    "two z": lambda layout, data: (
        dataclasses.replace(layout, fields=(*layout.fields, layout.fields[2])),
        data,
        "2 fields named 'z'",
    ),
    "z of integers": lambda layout, data: (field_changed(layout, datatype=ScalarType.INT32), data, "datatype 5"),
    "z of no known type": lambda layout, data: (field_changed(layout, datatype=99), data, "datatype 99"),
    "z as an array": lambda layout, data: (field_changed(layout, count=2), data, "count 2"),
    "z beyond the point": lambda layout, data: (field_changed(layout, offset=9), data, "9..13 does not fit"),
    "z before the point": lambda layout, data: (field_changed(layout, offset=-4), data, "-4..0 does not fit"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_contradiction_is_refused_with_its_numbers_and_the_next_cloud_is_read(name):
    layout, data, points = packed()
    broken, wrong_data, text = WRONG[name](layout, data)
    with pytest.raises(SingulationError) as caught:
        decode_points(bytes(wrong_data), broken)
    assert caught.value.code == ResultCode.BAD_LAYOUT
    assert text in caught.value.message
    np.testing.assert_array_equal(decode_points(data, layout), points)


def test_an_empty_cloud_is_no_points():
    with pytest.raises(SingulationError) as caught:
        decode_points(b"", CloudLayout(0, 0, 12, 0, packed()[0].fields))
    assert caught.value.code == ResultCode.NO_POINTS


any_integer = st.one_of(st.integers(-2, 40), st.integers(-(2**31), 2**32))
any_field = st.builds(
    CloudField, st.sampled_from(["x", "y", "z", "", "rgb", "X"]), any_integer, st.integers(0, 9), st.integers(0, 2)
)


@settings(max_examples=400)
@given(
    data=st.binary(max_size=300),
    layout=st.builds(
        CloudLayout,
        any_integer,
        any_integer,
        any_integer,
        any_integer,
        st.lists(any_field, max_size=6).map(tuple),
        st.booleans(),
    ),
)
def test_random_bytes_under_random_layouts_are_read_or_refused(data, layout):
    try:
        points = decode_points(data, layout)
    except SingulationError as error:
        assert error.code in (ResultCode.BAD_LAYOUT, ResultCode.NO_POINTS)
    else:
        assert points.size == 3 * layout.height * layout.width
        points.sum(dtype=np.float64)  # every byte of it can be read


@given(data=st.binary(max_size=200), height=st.integers(1, 4), width=st.integers(1, 5), cut=st.integers(-3, 3))
def test_random_bytes_of_about_the_right_length(data, height, width, cut):
    layout = packed(height, width)[0]
    data = (data * 40)[: layout.row_step * height + cut] if data else b""
    if len(data) == layout.row_step * height:
        assert decode_points(data, layout).size == 3 * height * width
    else:
        with pytest.raises(SingulationError, match="bytes of data"):
            decode_points(data, layout)
