import gc
from types import SimpleNamespace

import numba
import pytest

from singulation_node import warming
from singulation_node.warming import warm


@pytest.fixture
def node():
    said = []
    return SimpleNamespace(own_process=False, said=said, get_logger=lambda: SimpleNamespace(info=said.append))


def test_a_warm_start_says_only_how_long_it_took(node):
    assert warm(node, lambda: "ready", "a minute") == "ready"
    assert [words.split(" after ")[0] for words in node.said] == ["warm"]


def test_compiling_is_said_and_helped_with(node, monkeypatch):
    helped = []
    monkeypatch.setattr(warming, "helpers", lambda module: helped.append(module) or memoryview(b""))
    warm(node, lambda: numba.njit(lambda x: x + 1)(2), "a minute", "a.module")
    assert node.said[0] == "compiling what is not kept on disk yet; all of it takes a minute, once"
    assert node.said[1].startswith("warm after ")
    assert helped == ["a.module"]


@pytest.mark.parametrize("own", [False, True])
def test_only_in_a_process_of_its_own_garbage_is_left_alone(node, own, monkeypatch):
    frozen = []
    monkeypatch.setattr(gc, "freeze", lambda: frozen.append(True))
    node.own_process = own
    enabled = []
    warm(node, lambda: enabled.append(gc.isenabled()), "a minute")
    assert enabled == [not own]
    assert gc.isenabled()
    assert frozen == [True] * own


def test_a_failure_is_handed_on_and_garbage_collected_again(node):
    node.own_process = True
    with pytest.raises(ZeroDivisionError):
        warm(node, lambda: 1 / 0, "a minute")
    assert gc.isenabled()
    assert node.said == []
    gc.unfreeze()
