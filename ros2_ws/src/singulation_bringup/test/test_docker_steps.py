"""The shell steps of the Dockerfile, run one after another in a folder that stands in for the image.

ROS from PyPI takes the place of /opt/ros, programs that note what they are asked the place of apt-get, rosdep and the
user tools. Not tried here: what those programs would do, and pip in the image.
"""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from ros2_ws.src.singulation_bringup.test.test_docker import ROOT, instructions

STEPS = [body for name, body in instructions() if name == "RUN"]
NOTING = ("apt-get", "rosdep", "userdel", "useradd", "install")
# Folders of the image, which stand below the test's own.
PLACES = ("/opt/ros/jazzy", "/var/lib/apt/lists", "/tmp/manifests")


def step(words):
    (found,) = [one for one in STEPS if words in one]
    return found


@pytest.fixture
def image(tmp_path):
    """Folders of an image: programs that take notes, and this environment as its ROS."""
    for name in NOTING:
        program = tmp_path / "bin" / name
        program.parent.mkdir(exist_ok=True)
        program.write_text(f'#!/bin/sh\necho "{name} $*" >> "{tmp_path}/asked"\n')
        program.chmod(0o755)
    for place in PLACES:
        (tmp_path / place.lstrip("/")).mkdir(parents=True)
        (tmp_path / place.lstrip("/") / "left").touch()
    setup = f"export ROS_DISTRO=jazzy AMENT_PREFIX_PATH={sys.prefix} CMAKE_PREFIX_PATH={sys.prefix}\n"
    (tmp_path / "opt/ros/jazzy/setup.bash").write_text(setup)
    return tmp_path


def run(image, text, folder=None):
    for place in PLACES:
        text = text.replace(place, f"{image}{place}")
    return subprocess.run(
        ["bash", "-o", "pipefail", "-c", text],
        capture_output=True,
        text=True,
        timeout=200,
        check=False,
        cwd=folder or image,
        env={"PATH": f"{image}/bin:/usr/bin:/bin:/usr/sbin:/sbin", "HOME": str(image / "home")},
    )


def asked(image):
    return (image / "asked").read_text().splitlines()


def test_the_packages_are_those_that_the_set_up_would_ask_for(image):
    done = run(image, step("libegl1"))
    assert done.returncode == 0, done.stderr
    update, install = asked(image)
    assert update == "apt-get update"
    wanted = (ROOT / "scripts/lib/setup_steps.sh").read_text().partition("<<'LIST'\n")[2].partition("LIST")[0]
    assert {line.split()[1] for line in wanted.splitlines()} <= set(install.split())
    assert {"python3-venv", "python3-pip", "util-linux"} <= set(install.split())
    assert not (image / "var/lib/apt/lists/left").exists()


def test_dependencies_are_resolved_from_the_manifests_for_jazzy(image):
    done = run(image, step("rosdep install"))
    assert done.returncode == 0, done.stderr
    assert [line.split()[:2] for line in asked(image)] == [
        ["apt-get", "update"],
        ["rosdep", "update"],
        ["rosdep", "install"],
    ]
    assert f"--from-paths {image}/tmp/manifests --ignore-src --rosdistro jazzy -y" in asked(image)[2]
    assert not (image / "tmp/manifests").exists()


def test_the_user_is_made_also_where_the_image_has_none_of_the_name(image):
    (image / "bin/userdel").write_text("#!/bin/sh\nexit 6\n")
    done = run(image, step("useradd"))
    assert done.returncode == 0, done.stderr
    assert [line.split()[0] for line in asked(image)] == ["useradd", "install"]


def test_skipped_keys_come_from_pypi():
    skipped = re.findall(r"--skip-keys (\S+)", step("rosdep install"))
    wanted = (ROOT / "requirements/cell.txt").read_text().split()
    assert [key.removeprefix("python3-") for key in skipped] == ["numba"]
    assert {"numba", "numpy<2"} <= set(wanted)


def environment_like(folder):
    """This virtual environment under another path, as the set-up leaves it in the image: it is not made anew."""
    folder.mkdir()
    for entry in Path(sys.prefix).iterdir():
        if entry.name not in (".stamp", ".route"):
            (folder / entry.name).symlink_to(entry)
    stamp = f'ROOT="{folder.parent}"; cd "$ROOT/requirements"; cat cell.txt development.txt constraints.txt | cksum'
    sums = subprocess.run(["bash", "-c", stamp], capture_output=True, text=True, timeout=60, check=True).stdout.strip()
    (folder / ".stamp").write_text(f"sourced {sums}\n")
    (folder / ".route").write_text("sourced\n")


def test_the_layers_build_and_the_entrypoint_finds_what_was_built(image):
    """First without sources, then with one package, then the container starts: all with the real set-up and colcon."""
    suite = image / "suite"
    for name in ("scripts", "requirements", "docker"):
        shutil.copytree(ROOT / name, suite / name, ignore=shutil.ignore_patterns("__pycache__"))
    environment_like(suite / ".venv")
    layers = [one for one in STEPS if "scripts/setup" in one]
    assert len(layers) == 2
    bare = run(image, layers[0], suite)
    assert bare.returncode == 0, bare.stderr
    assert (suite / "ros2_ws/install/local_setup.bash").is_file()
    package = Path("ros2_ws/src/singulation_core")
    shutil.copytree(ROOT / package, suite / package, ignore=shutil.ignore_patterns("__pycache__", "test"))
    whole = run(image, layers[1], suite)
    assert whole.returncode == 0, whole.stderr
    assert not (suite / "ros2_ws/log").exists()
    found = run(
        image,
        f'ROS_SETUP=/opt/ros/jazzy/setup.bash "{suite}/docker/entrypoint.sh" '
        'python -c "import singulation_core, sys; print(singulation_core.__file__, sys.executable)"',
    )
    assert found.returncode == 0, found.stderr
    module, python = found.stdout.split()
    assert module.startswith(str(suite / "ros2_ws"))
    assert python == str(suite / ".venv/bin/python")
