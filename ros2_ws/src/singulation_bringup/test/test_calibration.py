"""Calibration against a simulated camera whose place is known, and points touched with known errors."""

import dataclasses
import math

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from rclpy.node import Node

from singulation_bringup.calibration.cell_file import cell_file_text, cell_with, read_cell_file
from singulation_bringup.calibration.check import check
from singulation_bringup.calibration.matching import fit_planar, match_planar, moved
from singulation_bringup.calibration.report import calibration_text, check_text
from singulation_bringup.calibration.seen_table import see_table
from singulation_bringup.calibration.solve import calibrate
from singulation_bringup.calibration.table_frame import touched_table
from singulation_bringup.calibration.touched_points import point_of, read_touched_points, touched_points
from singulation_bringup.commands import calibrate as command
from singulation_core import Arrangement, CellGeometry, InvalidInputError, PlanarObject
from singulation_core.transforms import inverse, pose_matrix, quaternion_of, transform_points
from singulation_node.parameters import ParameterSet
from singulation_sim.camera import PhoxiCamera
from yumi_push_executor.executor_settings import ExecutorSettings

CORNERS = np.array([(x, y, 0.0) for x in (-0.14, 0.14) for y in (-0.18, 0.18)] + [(0.0, 0.0, 0.0)])
PLACES = ((-0.10, -0.12, 0.3), (0.08, -0.15, 1.1), (0.02, 0.01, 0.0), (-0.06, 0.13, 2.0), (0.11, 0.09, 0.7))
HEIGHTS = (0.02, 0.03, 0.025, 0.02, 0.035)


def turn(axis, angle):
    axis = np.asarray(axis) / np.linalg.norm(axis)
    return pose_matrix((0, 0, 0), (*(np.sin(angle / 2) * axis), np.cos(angle / 2)))


def true_cell():
    """A cell somewhere else than the simulated one: table lower and tilted, camera shifted and turned."""
    nominal = CellGeometry()
    table = pose_matrix((0.40, 0.015, -0.012)) @ turn((1.0, 0.4, 0.0), math.radians(0.8))
    camera = pose_matrix((0.03, -0.02, -0.05)) @ turn((0.2, 0.3, 1.0), math.radians(6.0)) @ nominal.table_from_camera
    return CellGeometry(
        tuple(table[:3, 3]),
        tuple(quaternion_of(table)),
        nominal.workspace,
        tuple(camera[:3, 3]),
        tuple(quaternion_of(camera)),
    )


def blocks():
    square = np.array(((-0.02, -0.015), (0.02, -0.015), (0.02, 0.015), (-0.02, 0.015)))
    objects = [
        PlanarObject(number, square, height=height).moved((x, y), angle)
        for number, ((x, y, angle), height) in enumerate(zip(PLACES, HEIGHTS, strict=True))
    ]
    return Arrangement(objects)


def touched(cell, error=0.0, seed=0):
    """Points as read from the robot: the true ones, each off by up to ``error`` [m]."""
    random = np.random.default_rng(seed)
    tops = np.column_stack((blocks().centroids, HEIGHTS))

    def read(points):
        body = transform_points(cell.body_from_table, points)
        return body + random.uniform(-error, error, body.shape)

    return touched_points(read(CORNERS), read(tops), "m")


@pytest.fixture(scope="module")
def clouds():
    camera = PhoxiCamera(true_cell(), seed=3)
    return [camera.capture(blocks()) for _ in range(2)]


@pytest.fixture(scope="module")
def views(clouds):
    return [see_table(cloud) for cloud in clouds]


def turned_by(found, true):
    difference = inverse(true) @ found
    angle = np.arccos(np.clip((np.trace(difference[:3, :3]) - 1.0) / 2.0, -1.0, 1.0))
    return float(np.degrees(angle))


def seen_from_body(cell, other):
    """How far a point on the table that the camera sees lands from where it is, at worst in the workspace [m]."""
    true, found = (one.body_from_table @ one.table_from_camera for one in (cell, other))
    points = transform_points(inverse(true) @ cell.body_from_table, CORNERS)
    return float(np.linalg.norm(transform_points(found, points) - transform_points(true, points), axis=1).max())


def test_exact_points_give_the_true_cell(views):
    found = calibrate(touched(true_cell()), views, CellGeometry())
    assert seen_from_body(true_cell(), found.cell) < 0.0006
    angle = turned_by(found.cell.body_from_table, true_cell().body_from_table)
    assert angle < 1.0  # the frame table keeps its x along the old one: only its plane is measured
    assert found.worst < 0.001
    assert found.table.tilt == pytest.approx(math.radians(0.8), abs=0.002)


def test_touching_errors_of_a_millimetre_stay_millimetres(views):
    for seed in range(4):
        found = calibrate(touched(true_cell(), 0.001, seed), views, CellGeometry())
        assert seen_from_body(true_cell(), found.cell) < 0.002
        assert found.worst < 0.003
        assert "worst residual" in calibration_text(found)


def test_a_wrong_point_shows_in_the_residuals(views):
    points = touched(true_cell())
    off = points.blocks.copy()
    off[2, 0] += 0.004
    found = calibrate(dataclasses.replace(points, blocks=off), views, CellGeometry())
    assert found.worst > 0.002
    assert int(found.block_residuals[0].argmax()) == 2


def test_the_check_finds_a_moved_camera_and_accepts_a_true_file(clouds):
    points, cell = touched(true_cell()), true_cell()
    good = check(points, [see_table(cloud, cell) for cloud in clouds], cell)
    assert good.worst < 0.001
    moved_camera = cell_with(cell, cell.body_from_table, pose_matrix((0.012, 0.0, 0.006)) @ cell.table_from_camera)
    bad = check(points, [see_table(cloud, moved_camera) for cloud in clouds], moved_camera)
    assert bad.offsets == pytest.approx(0.006, abs=0.0005)
    assert bad.block_residuals[:, 0] == pytest.approx(0.012, abs=0.001)
    assert "worst difference 12" in check_text(bad)


def test_a_written_file_is_read_back(tmp_path, ros_context):
    path = tmp_path / "cell.yaml"
    path.write_text(cell_file_text(true_cell(), ["Made by a test.", "two\nlines"]))
    options = ["--ros-args", "--params-file", str(path)]
    node = Node("executor_node", context=ros_context, cli_args=options, use_global_arguments=False)
    assert ParameterSet(node, ExecutorSettings).current.cell == read_cell_file(path)  # rcl reads it alike
    node.destroy_node()
    found = read_cell_file(path)
    assert found.body_from_table == pytest.approx(true_cell().body_from_table, abs=1e-9)
    assert found.table_from_camera == pytest.approx(true_cell().table_from_camera, abs=1e-9)
    assert path.read_text().startswith("# Made by a test.\n# two\n# lines\n/**:")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("nothing: 1", "ros__parameters"),
        ("/**:\n  ros__parameters:\n    workspace: [1, 0, 0, 1]", "x_min < x_max"),
        ("/**:\n  ros__parameters:\n    camera_position: [1, 0]", "3 numbers"),
        ("/**:\n  ros__parameters:\n    camera_quaternion: [1, 1, 1, 1]", "length"),
        ("/**:\n  ros__parameters:\n    camera_position: [.nan, 0, 1]", "3 numbers"),
        ("[", "cell.yaml"),
    ],
)
def test_a_wrong_cell_file_is_refused(tmp_path, text, words):
    path = tmp_path / "cell.yaml"
    path.write_text(text)
    with pytest.raises(InvalidInputError, match=words):
        read_cell_file(path)


@pytest.mark.parametrize(
    ("points", "words"),
    [
        (CORNERS[:2], "at least 3"),
        (np.array([(0.1 * k, 0.0, 0.0) for k in range(4)]), "across"),
        (CORNERS @ turn((1, 0, 0), math.radians(25))[:3, :3].T, "tilted"),
    ],
)
def test_points_that_make_no_table_are_refused(points, words):
    with pytest.raises(InvalidInputError, match=words):
        touched_table(points, np.eye(4))


def test_regular_and_missing_blocks_are_refused():
    square = np.array([(0.0, 0.0), (0.1, 0.0), (0.1, 0.1), (0.0, 0.1)])
    with pytest.raises(InvalidInputError, match="less regularly"):
        match_planar(square, square + 0.02)
    seen = np.array([place[:2] for place in PLACES])
    with pytest.raises(InvalidInputError, match="all of them seen"):
        match_planar(seen, seen[:3])
    with pytest.raises(InvalidInputError, match="no way"):
        match_planar(seen + np.array([(0.03, 0), (0, 0), (0, 0.02), (0, 0), (0, 0)]), seen)
    assert match_planar(seen, seen[::-1]).seen == (4, 3, 2, 1, 0)


@given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(-3.1, 3.1), st.permutations(range(5)))
@settings(max_examples=50, deadline=None)
def test_any_motion_and_order_is_undone(x, y, angle, order):
    touched_at = np.array([place[:2] for place in PLACES])
    motion = np.array([[math.cos(angle), -math.sin(angle), x], [math.sin(angle), math.cos(angle), y], [0.0, 0.0, 1.0]])
    seen = moved(np.linalg.inv(motion), touched_at)[list(order)]
    match = match_planar(touched_at, seen)
    assert match.touched_from_seen == pytest.approx(motion, abs=1e-9)
    assert [order[place] for place in match.seen] == list(range(5))
    assert fit_planar(touched_at, seen[list(match.seen)]) == pytest.approx(motion, abs=1e-9)


def test_points_in_millimetres_and_wrong_units(tmp_path):
    path = tmp_path / "touched.yaml"
    path.write_text("table: [[390, -10, 40]]\nblocks: []\n")
    assert read_touched_points(path, "mm").table == pytest.approx(np.array([[0.39, -0.01, 0.04]]))
    with pytest.raises(InvalidInputError, match="millimetres"):
        read_touched_points(path, "m")
    path.write_text("table: [[1, 2]]\n")
    with pytest.raises(InvalidInputError, match="three numbers"):
        read_touched_points(path, "mm")
    assert point_of("0.1, 2 -3") == (0.1, 2.0, -3.0)
    with pytest.raises(InvalidInputError, match="x, y, z"):
        point_of("1 2 three")


@pytest.fixture
def ply_files(clouds, tmp_path):
    """The clouds as files, written here as plain text."""
    paths = []
    for number, cloud in enumerate(clouds):
        points = cloud.reshape(-1, 3)
        head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
        head += "".join(f"property float {name}\n" for name in "xyz") + "end_header\n"
        paths.append(tmp_path / f"cloud_{number}.ply")
        paths[-1].write_bytes(head.encode() + points.astype("<f4").tobytes())
    return [str(path) for path in paths]


def write_touched(path, points):
    content = {"table": (1e3 * points.table).tolist(), "blocks": (1e3 * points.blocks).tolist()}
    path.write_text(yaml.safe_dump(content))
    return str(path)


def test_the_command_writes_a_cell_that_it_then_accepts(ply_files, tmp_path, capsys):
    points = write_touched(tmp_path / "touched.yaml", touched(true_cell(), 0.0005))
    out = str(tmp_path / "my_cell.yaml")
    source = ["--touched", points, "--clouds", *ply_files]
    assert command.main(["calibrate", "--out", out, *source]) == 0
    assert "good: within 3 mm" in capsys.readouterr().out
    assert command.main(["calibrate", "--check", "--cell", out, *source]) == 0
    assert command.main(["calibrate", "--check", "--cell", out, "--limit", "0.01", *source]) == 1
    assert "not good" in capsys.readouterr().out


def test_nothing_is_written_when_the_points_do_not_fit(ply_files, tmp_path, capsys):
    points = touched(true_cell())
    bent = dataclasses.replace(points, table=points.table + np.array([[0, 0, 0.01 * k] for k in (0, 1, 0, 1, 0)]))
    out = tmp_path / "my_cell.yaml"
    given_points = write_touched(tmp_path / "touched.yaml", bent)
    assert command.main(["calibrate", "--out", str(out), "--touched", given_points, "--clouds", *ply_files]) == 1
    assert not out.exists()
    assert "not good" in capsys.readouterr().out


def test_points_can_be_asked_for(capsys):
    answers = iter(["1 2", "100, 0, 40", "", "300 0 60", ""])
    options = command.parse(["--ask"])
    points = command._touched(options, lambda prompt: next(answers))
    assert points.table == pytest.approx(np.array([[0.1, 0.0, 0.04]]))
    assert points.blocks == pytest.approx(np.array([[0.3, 0.0, 0.06]]))
    assert "need x, y, z" in capsys.readouterr().out


def test_a_missing_file_is_an_error_with_a_code(tmp_path, capsys):
    assert command.main(["calibrate", "--clouds", str(tmp_path / "none.ply"), "--table-point", "1,2,3"]) == 1
    assert "BAD_FILE" in capsys.readouterr().err
