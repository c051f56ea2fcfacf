"""Scenes of the benchmark: generated ones and files."""

import gzip
import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from singulation_core import InvalidInputError, ResultCode, SingulationError, smallest_gap
from singulation_core.polygon import separation, validated_outline
from singulation_planner.benchmark.generators import GENERATORS, UNIT, generate
from singulation_planner.benchmark.scenario import read_scenarios
from singulation_planner.benchmark.shapes import GROUPS, random_outline

AUTHORS_FILE = Path(__file__).parents[5] / "shared" / "data" / "authors_simulator.jsonl.gz"
KITE = [[1.0, 0.0], [0.0, 0.5], [-0.2, 0.0], [0.0, -0.5]]
LINE = {
    "n": 2,
    "group": 3,
    "seed": 7,
    "objects": [
        {"position": [3.0, 4.0], "vertices": KITE},
        {"position": [6.0, 4.0], "vertices": [*KITE[:2], [0.1, 0.0], KITE[3]]},
    ],
}


@pytest.mark.parametrize("generator", list(GENERATORS))
def test_the_same_seed_gives_the_same_scene_and_another_one_another(generator):
    first, again, other = (generate(generator, 5, 2, seed) for seed in (4, 4, 5))
    assert first.key == again.key != other.key
    for one, two in zip(first.arrangement.objects, again.arrangement.objects, strict=True):
        assert np.array_equal(one.outline, two.outline)
    assert not np.array_equal(first.arrangement.centroids, other.arrangement.centroids)


@settings(max_examples=20, deadline=None)
@given(
    generator=st.sampled_from(list(GENERATORS)),
    count=st.integers(2, 9),
    group=st.integers(0, 3),
    seed=st.integers(0, 99),
)
def test_blocks_do_not_overlap_and_every_one_has_a_neighbour(generator, count, group, seed):
    blocks = generate(generator, count, group, seed).arrangement
    assert len(blocks) == count
    assert smallest_gap(blocks) > 0.0
    widest = {"authors": 0.31, "clutter": 0.021}[generator] * UNIT
    for k, block in enumerate(blocks.objects[1:], start=1):
        assert min(separation(block.outline, other.outline) for other in blocks.objects[:k]) < widest


@pytest.mark.parametrize("group", range(4))
def test_groups_grow_more_eccentric(group):
    random = np.random.default_rng(1)
    for _ in range(50):
        outline = validated_outline(random_outline(group, random))
        assert len(outline) <= GROUPS[group][2]
        assert 0.5 < np.hypot(*outline.T).max() <= 1.0 + 1e-9


def coverage(group):
    random = np.random.default_rng(2)
    outlines = [random_outline(group, random) for _ in range(200)]
    return float(
        np.mean([0.5 * abs(np.sum(o[:, 0] * np.roll(o[:, 1], -1) - o[:, 1] * np.roll(o[:, 0], -1))) for o in outlines])
    )


def test_a_higher_group_covers_less_of_its_disc():
    covered = [coverage(group) for group in range(4)]
    assert covered == sorted(covered, reverse=True)


def write(path, *lines):
    text = "\n".join(one if isinstance(one, str) else json.dumps(one) for one in lines) + "\n"
    path.write_bytes(gzip.compress(text.encode()) if path.suffix == ".gz" else text.encode())
    return path


@pytest.mark.parametrize("name", ["scenes.jsonl", "scenes.jsonl.gz"])
def test_scenes_of_a_file_are_hulls_in_metres(tmp_path, name):
    ((scenario, record),) = read_scenarios(write(tmp_path / name, LINE), 0.04)
    assert (scenario.n, scenario.group, scenario.seed, scenario.unit) == (2, 3, 7, 0.04)
    assert record["seed"] == 7
    second = scenario.arrangement.objects[1]
    assert len(second.outline) == 3  # its third vertex is a dent
    assert second.outline[:, 0].max() == pytest.approx(7.0 * 0.04)


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("{", "line 2"),
        ({**LINE, "n": 3}, "n is 3, but there are 2 objects"),
        ({**LINE, "objects": [{"position": [0.0, 0.0]}] * 2}, "vertices"),
        ({**LINE, "objects": [{"position": [0.0, 0.0], "vertices": [[0, 0], [1, 1]]}] * 2}, "object 0"),
        ({**LINE, "objects": [{"position": [float("nan"), 0.0], "vertices": KITE}] * 2}, "line 2"),
    ],
)
def test_malformed_lines_are_refused_with_their_number(tmp_path, line, text):
    bad = write(tmp_path / "bad.jsonl", LINE, line)
    with pytest.raises(InvalidInputError, match="line 2") as caught:
        list(read_scenarios(bad, 1.0))
    assert text in caught.value.message
    assert len(list(read_scenarios(write(tmp_path / "good.jsonl", LINE), 1.0))) == 1


def test_a_missing_or_broken_file_is_a_bad_file(tmp_path):
    broken = tmp_path / "broken.jsonl.gz"
    broken.write_bytes(b"this is no gzip")
    for path in (tmp_path / "none.jsonl", broken):
        with pytest.raises(SingulationError, match="scenario file") as caught:
            list(read_scenarios(path, 1.0))
        assert caught.value.code is ResultCode.BAD_FILE


@pytest.mark.parametrize("path", [AUTHORS_FILE] if AUTHORS_FILE.exists() else [])
def test_the_authors_scenes_can_be_read_and_ours_resemble_them(path):
    theirs = [scenario for scenario, _ in read_scenarios(path, UNIT)]
    assert len(theirs) == 520
    for n in (3, 9):
        ours = [generate("authors", n, group, seed) for group in range(4) for seed in range(5)]
        gaps = [
            np.median([smallest_gap(one.arrangement) for one in many])
            for many in (ours, [one for one in theirs if one.n == n])
        ]
        assert gaps[0] == pytest.approx(gaps[1], abs=0.06 * UNIT)
