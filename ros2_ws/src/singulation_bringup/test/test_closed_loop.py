"""The closed-loop benchmark: the whole chain on one set of blocks, and what is made of the results."""

from collections import Counter
from dataclasses import replace

import pytest

from singulation_bringup.closed_loop import CellSetting, LibraryCell
from singulation_bringup.closed_loop.diffusion_readings import compare_readings
from singulation_bringup.closed_loop.endurance import Endurance, Sample, run_cycles
from singulation_bringup.closed_loop.main import main
from singulation_bringup.closed_loop.sets import COUNTS, one_push_trials, separate_trials
from singulation_bringup.closed_loop.store import RESULTS, RecordStore, read
from singulation_bringup.closed_loop.table_cost import table_cost
from singulation_bringup.closed_loop.table_separated import table_separated
from singulation_bringup.closed_loop.table_three import table_three
from singulation_bringup.closed_loop.trial import Record, Trial, run
from singulation_bringup.policy_choice import DEFAULT_MIN_GAP, DEFAULT_POLICY, FALLBACK_POLICIES
from singulation_bringup.singulation_loop import SingulationGoal, SingulationLoop
from singulation_core import InvalidInputError, ResultCode, SingulationError

TALL = Trial("separate", "mixed", 4, 0, DEFAULT_POLICY, "single_point", 10, DEFAULT_MIN_GAP, FALLBACK_POLICIES)


@pytest.fixture(scope="module")
def record():
    return run(TALL, CellSetting())


def records_of(trials, gain):
    """Results as if every push of ClusterPush gained ``gain`` and every other one half of it."""
    for trial in trials:
        given = gain if trial.policy == "cluster_push" else 0.5 * gain
        numbers = {name: 1.0 for name, kind in Record.__annotations__.items() if kind is float}
        counts = {"pushes": 1, "fallbacks": 0, "seen_before": trial.blocks, "seen_after": trial.blocks, "looks": 2}
        asked = {
            name: getattr(trial, name)
            for name in Record.__annotations__
            if name in Trial.__slots__ and name != "fallbacks"
        }
        numbers |= {"s_after": 1.0 + given, "seen_s_after": 1.0 + given}
        yield Record(**{**numbers, **counts, **asked, "code": "OK", "outcomes": "OK:1", "text": ""})


def test_blocks_of_40_mm_are_taken_apart_by_the_whole_chain(record):
    """Two of these blocks reach up to where the fingers get wide."""
    assert record.code == "OK"
    assert record.seen_before == record.seen_after == 4
    assert record.gap_after >= DEFAULT_MIN_GAP - 0.002
    assert record.s_after > record.s_before
    assert record.looks == record.pushes + 1
    assert min(record.segment, record.plan, record.motion, record.supervise, record.simulate) > 0.0


def test_cancelled_in_the_middle_of_a_motion_everything_stands_and_the_push_is_on_record():
    setting, states = CellSetting(), []
    cell = LibraryCell(
        setting.simulated_cell("squares", 3, 1),
        setting,
        1,
        lambda: len(states) > 300,
        lambda one: states.append(one.now),
    )
    result = SingulationLoop(cell, SingulationGoal(5, DEFAULT_MIN_GAP)).run()
    assert result.code is ResultCode.CANCELLED
    assert [one.code for one in result.progress.outcomes] == [ResultCode.CANCELLED]
    before = cell.robot.postures
    for _ in range(20):
        cell.simulation.step()
    for name, posture in cell.robot.postures.items():
        assert abs(posture - before[name]).max() < 1e-3


def test_a_run_goes_on_where_it_was_stopped_and_half_a_line_is_done_again(tmp_path):
    results = list(records_of(one_push_trials(1), 0.2))
    with RecordStore(tmp_path, {"setting": 1}) as store:
        for one in results[:3]:
            store.add(one)
    file = tmp_path / RESULTS
    file.write_text(file.read_text() + "one_push,squa")
    with RecordStore(tmp_path, {"setting": 1}) as store:
        assert store.records == results[:3]
        store.add(results[3])
    assert read(tmp_path) == results[:4]


def test_results_of_another_setting_are_not_mixed(tmp_path):
    RecordStore(tmp_path, {"setting": 1}).__exit__()
    with pytest.raises(InvalidInputError, match="another setting"):
        RecordStore(tmp_path, {"setting": 2})


def test_a_foreign_file_is_refused(tmp_path):
    (tmp_path / RESULTS).write_text("a,b\n1,2\n")
    with pytest.raises(SingulationError, match="not a result of this version"):
        read(tmp_path)


def test_table_three_has_forty_sets_beside_the_papers():
    trials = one_push_trials(5)
    assert len({trial.key[1:4] for trial in trials}) == 40
    text = table_three(list(records_of(trials, 0.2)))
    assert "40 sets in 8 configurations; easy: three squares (5 sets), hard: mixed shapes (20 sets)" in text
    assert (
        "| single_point, cluster_push | 0.200 ± 0.000 | 0.200 ± 0.000 | 0.200 ± 0.000 | 0.366 | 0.194 | 0.290 |" in text
    )
    assert "| single_point, average | +100.0 ± 0.0 % | +0.1000 ± 0.0000 | 40 / 0 / 0 |" in text


def test_the_table_of_pushes_counts_only_separated_sets(record):
    trials = separate_trials(1, [DEFAULT_POLICY], ["single_point"])
    done = [replace(one, gap_after=0.02, pushes=2) for one in records_of(trials, 0.2)]
    failed = replace(done[-1], code="MAX_PUSHES_REACHED", pushes=10)
    text = table_separated([*done[:-1], failed])
    assert f"{len(COUNTS)} sets" in text
    assert "| 5 | 80.0 ±" in text
    assert "MAX_PUSHES_REACHED 1" in text
    assert "pushes, " in table_cost([record])


def test_no_results_give_no_tables():
    assert table_three([]) == table_separated([]) == table_cost([]) == ""


def test_every_push_of_a_long_run_is_accounted_for():
    found = run_cycles(2, every=1)
    assert found.outcomes == found.performed == sum(found.codes.values()) == 2
    assert found.samples[-1].pushes == 2


def test_growth_is_the_slope_after_warming_up():
    samples = tuple(Sample(10 * k, 500.0 + max(0, 3 - k) * -50.0 + 0.1 * k, 4, 20) for k in range(20))
    assert Endurance(samples, Counter(), 0, 0, 0).growth == pytest.approx(1.0)


def test_readings_of_cluster_diffusion_are_compared_without_a_robot(tmp_path):
    text = compare_readings(1, 2.0, tmp_path)
    assert "8 sets;\ntravel after contact 2 mean bounding radii" in text
    assert text.count(" %") == 3 * 4
    assert (tmp_path / "diffusion_readings.md").read_text() == text


def test_wrong_usage_says_what_would_be_right(capsys):
    with pytest.raises(SystemExit):
        main(["table", "--sets", "0"])
    assert "need 1 or more" in capsys.readouterr().err
    assert main(["table", "--physics", "nothing"]) == 1
    assert "no preset 'nothing'" in capsys.readouterr().err
