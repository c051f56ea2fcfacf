from pathlib import Path

import pytest

from singulation_perception.replay_arguments import parse_replay


def test_defaults():
    options = parse_replay(["bag"])
    assert options.paths == [Path("bag")]
    assert (options.rate, options.period, options.wait) == (1.0, 1.0, 30.0)
    assert (options.loop, options.step, options.clock, options.stamps, options.frame) == (
        False,
        False,
        False,
        "now",
        "",
    )


def test_all_options():
    words = (
        "a.pcd b.ply --rate 2 --period 0.5 --loop --step --stamps original --clock --frame camera --wait 0 --topic t"
    )
    options = parse_replay(words.split())
    assert options.paths == [Path("a.pcd"), Path("b.ply")]
    assert (options.rate, options.period, options.wait) == (2.0, 0.5, 0.0)
    assert (options.loop, options.step, options.clock) == (True, True, True)
    assert (options.stamps, options.frame, options.topic) == ("original", "camera", "t")


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ("", "PATH"),
        ("bag --rate 0", "above 0"),
        ("bag --rate nan", "finite"),
        ("bag --rate -1", "finite"),
        ("bag --period inf", "finite"),
        ("bag --wait soon", "finite"),
        ("bag --stamps yesterday", "original"),
    ],
)
def test_wrong_arguments_end_with_code_2_and_say_what_would_be_right(words, text, capsys):
    with pytest.raises(SystemExit) as ended:
        parse_replay(words.split())
    assert ended.value.code == 2
    assert text in capsys.readouterr().err
