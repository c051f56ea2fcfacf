"""Ctrl-C at any moment: no orphans, no traceback, and what was recorded can be read."""

import signal

import psutil
import pytest

from singulation_node.testing import wait_until
from singulation_perception.bag_reading import bag_topics

MOMENTS = {
    "while the first nodes start": "starting perception",
    "while the cell starts": "waiting for executor_node",
    "during the loop": "look -> plan -> push",
}


def expect_none_alive(processes):
    wait_until(
        lambda: not any(p.is_running() and p.status() != psutil.STATUS_ZOMBIE for p in processes), 30, "their end"
    )


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=lambda number: number.name)
@pytest.mark.parametrize("moment", MOMENTS)
def test_it_ends_cleanly(demo, moment, number):
    part = "replay" if "first nodes" in moment else "cell"
    started = demo("--part", part)
    children = started.wait_for_line(MOMENTS[moment])
    started.interrupt(number)
    code, _, errors = started.end(60)
    assert code == 130
    assert "Traceback" not in errors
    assert started.summary["code_name"] == "CANCELLED"
    expect_none_alive(children)
    if part == "cell":
        topics = {topic.name for topic in bag_topics(started.out / "run")}  # it can be read, however early the end came
        assert topics >= {"/joint_states", "/true_objects"} or moment != "during the loop"


def test_its_nodes_die_with_it_even_when_it_is_killed(demo):
    started = demo("--part", "cell")
    children = started.wait_for_line("waiting for executor_node")
    assert children
    started.process.kill()
    expect_none_alive(children)
