"""The authors' simulator against ours."""

import gzip
import json
from pathlib import Path

import numpy as np
import pytest

from singulation_core import ContactMode, Push, PusherGeometry
from singulation_core.push_world import PushPhysics, simulate_pushes
from singulation_planner.benchmark.compare import compare, comparison_table
from singulation_planner.benchmark.rematch import rematch, rematch_table
from singulation_planner.benchmark.scenario import read_scenarios

AUTHORS_FILE = Path(__file__).parents[5] / "shared" / "data" / "authors_simulator.jsonl.gz"
SQUARE = [[0.7, 0.7], [-0.7, 0.7], [-0.7, -0.7], [0.7, -0.7]]


def spread(points):
    first, second = np.triu_indices(len(points), 1)
    return float(np.log(np.hypot(*(points[first] - points[second]).T)).mean())


@pytest.fixture
def made_here(tmp_path):
    """A file in the authors' layout whose outcomes come from our own simulator, worked out step by step."""
    objects = [{"position": [2.0 + 1.6 * k, 5.0 + 0.3 * k], "vertices": SQUARE} for k in range(3)]
    record = {"n": 3, "group": 0, "seed": 1, "objects": objects, "policies": {}}
    path = tmp_path / "made.jsonl"
    path.write_text(json.dumps(record))
    ((scenario, _),) = read_scenarios(path, 1.0)
    for number, angle in enumerate(np.linspace(0.0, 5.0, 6)):
        way = np.array((np.cos(angle), np.sin(angle)))
        start = np.array((3.6, 5.3)) - 3.5 * way  # free, far out
        push = Push(start, start + 4.1 * way, ContactMode.SINGLE_POINT)
        jaws = PusherGeometry(0.1, 0.3, 0.2)
        poses = simulate_pushes(scenario.arrangement, [push], PushPhysics.authors(), jaws, 1.0).poses[0]
        outcome = {
            "before": spread(scenario.arrangement.centroids),
            "after": spread(poses[:, :2]),
            "poses": poses.tolist(),
        }
        record["policies"][f"p{number}"] = {
            "start": start.tolist(),
            "end": (start + way).tolist(),
            "single_point": outcome,
        }
    record["policies"]["none"] = None
    path.write_text(json.dumps(record))
    return path


def test_a_simulator_agrees_with_itself(made_here):
    rows = compare(made_here)
    assert len(rows) == 6
    assert rows["ours"].to_numpy() == pytest.approx(rows["theirs"].to_numpy(), abs=1e-9)
    assert rows["position_error"].max() < 1e-9
    assert np.abs(rows["theirs"]).max() > 0.1
    assert "| single_point | 6 | 0 | 1.000 |" in comparison_table(rows)


def test_our_plans_stand_beside_those_of_the_authors_code(made_here, tmp_path):
    record = json.loads(made_here.read_text())
    push = record["policies"]["p0"]
    record["policies"] = {"clusterPush2D": push, "boundaryShear": None, "min_overlap": push}
    record["brute_force"] = {"before": 1.0, "after": 1.5}
    path = tmp_path / "rematch.jsonl"
    path.write_text(json.dumps(record))
    rows = rematch(path)
    assert rows["policy"].tolist() == ["min_overlap", "cluster_push"]
    outcome = push["single_point"]
    assert rows["theirs"].to_numpy() == pytest.approx(outcome["after"] - outcome["before"])
    assert (rows["ours"] > 0.1).all()
    assert "| ClusterPush | 1 | " in rematch_table(rows)
    ours = rows["ours"].iloc[1]
    assert f"| {200 * ours:.1f} ± 0.0 |" in rematch_table(rows)


def test_a_start_inside_a_block_is_moved_back_until_it_is_free(made_here, tmp_path):
    record = json.loads(made_here.read_text())
    one = record["policies"]["p0"]
    record["policies"] = {"inside": {**one, "start": [3.6, 5.3], "end": [4.6, 5.3]}}
    path = tmp_path / "inside.jsonl"
    path.write_text(json.dumps(record))
    (row,) = compare(path).to_dict("records")
    assert row["code"] == "OK"
    assert abs(row["ours"]) > 0.05


@pytest.mark.parametrize("path", [AUTHORS_FILE] if AUTHORS_FILE.exists() else [])
def test_gains_of_the_authors_simulator_are_met(path, tmp_path):
    lines = gzip.decompress(path.read_bytes()).splitlines()
    sample = tmp_path / "sample.jsonl"
    sample.write_bytes(b"\n".join(lines[::13]))
    rows = compare(sample)
    point = rows[rows["mode"] == "single_point"]
    assert len(point) > 250
    assert np.corrcoef(point["theirs"], point["ours"])[0, 1] > 0.9
    assert point["ours"].mean() / point["theirs"].mean() == pytest.approx(1.0, abs=0.1)
