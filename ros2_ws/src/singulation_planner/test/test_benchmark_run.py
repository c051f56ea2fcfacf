"""Runs of the benchmark: on cores, on Dask, stopped and gone on with."""

import json
from dataclasses import replace

import distributed
import pandas as pd
import pytest

from singulation_core import InvalidInputError, ResultCode, SingulationError
from singulation_planner.benchmark import engines
from singulation_planner.benchmark.evaluate import SceneRecipe, SceneTask, evaluate
from singulation_planner.benchmark.record import Job
from singulation_planner.benchmark.run import Plan, run
from singulation_planner.benchmark.settings import SETTINGS, find_setting
from singulation_planner.benchmark.store import export, load

SMALL = Plan(SETTINGS["clutter"], ("cluster_push", "quasi_random"), scenarios=8, brute_force_scenarios=0, counts=(3, 4))


def untimed(records):
    """Results without what differs from run to run."""
    return sorted((replace(one, planning=0.0, simulating=0.0) for one in records), key=lambda one: one.key)


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    return untimed(run(SMALL, tmp_path_factory.mktemp("expected"), workers=1))


def test_a_run_covers_its_plan(expected):
    assert len(expected) == 8 * 2
    assert {(one.n, one.group) for one in expected} == {(n, group) for n in (3, 4) for group in range(4)}
    assert all(one.code == "OK" and one.after != one.before for one in expected)


def test_processes_give_the_same_results(tmp_path, expected):
    assert untimed(run(SMALL, tmp_path, workers=2)) == expected


def test_a_dask_cluster_gives_the_same_results(tmp_path, expected):
    with distributed.LocalCluster(n_workers=1, threads_per_worker=2, processes=True, dashboard_address=None) as cluster:
        assert untimed(run(SMALL, tmp_path, workers=1, dask=cluster.scheduler_address)) == expected


def test_no_dask_scheduler_is_a_timeout(tmp_path, monkeypatch):
    monkeypatch.setattr(engines, "_PATIENCE", 0.5)
    with pytest.raises(SingulationError, match=r"no Dask scheduler at 'tcp://127\.0\.0\.1:9'") as caught:
        run(SMALL, tmp_path, workers=1, dask="tcp://127.0.0.1:9")
    assert caught.value.code is ResultCode.TIMEOUT
    assert len(run(SMALL, tmp_path, workers=1)) == 16


def test_a_dask_cluster_without_workers_is_not_ready(tmp_path):
    with (
        distributed.LocalCluster(n_workers=0, processes=False, dashboard_address=None) as cluster,
        pytest.raises(SingulationError, match="no workers") as caught,
    ):
        run(SMALL, tmp_path, workers=1, dask=cluster.scheduler_address)
    assert caught.value.code is ResultCode.NOT_READY


def test_a_stopped_run_goes_on_where_it_was(tmp_path, expected):
    run(replace(SMALL, scenarios=8, counts=(3,)), tmp_path, workers=1)
    lines = (tmp_path / "results.jsonl").read_text().splitlines()
    # The process was killed in the middle of a line.
    (tmp_path / "results.jsonl").write_text("\n".join(lines[:3]) + "\n" + lines[3][:40])
    assert untimed(run(SMALL, tmp_path, workers=1)) == expected
    again = (tmp_path / "results.jsonl").read_text().splitlines()
    assert again[:3] == lines[:3]
    assert len(again) == 16
    run(SMALL, tmp_path, workers=1)
    assert (tmp_path / "results.jsonl").read_text().splitlines() == again


def test_results_of_another_setting_are_not_mixed_in(tmp_path):
    run(replace(SMALL, scenarios=1, counts=(3,)), tmp_path, workers=1)
    with pytest.raises(InvalidInputError, match="another setting"):
        run(replace(SMALL, setting=SETTINGS["authors"]), tmp_path, workers=1)
    with pytest.raises(InvalidInputError, match="another setting"):
        run(replace(SMALL, setting=replace(SETTINGS["clutter"], push_distance=0.1)), tmp_path, workers=1)
    assert len(load(tmp_path)) == 4 * 2


def test_a_folder_that_cannot_be_written_is_a_bad_file(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(SingulationError, match="results folder") as caught:
        run(SMALL, tmp_path / "file" / "out", workers=1)
    assert caught.value.code is ResultCode.BAD_FILE
    with pytest.raises(SingulationError, match=r"no results.jsonl"):
        load(tmp_path)


def test_a_job_that_fails_becomes_a_result_and_not_the_end_of_the_run():
    recipe = SceneRecipe("clutter", 3, 0, 1)
    broken = replace(SETTINGS["clutter"], options={"min_overlap": {"colour": "red"}})
    bad, good = evaluate(SceneTask(broken, recipe, [Job("min_overlap"), Job("cluster_push")]))
    assert (bad.code, bad.after) == ("INVALID_INPUT", bad.before)
    assert "colour" in bad.text
    assert good.code == "OK"


def test_brute_force_works_on_as_many_scenes_as_asked():
    plan = replace(SMALL, policies=("brute_force", "cluster_push"), scenarios=24, brute_force_scenarios=8)
    jobs = [job.policy for task in plan.tasks() for job in task.jobs]
    assert (jobs.count("brute_force"), jobs.count("cluster_push")) == (8, 24)


def test_scenes_of_a_file_are_run(tmp_path):
    kite = [[1.0, 0.0], [0.0, 0.8], [-0.8, 0.0], [0.0, -0.8]]
    objects = [{"position": [1.9 * k, 0.1 * k], "vertices": kite} for k in range(3)]
    lines = [json.dumps({"n": 3, "group": 0, "seed": seed, "objects": objects}) for seed in range(2)]
    file = tmp_path / "scenes.jsonl"
    file.write_text("\n".join(lines))
    records = run(replace(SMALL, file=file, scenarios=2), tmp_path / "out", workers=1)
    assert {one.scenario for one in records} == {"file-n03-g0-s0", "file-n03-g0-s1"}


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"policies": ("telekinesis",)}, "cluster_push"),
        ({"contact_modes": ("suction",)}, "two_point"),
        ({"fits": ("nothing",)}, "every_mode"),
        ({"scenarios": 0}, "at least one scenario"),
        ({"counts": (1, 3)}, "at least two objects"),
        ({"counts": ()}, "at least two objects"),
    ],
)
def test_plans_that_mean_nothing_are_refused(changes, text):
    with pytest.raises(SingulationError, match=text):
        replace(SMALL, **changes)


def test_an_unknown_setting_is_refused_with_the_known_ones():
    with pytest.raises(InvalidInputError, match="clutter_pymunk, authors"):
        find_setting("moon")


def test_csv_and_parquet_hold_the_same(tmp_path, expected):
    table = export(expected, tmp_path)
    pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / "results.parquet"), table)
    from_text = pd.read_csv(tmp_path / "results.csv", keep_default_na=False)
    pd.testing.assert_frame_equal(from_text, table, check_dtype=False)
