"""The container files as far as they can be tried without a Docker engine.

Not tried here: pulling ros:jazzy, apt, rosdep, useradd, and docker compose itself.
"""

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
import yaml
from ros2_ws.src.singulation_bringup.test.launch_reading import LAUNCH, arguments

from singulation_node.large_messages import segment_size

ROOT = Path(__file__).parents[4]
DOCKER = ROOT / "docker"


def instructions():
    text = re.sub(r"^\s*#.*\n", "", (DOCKER / "Dockerfile").read_text(), flags=re.MULTILINE)
    lines = re.sub(r"\\\n", " ", text).splitlines()
    return [tuple(line.split(None, 1)) for line in lines if line.strip()]


def bash(program, cwd=None, **environment):
    return subprocess.run(
        ["bash", "-c", program],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        cwd=cwd,
        env={"PATH": "/usr/bin:/bin", "HOME": "/nonexistent", **environment},
    )


@pytest.mark.parametrize("step", [body for name, body in instructions() if name == "RUN"], ids=lambda step: step[:30])
def test_every_shell_step_is_shell(step):
    checked = subprocess.run(["bash", "-n", "-c", step], capture_output=True, text=True, timeout=60, check=False)
    assert checked.returncode == 0, checked.stderr


def test_layers_go_from_what_changes_least_to_what_changes_most():
    steps = [f"{name} {body}" for name, body in instructions()]
    order = [
        "apt-get install",
        "rosdep install",
        "useradd",
        "COPY --chown=singulation requirements",
        "COPY --chown=singulation . .",
    ]
    places = [next(k for k, step in enumerate(steps) if words in step) for words in order]
    assert places == sorted(places)
    assert steps[0].startswith("FROM ros:jazzy")


def test_it_does_not_run_as_root_and_ends_in_the_entrypoint():
    names = [name for name, _ in instructions()]
    users = [body for name, body in instructions() if name == "USER"]
    assert users == ["singulation"]
    assert names.index("USER") < names.index("ENTRYPOINT")
    entry = json.loads(dict(instructions())["ENTRYPOINT"])[0]
    program = ROOT / Path(entry).relative_to("/opt/singulation")
    assert program.stat().st_mode & 0o111


def test_what_is_copied_exists():
    for name, body in instructions():
        if name == "COPY" and "--from" not in body:
            source = next(word for word in body.split() if not word.startswith("--"))
            assert (ROOT / source).exists()


def test_the_dependency_layer_sees_manifests_only(tmp_path):
    shutil.copytree(
        ROOT / "ros2_ws" / "src", tmp_path / "manifests", ignore=shutil.ignore_patterns("*.nb?", "__pycache__")
    )
    step = next(body for name, body in instructions() if name == "RUN" and "find /manifests" in body)
    assert bash(step.replace("/manifests", str(tmp_path / "manifests"))).returncode == 0
    left = {
        str(path.relative_to(tmp_path / "manifests")) for path in (tmp_path / "manifests").rglob("*") if path.is_file()
    }
    assert left == {f"{path.parent.name}/package.xml" for path in (ROOT / "ros2_ws" / "src").glob("*/package.xml")}


def test_set_up_takes_the_ros_of_the_image():
    """The environment of ros:jazzy after its setup.bash is taken for a ROS installation."""
    route = f'source "{ROOT}/scripts/lib/common.sh"; VENV=/nowhere; ros_route'
    assert bash(route, ROS_DISTRO="jazzy", AMENT_PREFIX_PATH="/opt/ros/jazzy").stdout.strip() == "sourced"
    assert bash(route).stdout.strip() == "pypi"


@pytest.fixture
def suite(tmp_path):
    """A folder with a set-up ROS, environment and workspace, each of which leaves its mark."""
    files = {
        "ros/setup.bash": "export FROM_ROS=$NOT_SET_BEFORE:ros ROS_DISTRO=jazzy\n",
        "ros2_ws/install/local_setup.bash": "export FROM_WORKSPACE=$FROM_ROS:workspace\n",
        ".venv/bin/which_python": "#!/bin/sh\necho venv\n",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    (tmp_path / ".venv/bin/which_python").chmod(0o755)
    return tmp_path


def enter(suite, *command, **environment):
    return subprocess.run(
        [DOCKER / "entrypoint.sh", *command],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        env={
            "PATH": "/usr/bin:/bin",
            "SUITE": str(suite),
            "ROS_SETUP": str(suite / "ros/setup.bash"),
            **environment,
        },
    )


def test_the_entrypoint_sources_everything_and_becomes_the_command(suite):
    seen = enter(
        suite, "bash", "-c", 'which_python; echo "$FROM_WORKSPACE|$ROS_AUTOMATIC_DISCOVERY_RANGE|$1"', "x", "a  b"
    )
    assert seen.returncode == 0, seen.stderr
    assert seen.stdout.splitlines() == ["venv", ":ros:workspace|LOCALHOST|a  b"]
    assert enter(suite, "bash", "-c", "exit 7").returncode == 7
    assert "SUBNET" in enter(suite, "env", ROS_AUTOMATIC_DISCOVERY_RANGE="SUBNET").stdout


def test_the_entrypoint_fails_where_something_is_missing(suite):
    os.remove(suite / "ros2_ws/install/local_setup.bash")
    failed = enter(suite, "echo", "reached")
    assert failed.returncode != 0
    assert "reached" not in failed.stdout


COMPOSE = yaml.safe_load((DOCKER / "compose.yaml").read_text())


@pytest.mark.parametrize("name", COMPOSE["services"])
def test_a_service_shares_network_and_memory_with_the_host(name):
    service = COMPOSE["services"][name]
    assert (service["network_mode"], service["ipc"], service["init"]) == ("host", "host", True)
    assert service["build"]["dockerfile"] == "docker/Dockerfile"
    assert (DOCKER / service["build"]["context"] / service["build"]["dockerfile"]).is_file()


@pytest.mark.parametrize("name", COMPOSE["services"])
def test_the_command_of_a_service_exists(name):
    command = COMPOSE["services"][name]["command"]
    if command[:2] == ["ros2", "launch"]:
        declared = arguments(LAUNCH / command[3])
        given = dict(item.split(":=", 1) for item in command[4:])
        assert set(given) <= set(declared)
        assert {one for one, words in declared.items() if "default_value" not in words} <= set(given)
    elif command[:2] == ["ros2", "run"]:
        setup = (ROOT / "ros2_ws/src" / command[2] / "setup.py").read_text()
        assert f'"{command[3]} = ' in setup
    elif command[0] != "ros2":
        assert (ROOT / command[0]).stat().st_mode & 0o111


def test_what_is_said_of_shared_memory_is_true():
    assert f"takes {segment_size() >> 20} MB" in re.sub(r"\n\s*#", "", (DOCKER / "compose.yaml").read_text())


def test_the_context_leaves_out_what_is_made():
    ignored = (DOCKER / "Dockerfile.dockerignore").read_text().split()
    for made in (".venv", "ros2_ws/build", "ros2_ws/install", "results", "bench_results", ".git"):
        assert made in ignored
