import numpy as np
import open3d
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from singulation_core import ResultCode, SingulationError
from singulation_perception.cloud_files import read_cloud_file
from singulation_perception.decoding import decode_points

POINTS = np.arange(18, dtype=np.float32).reshape(2, 3, 3) / 7


def header(form, count=6, kind="float", extra="", comments=""):
    properties = "".join(f"property {kind} {name}\n" for name in "xyz")
    return (
        f"ply\nformat {form} 1.0\n{comments}element vertex {count}\n{properties}{extra}"
        "element face 0\nproperty list uchar int vertex_indices\nend_header\n"
    ).encode()


def points_of(path):
    cloud = read_cloud_file(path)
    return decode_points(cloud.data, cloud.layout)


@pytest.fixture
def good(tmp_path):
    path = tmp_path / "good.ply"
    path.write_bytes(header("binary_little_endian") + POINTS.tobytes())
    return path


@pytest.mark.parametrize(
    ("form", "kind", "dtype"),
    [
        ("binary_little_endian", "float", "<f4"),
        ("binary_big_endian", "float32", ">f4"),
        ("binary_little_endian", "double", "<f8"),
        ("binary_big_endian", "float64", ">f8"),
    ],
)
def test_binary_of_either_byte_order_and_precision(tmp_path, form, kind, dtype):
    path = tmp_path / "cloud.PLY"
    path.write_bytes(header(form, kind=kind) + POINTS.astype(dtype).tobytes())
    np.testing.assert_allclose(points_of(path), POINTS.reshape(-1, 3), rtol=1e-7)


def test_text_with_missing_points(tmp_path):
    path = tmp_path / "cloud.ply"
    path.write_bytes(header("ascii", count=2) + b"1 2 3\nnan nan nan\n3 0 0 0\n")
    np.testing.assert_array_equal(points_of(path), [[1, 2, 3], [np.nan] * 3])


@pytest.mark.parametrize(
    "comments",
    [
        "comment num_cols 3\ncomment num_rows 2\n",
        "obj_info num_cols 3\nobj_info num_rows 2\n",
        "comment width: 3\ncomment height: 2\n",
    ],
)
def test_image_order_is_kept_where_the_file_states_it(tmp_path, comments):
    path = tmp_path / "image.ply"
    path.write_bytes(header("binary_little_endian", comments=comments) + POINTS.tobytes())
    np.testing.assert_array_equal(points_of(path), POINTS)


def test_a_stated_image_size_that_does_not_fit_is_ignored(tmp_path):
    path = tmp_path / "image.ply"
    comments = "comment num_cols 4\ncomment num_rows 2\n"
    path.write_bytes(header("binary_little_endian", comments=comments) + POINTS.tobytes())
    assert points_of(path).shape == (6, 3)


@pytest.mark.parametrize("ascii_form", [True, False])
def test_reads_what_open3d_writes(tmp_path, ascii_form):
    points = np.random.default_rng(2).normal(size=(300, 3))
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
    cloud.colors = open3d.utility.Vector3dVector(np.full((300, 3), 0.5))
    path = tmp_path / "open3d.ply"
    assert open3d.io.write_point_cloud(str(path), cloud, write_ascii=ascii_form)
    np.testing.assert_allclose(points_of(path), points, rtol=1e-5)  # text has six digits


WRONG = {
    "empty": (lambda content: b"", "does not begin with 'ply'"),
    "another format": (lambda content: b"solid block\n" + content, "does not begin with 'ply'"),
    "cut in its header": (lambda content: content[:60], "no end_header"),
    "cut in its data": (lambda content: content[:-1], "cut off: 6 points need 72 bytes, only 71"),
    "unknown encoding": (lambda content: content.replace(b"binary_little_endian", b"morse"), "format 'morse'"),
    "no encoding": (lambda content: content.replace(b"format binary_little_endian 1.0\n", b""), "format 'none'"),
    "no vertices": (lambda content: content.replace(b"vertex 6", b"vertex 0"), "0 vertices"),
    "another first element": (lambda content: content.replace(b"element vertex", b"element edge"), "first element"),
    "no properties": (lambda content: content.replace(b"property float ", b"comment "), "no properties"),
    "a list in the vertices": (
        lambda content: content.replace(b"property float z", b"property list uchar int z"),
        "not a number",
    ),
    "no number": (lambda content: content.replace(b"vertex 6", b"vertex six"), "six"),
    "absurd size": (lambda content: content.replace(b"vertex 6", b"vertex 999999999999"), "more than"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_damaged_file_is_refused_and_the_good_one_is_still_read(name, good, tmp_path):
    change, text = WRONG[name]
    path = tmp_path / "damaged.ply"
    path.write_bytes(change(good.read_bytes()))
    with pytest.raises(SingulationError) as caught:
        read_cloud_file(path)
    assert caught.value.code == ResultCode.BAD_FILE
    assert text in caught.value.message
    np.testing.assert_array_equal(points_of(good), POINTS.reshape(-1, 3))


@settings(max_examples=150, deadline=None)
@given(place=st.floats(0, 1), change=st.binary(max_size=4), cut=st.booleans(), text=st.booleans())
def test_damage_anywhere_gives_a_cloud_or_a_coded_error(tmp_path_factory, place, change, cut, text):
    body = b"1.5 2 3\n" * 6 if text else POINTS.tobytes()
    content = header("ascii" if text else "binary_little_endian") + body
    at = int(place * len(content))
    path = tmp_path_factory.mktemp("damage") / "cloud.ply"
    path.write_bytes(content[:at] if cut else content[:at] + change + content[at + len(change) :])
    try:
        cloud = read_cloud_file(path)
    except SingulationError as error:
        assert error.code == ResultCode.BAD_FILE
    else:
        assert memoryview(cloud.data).nbytes == cloud.layout.row_step * cloud.layout.height
