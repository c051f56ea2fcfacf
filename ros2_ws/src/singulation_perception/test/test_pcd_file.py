import struct
from pathlib import Path

import numpy as np
import open3d
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from singulation_core import InvalidInputError, ResultCode, SingulationError
from singulation_perception.cloud_files import read_cloud_file
from singulation_perception.decoding import decode_points
from singulation_perception.lzf import decompress_lzf

RECORDED = sorted((Path(__file__).parents[5] / "shared" / "data" / "mosd").glob("*.pcd"))


def literal_lzf(data):
    """LZF without repetitions: blocks of up to 32 bytes, each behind its length - 1."""
    return b"".join(bytes([len(data[at : at + 32]) - 1]) + data[at : at + 32] for at in range(0, len(data), 32))


def header(data, *, width, height, fields="x y z", sizes="4 4 4", types="F F F", counts="1 1 1", points=None):
    return (
        f"# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {fields}\nSIZE {sizes}\nTYPE {types}\n"
        f"COUNT {counts}\nWIDTH {width}\nHEIGHT {height}\nVIEWPOINT 0 0 0 1 0 0 0\n"
        f"POINTS {width * height if points is None else points}\nDATA {data}\n"
    ).encode()


def points_of(path):
    cloud = read_cloud_file(path)
    return decode_points(cloud.data, cloud.layout)


@pytest.fixture
def points():
    made = np.random.default_rng(5).normal(size=(4, 6, 3)).astype(np.float32)
    made[1, 2] = np.nan
    return made


@pytest.fixture
def good(tmp_path, points):
    """A binary file that can be read."""
    path = tmp_path / "good.pcd"
    path.write_bytes(header("binary", width=6, height=4) + points.tobytes())
    return path


def compressed(points):
    columns = points.reshape(-1, 3).T.tobytes()
    body = literal_lzf(columns)
    return header("binary_compressed", width=6, height=4) + struct.pack("<II", len(body), len(columns)) + body


def ascii_lines(points):
    return "\n".join(" ".join(f"{value:.9g}" for value in row) for row in points.reshape(-1, 3)).encode() + b"\n"


def test_the_three_encodings_keep_image_order_and_missing_points(tmp_path, points, good):
    files = {
        "good": good.read_bytes(),
        "packed": compressed(points),
        "text": header("ascii", width=6, height=4) + ascii_lines(points),
    }
    for name, content in files.items():
        path = tmp_path / f"{name}.pcd"
        path.write_bytes(content)
        np.testing.assert_array_equal(points_of(path), points)


def test_doubles_padding_and_arrays_among_the_fields(tmp_path):
    kinds = [("normal", "<f4", 3), ("x", "<f8"), ("_", "u1", 4), ("y", "<f8"), ("z", "<f8"), ("label", "<u2")]
    records = np.zeros(5, dtype=kinds)
    for place, name in enumerate("xyz"):
        records[name] = np.arange(5) + 10 * place
    names = "normal x _ y z label"
    head = header(
        "binary", width=5, height=1, fields=names, sizes="4 8 1 8 8 2", types="F F U F F U", counts="3 1 4 1 1 1"
    )
    path = tmp_path / "odd.pcd"
    path.write_bytes(head + records.tobytes())
    np.testing.assert_array_equal(points_of(path), np.stack([records[name] for name in "xyz"], axis=-1))


def test_64_bit_integers_beside_the_coordinates_are_left_out(tmp_path, points):
    flat = points.reshape(-1, 3)
    records = np.zeros(len(flat), dtype=[("t", "<u8"), ("xyz", "<f4", 3)])
    records["xyz"] = flat
    head = header("binary", width=6, height=4, fields="t x y z", sizes="8 4 4 4", types="U F F F", counts="1 1 1 1")
    path = tmp_path / "timed.pcd"
    path.write_bytes(head + records.tobytes())
    assert [field.name for field in read_cloud_file(path).layout.fields] == ["x", "y", "z"]
    np.testing.assert_array_equal(points_of(path), points)


@pytest.mark.parametrize(("ascii_form", "packed"), [(True, False), (False, False), (False, True)])
def test_reads_what_open3d_writes(tmp_path, ascii_form, packed):
    points = np.random.default_rng(1).normal(size=(500, 3)).astype(np.float32)
    path = tmp_path / "open3d.pcd"
    cloud = open3d.t.geometry.PointCloud(open3d.core.Tensor(points))
    assert open3d.t.io.write_point_cloud(str(path), cloud, write_ascii=ascii_form, compressed=packed)
    np.testing.assert_allclose(points_of(path), points, rtol=2e-6)


@pytest.mark.parametrize("path", RECORDED, ids=lambda path: path.name)
def test_recorded_scenes_equal_what_open3d_reads(path):
    ours = points_of(path)
    cloud = open3d.io.read_point_cloud(str(path), remove_nan_points=False, remove_infinite_points=False)
    theirs = np.asarray(cloud.points).astype(np.float32)
    assert ours.shape == (480, 640, 3)
    np.testing.assert_array_equal(ours.reshape(-1, 3), theirs)


def failure(path):
    with pytest.raises(SingulationError) as caught:
        read_cloud_file(path)
    assert caught.value.code == ResultCode.BAD_FILE
    assert str(path) in caught.value.message
    return caught.value.message


WRONG = {
    "empty": (lambda content: b"", "no DATA line"),
    "another format": (lambda content: b"\x89PNG\r\n\x1a\n" + bytes(100), "no DATA line"),
    "endless line": (lambda content: b"x" * 200_000, "no DATA line"),
    "cut in its data": (lambda content: content[:-1], "cut off: 24 points need 288 bytes, only 287"),
    "no fields": (lambda content: content.replace(b"FIELDS x y z\n", b""), "'FIELDS'"),
    "unequal lists": (lambda content: content.replace(b"SIZE 4 4 4", b"SIZE 4 4"), "3 FIELDS, 2 SIZE"),
    "no number": (lambda content: content.replace(b"WIDTH 6", b"WIDTH six"), "six"),
    "missing number": (lambda content: content.replace(b"WIDTH 6", b"WIDTH"), "header"),
    "zero width": (lambda content: content.replace(b"WIDTH 6", b"WIDTH 0"), "WIDTH 0"),
    "negative": (lambda content: content.replace(b"WIDTH 6", b"WIDTH -6").replace(b"HEIGHT 4", b"HEIGHT -4"), "-6"),
    "another count": (lambda content: content.replace(b"POINTS 24", b"POINTS 25"), "POINTS 25"),
    "absurd size": (
        lambda content: content.replace(b"WIDTH 6", b"WIDTH 999999999").replace(b"POINTS 24", b"POINTS 3999999996"),
        "at most",
    ),
    "unknown type": (lambda content: content.replace(b"TYPE F F F", b"TYPE F F Q"), "TYPE Q"),
    "float of one byte": (lambda content: content.replace(b"SIZE 4 4 4", b"SIZE 4 4 1"), "SIZE 1"),
    "zero count": (lambda content: content.replace(b"COUNT 1 1 1", b"COUNT 1 1 0"), "COUNT 0"),
    "unknown encoding": (lambda content: content.replace(b"DATA binary", b"DATA morse"), "'morse'"),
    "no encoding": (lambda content: content.replace(b"DATA binary", b"DATA"), "header"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_damaged_file_is_refused_and_the_good_one_is_still_read(name, good, tmp_path, points):
    change, text = WRONG[name]
    path = tmp_path / "damaged.pcd"
    path.write_bytes(change(good.read_bytes()))
    assert text in failure(path)
    np.testing.assert_array_equal(points_of(good), points)


@pytest.mark.parametrize(
    ("body", "text"),
    [
        (b"\x00\x00", "cut off: 2 bytes after the header"),
        (struct.pack("<II", 5, 7), "holds 7 bytes uncompressed"),
        (struct.pack("<II", 500, 288) + bytes(100), "500 compressed bytes were announced, 100"),
        (struct.pack("<II", 3, 288) + b"\xff\xff\xff", "damaged"),
        (struct.pack("<II", 4, 288) + b"\x02abc", "it holds 3 bytes"),
    ],
)
def test_damaged_compression(tmp_path, body, text):
    path = tmp_path / "packed.pcd"
    path.write_bytes(header("binary_compressed", width=6, height=4) + body)
    assert text in failure(path)


@pytest.mark.parametrize("text", [b"", b"1 2 3\n", b"1 2 3 four 5 6", b"\xff\xfe"])
def test_text_that_is_not_enough_numbers(tmp_path, text):
    path = tmp_path / "text.pcd"
    path.write_bytes(header("ascii", width=2, height=1) + text)
    assert "numbers can be read" in failure(path)


def test_missing_file_and_unknown_ending(tmp_path):
    assert "No such file" in failure(tmp_path / "none.pcd")
    assert "need one of ['.pcd', '.ply']" in failure(tmp_path / "cloud.xyz")


@settings(max_examples=150, deadline=None)
@given(place=st.floats(0, 1), change=st.binary(max_size=4), cut=st.booleans(), form=st.integers(0, 2))
def test_damage_anywhere_gives_a_cloud_or_a_coded_error(tmp_path_factory, place, change, cut, form):
    points = np.arange(72, dtype=np.float32).reshape(4, 6, 3)
    contents = (
        header("binary", width=6, height=4) + points.tobytes(),
        compressed(points),
        header("ascii", width=6, height=4) + ascii_lines(points),
    )
    content = contents[form]
    at = int(place * len(content))
    path = tmp_path_factory.mktemp("damage") / "cloud.pcd"
    path.write_bytes(content[:at] if cut else content[:at] + change + content[at + len(change) :])
    try:
        cloud = read_cloud_file(path)
    except SingulationError as error:
        assert error.code == ResultCode.BAD_FILE
    else:
        assert memoryview(cloud.data).nbytes == cloud.layout.row_step * cloud.layout.height


@given(data=st.binary(max_size=400))
def test_lzf_literals(data):
    packed = np.frombuffer(literal_lzf(data), np.uint8)
    assert decompress_lzf(packed, len(data)).tobytes() == data


def test_lzf_repetitions_short_long_and_overlapping():
    packed = bytes([2]) + b"abc" + bytes([1 << 5, 2]) + bytes([7 << 5, 250, 0])
    expected = b"abc" + b"abc" + b"c" * (7 + 250 + 2)
    assert decompress_lzf(np.frombuffer(packed, np.uint8), len(expected)).tobytes() == expected


@settings(max_examples=300)
@given(packed=st.binary(max_size=60), size=st.integers(0, 100))
def test_lzf_of_random_bytes_never_leaves_its_buffers(packed, size):
    try:
        assert len(decompress_lzf(np.frombuffer(packed, np.uint8), size)) == size
    except InvalidInputError as error:
        assert str(size) in error.message
