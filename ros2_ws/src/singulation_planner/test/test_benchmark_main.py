"""The executable ``benchmark``."""

import pytest

from singulation_planner.benchmark import main as entry

RUN = [
    "run",
    "--policies",
    "cluster_push",
    "brute_force",
    "--scenarios",
    "4",
    "--brute-force-scenarios",
    "4",
    "--counts",
    "3",
    "--workers",
    "1",
]


def test_a_run_writes_every_file_and_prints_its_table(tmp_path, capsys):
    assert entry.main([*RUN, "--out", str(tmp_path)]) == 0
    printed = capsys.readouterr()
    assert "| ClusterPush |" in printed.out
    assert "4/4  100%" in printed.err
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"about.json", "results.jsonl", "results.csv", "results.parquet", "table_1.md", "figure_6.png"}
    assert entry.main(["tables", str(tmp_path)]) == 0
    assert capsys.readouterr().out == printed.out


def test_contact_modes_give_table_two(tmp_path, capsys):
    arguments = [
        "run",
        "--policies",
        "cluster_push",
        "--contact-modes",
        "single_point",
        "edge",
        "best",
        "--fits",
        "contact_mode",
        "every_mode",
        "--scenarios",
        "4",
        "--counts",
        "10",
        "--workers",
        "1",
    ]
    assert entry.main([*arguments, "--out", str(tmp_path)]) == 0
    assert "best of three" in capsys.readouterr().out
    assert (tmp_path / "table_2.md").exists()


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (["tables", "{tmp}/nowhere"], "BAD_FILE"),
        (["compare", "{tmp}/none.jsonl", "--out", "{tmp}/out"], "BAD_FILE"),
        ([*RUN, "--out", "{tmp}/out", "--scenarios", "0"], "at least one scenario"),
        ([*RUN, "--out", "{tmp}/out", "--counts", "1-3"], "at least two objects"),
        ([*RUN, "--out", "{tmp}/out", "--file", "{tmp}/none.jsonl"], "BAD_FILE"),
    ],
)
def test_what_cannot_be_done_is_told_and_not_thrown(tmp_path, capsys, arguments, text):
    assert entry.main([one.replace("{tmp}", str(tmp_path)) for one in arguments]) == 1
    assert text in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments", [[], ["run"], ["run", "--out", "x", "--policies", "magic"], ["run", "--out", "x", "--counts", "few"]]
)
def test_malformed_command_lines_show_the_usage(capsys, arguments):
    with pytest.raises(SystemExit) as caught:
        entry.main(arguments)
    assert caught.value.code == 2
    assert "usage: benchmark" in capsys.readouterr().err


def test_help_shows_examples_and_every_command(capsys):
    with pytest.raises(SystemExit) as caught:
        entry.main(["--help"])
    assert caught.value.code == 0
    text = capsys.readouterr().out
    assert all(word in text for word in ("run", "tables", "compare", "timing", "--dask"))


def test_an_interrupt_keeps_results_and_says_so(tmp_path, capsys, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(entry, "run", interrupted)
    assert entry.main([*RUN, "--out", str(tmp_path)]) == 130
    assert "run again to go on" in capsys.readouterr().err


def test_simulators_are_compared(tmp_path, capsys):
    assert entry.main(["simulators", "--scenes", "2", "--out", str(tmp_path)]) == 0
    text = capsys.readouterr().out
    rows = [line.split("|") for line in text.splitlines() if line.startswith(("| pymunk", "| compiled"))]
    assert len(rows) == 3 * 7
    assert all(float(row[5]) > 0.9 and abs(float(row[8])) < 1e-9 for row in rows)


def test_timing_measures_every_policy_asked(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(entry.report, "_COUNTS", (3, 4))
    monkeypatch.setattr(entry.report, "_PUSH_COUNTS", (3,))
    assert (
        entry.main(["timing", "--policies", "cluster_push", "min_overlap", "--scenes", "1", "--out", str(tmp_path)])
        == 0
    )
    text = capsys.readouterr().out
    assert "| ClusterPush |" in text
    assert "| quasi_static |" in text
