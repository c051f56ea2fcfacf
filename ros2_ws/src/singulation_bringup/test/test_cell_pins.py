"""``scripts/test --cell-pins``: an environment and a build of its own, with the versions of a cell."""

import re
import shutil
import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[4]
REQUIREMENTS = ROOT / "requirements"


def pins(*names):
    """{package: version} of requirement files; open3d has a name for each processor."""
    lines = "\n".join((REQUIREMENTS / f"{name}.txt").read_text() for name in names)
    return dict(re.findall(r"^([\w-]+)==([\w.]+)", lines, re.MULTILINE))


def bash(program, **environment):
    return subprocess.run(
        ["bash", "-c", program],
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
        env={"PATH": "/usr/bin:/bin", "HOME": "/nonexistent", **environment},
    ).stdout.split()


def test_every_library_has_its_version_for_the_cell():
    cell = pins("cell_pins", "cell_pins_without_dependencies")
    assert set(pins("libraries")) <= set(cell)
    assert cell["numpy"].startswith("1.26.")
    assert cell["opencv-python-headless"].startswith("4.6.")


def test_it_stands_beside_the_usual_environment_and_shares_the_sources(tmp_path):
    shutil.copytree(ROOT / "scripts" / "lib", tmp_path / "scripts" / "lib")
    (tmp_path / "ros2_ws" / "src" / "some_package").mkdir(parents=True)
    say = f'source "{tmp_path}/scripts/lib/common.sh"; source "$ROOT/scripts/lib/setup_steps.sh"; '
    say += 'echo "$VENV" "$WORKSPACE" $(requirement_files pypi)'
    usual, cell = bash(say), bash(say, SINGULATION_PINS="cell")
    assert usual[:2] == [f"{tmp_path}/.venv", f"{tmp_path}/ros2_ws"]
    assert cell[:2] == [f"{tmp_path}/.cell/venv", f"{tmp_path}/.cell/ros2_ws"]
    assert [Path(one).name for one in usual[2:]] == ["ros.txt", "libraries.txt", "development.txt"]
    assert [Path(one).name for one in cell[2:]] == ["ros.txt", "cell_pins.txt", "development.txt"]
    assert (tmp_path / ".cell/ros2_ws/src/some_package").is_dir()
