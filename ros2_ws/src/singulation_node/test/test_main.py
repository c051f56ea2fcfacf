"""Nodes as processes: signals end them cleanly, bad parameters with a message."""

import os
import signal
import subprocess
import sys

import pytest

from singulation_node.domain import reserved_domain

PROGRAM = """
import sys
import time
from dataclasses import dataclass
from singulation_node.main import run_node
from singulation_node.managed_node import ManagedNode
from singulation_node.parameters import parameter

@dataclass(frozen=True)
class Settings:
    rate: float = parameter(1.0, "rate [Hz]", low=0.0, high=2.0)

class Quiet(ManagedNode):
    def __init__(self):
        super().__init__("quiet", Settings)
        if "tell" in sys.argv:
            print("made", flush=True)
    def configure(self):
        if "slow" in sys.argv:
            print("compiling", flush=True)
            time.sleep(60.0)
    def activate(self):
        print("active", flush=True)
    def deactivate(self):
        print("stopped", flush=True)
        if "stubborn" in sys.argv:
            raise RuntimeError("stubborn")

sys.exit(run_node(Quiet, threads=1 if "single" in sys.argv else 4))
"""


@pytest.fixture
def start():
    processes = []
    with reserved_domain() as domain:

        def run(*arguments):
            process = subprocess.Popen(
                [sys.executable, "-u", "-c", PROGRAM, *arguments],
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
                env={**os.environ, "ROS_DOMAIN_ID": str(domain)},
            )
            processes.append(process)
            return process

        yield run
        for process in processes:
            if process.poll() is None:
                process.kill()
            process.communicate(timeout=10)


@pytest.mark.parametrize(
    ("number", "threads"), [(signal.SIGINT, "several"), (signal.SIGTERM, "several"), (signal.SIGINT, "single")]
)
def test_a_signal_deactivates_and_ends_it_without_a_traceback(start, number, threads):
    process = start("--autostart", threads)
    assert process.stdout.readline() == "active\n"
    process.send_signal(number)
    output, errors = process.communicate(timeout=20)
    assert process.returncode == 0
    assert output == "stopped\n"
    assert "Traceback" not in errors


def test_a_signal_ends_a_slow_start_at_once(start):
    process = start("--autostart", "slow")
    assert process.stdout.readline() == "compiling\n"
    process.send_signal(signal.SIGINT)
    output, errors = process.communicate(timeout=20)
    assert process.returncode == 0
    assert output == ""
    assert "Traceback" not in errors


def test_a_failing_deactivation_does_not_keep_it_from_ending(start):
    process = start("--autostart", "stubborn")
    assert process.stdout.readline() == "active\n"
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=20) == 0


def test_a_bad_parameter_ends_it_with_a_message_that_names_it(start):
    process = start("--ros-args", "-p", "rate:=1")
    _, errors = process.communicate(timeout=20)
    assert process.returncode == 1
    assert "parameter rate of quiet" in errors
    assert "such as 1.0" in errors
    good = start("--autostart", "--ros-args", "-p", "rate:=1.5")
    assert good.stdout.readline() == "active\n"


def test_autostart_by_parameter(start):
    process = start("--ros-args", "-p", "autostart:=true")
    assert process.stdout.readline() == "active\n"


def test_without_autostart_it_waits(start):
    process = start("tell")
    assert process.stdout.readline() == "made\n"
    process.send_signal(signal.SIGINT)
    output, _ = process.communicate(timeout=20)
    assert process.returncode == 0
    assert output == ""
