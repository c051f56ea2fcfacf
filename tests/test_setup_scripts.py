"""The set-up: finds a Python that works, mends what the wheels got wrong, is quick when nothing changed."""

import importlib.util
import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy
import pytest

from running_demo import ROOT

SCRIPTS = ROOT / "scripts"


def bash(program, **environment):
    return subprocess.run(
        ["bash", "-c", program],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        env={"PATH": "/usr/bin:/bin", "HOME": "/nonexistent", **environment},
    )


def find_python(versions=r"3\.1[123]", **environment):
    program = f'source "{SCRIPTS}/lib/common.sh"; source "{SCRIPTS}/lib/find_python.sh"; find_python \'{versions}\''
    return bash(program, **environment)


def make_program(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    path.chmod(0o755)
    return path


def test_a_shim_that_does_not_work_is_passed_over(tmp_path):
    shims, real = tmp_path / "shims", tmp_path / "pyenv" / "versions" / "3.12.9" / "bin"
    make_program(shims / "python3.12", "#!/bin/sh\necho 'pyenv: python3.12: command not found' >&2\nexit 127\n")
    make_program(real / "python3", f'#!/bin/sh\nexec "{sys.base_prefix}/bin/python3" "$@"\n')
    found = find_python(PATH=f"{shims}:/usr/bin:/bin", PYENV_ROOT=str(tmp_path / "pyenv"))
    assert found.returncode == 0, found.stderr
    assert os.path.realpath(found.stdout.strip()).startswith(os.path.realpath(sys.base_prefix))


def test_the_named_python_comes_first():
    found = find_python(SINGULATION_PYTHON=sys.executable)
    assert found.stdout.strip() == sys.executable


def test_without_a_usable_python_it_says_what_to_do():
    found = find_python(versions=r"3\.99")
    assert found.returncode == 1
    assert "SINGULATION_PYTHON" in found.stderr
    assert "apt-get install" in found.stderr


@pytest.fixture
def mend():
    spec = importlib.util.spec_from_file_location("mend_cmake_paths", SCRIPTS / "lib" / "mend_cmake_paths.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.mend


def test_the_build_machines_paths_become_ours_and_nothing_else_changes(mend):
    theirs = (
        'set_target_properties(x PROPERTIES INTERFACE "/opt/python/cp312-cp312/include/python3.12;'
        '/opt/python/cp312-cp312/lib/python3.12/site-packages/numpy/_core/include;/opt/else")'
    )
    ours = mend(theirs)
    own_paths = f"{sysconfig.get_path('include')};{numpy.get_include()}"
    assert ours == f'set_target_properties(x PROPERTIES INTERFACE "{own_paths};/opt/else")'
    assert mend(ours) == ours


def test_a_path_with_blanks_gets_a_link_without(tmp_path):
    project = tmp_path / "my robot, 2nd"
    (project / "scripts" / "lib").mkdir(parents=True)
    (project / "scripts" / "lib" / "common.sh").write_text((SCRIPTS / "lib" / "common.sh").read_text())
    found = bash(f'source "{project}/scripts/lib/common.sh"; printf %s "$ROOT"', TMPDIR=str(tmp_path))
    assert " " not in found.stdout
    assert os.path.realpath(found.stdout) == str(project)


def test_set_up_twice_changes_nothing():
    stamp = Path(os.environ.get("WORKSPACE", ROOT / "ros2_ws"), "install", ".stamp")
    before = stamp.stat().st_mtime_ns
    result = subprocess.run([SCRIPTS / "setup"], capture_output=True, text=True, timeout=120, check=False, cwd="/")
    assert result.returncode == 0, result.stderr
    assert "up to date" in result.stderr
    assert stamp.stat().st_mtime_ns == before


def test_an_unknown_executable_names_the_known_ones():
    result = subprocess.run(
        [SCRIPTS / "run", "singulation_perception", "nothing"], capture_output=True, text=True, timeout=120, check=False
    )
    assert result.returncode == 1
    assert "perception_node" in result.stderr


def test_an_unknown_benchmark_names_the_known_ones():
    result = subprocess.run([SCRIPTS / "bench", "nothing"], capture_output=True, text=True, timeout=120, check=False)
    assert result.returncode == 1
    assert "perception" in result.stderr


def test_a_program_that_is_neither_installed_nor_a_package_is_named():
    result = subprocess.run([SCRIPTS / "run", "nothing"], capture_output=True, text=True, timeout=120, check=False)
    assert result.returncode == 1
    assert "no program nothing" in result.stderr
    assert "scripts/run PACKAGE EXECUTABLE" in result.stderr


@pytest.mark.parametrize("script", ["run", "test"])
def test_help_is_given_where_nothing_is_set_up(script, tmp_path):
    """A copy without environment: whatever it would set up stays missing."""
    shutil.copytree(SCRIPTS, tmp_path / "scripts")
    found = bash(f"'{tmp_path}/scripts/{script}' --help")
    assert (found.returncode, found.stderr) == (0, "")
    assert f"scripts/{script} " in found.stdout
    assert [one.name for one in tmp_path.iterdir()] == ["scripts"]
