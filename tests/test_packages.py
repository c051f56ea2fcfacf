"""Package files tell the truth, and what they promise is where ros2 run looks."""

import ast
import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
from ament_index_python.packages import get_package_prefix

from running_demo import ROOT

SOURCE = ROOT / "ros2_ws" / "src"
PACKAGES = sorted(path.parent.name for path in SOURCE.glob("*/package.xml"))
PYTHON_PACKAGES = [name for name in PACKAGES if (SOURCE / name / "setup.py").exists()]

# Import name -> rosdep key; whatever is not listed and not of the standard library is a ROS package of its own name.
ROSDEP = {
    "cv2": "python3-opencv",
    "matplotlib": "python3-matplotlib",
    "numba": "python3-numba",
    "llvmlite": "python3-numba",  # which is made for it and brings it along
    "numpy": "python3-numpy",
    "PIL": "python3-pil",
    "psutil": "python3-psutil",
    "pytest": "python3-pytest",
    "scipy": "python3-scipy",
    "tf2_ros": "tf2_ros_py",
    "yaml": "python3-yaml",
    "pandas": "python3-pandas",
}
# On PyPI only: no rosdep key; the set-up installs them from requirements/.
WITHOUT_KEY = {"dask", "distributed", "hypothesis", "open3d", "pyarrow", "pymunk", "rosbags"}


def imports(package):
    """Names of the packages that the sources of a package import, its own aside."""
    found = set()
    for path in (SOURCE / package / package).rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import):
                found |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                found.add(node.module.split(".")[0])
    return found - set(sys.stdlib_module_names) - {package}


def manifest(package):
    return ElementTree.parse(SOURCE / package / "package.xml").getroot()


@pytest.mark.parametrize("package", PYTHON_PACKAGES)
def test_dependencies_are_those_of_the_imports(package):
    needed = {ROSDEP.get(name, name) for name in imports(package) - WITHOUT_KEY}
    declared = {element.text for element in manifest(package).findall("exec_depend")}
    assert needed <= declared
    assert declared - needed <= set(PACKAGES)  # beyond imports only packages whose executables are started by name


@pytest.mark.parametrize("package", PACKAGES)
def test_manifests_agree_on_version_and_licence(package):
    root = manifest(package)
    assert root.get("format") == "3"
    assert root.findtext("name") == package
    assert root.findtext("license") == "Apache-2.0"
    assert root.findtext("version") == manifest(PACKAGES[0]).findtext("version")
    if package in PYTHON_PACKAGES:
        setup = (SOURCE / package / "setup.py").read_text()
        assert f'version="{root.findtext("version")}"' in setup
        assert 'license="Apache-2.0"' in setup


@pytest.mark.parametrize("package", PYTHON_PACKAGES)
def test_types_are_shipped(package):
    assert (SOURCE / package / package / "py.typed").exists()
    assert "py.typed" in (SOURCE / package / "setup.py").read_text()


def executables():
    for package in PYTHON_PACKAGES:
        for name in re.findall(r'"(\w+) = [\w.]+:main"', (SOURCE / package / "setup.py").read_text()):
            yield package, name


@pytest.mark.parametrize(("package", "executable"), executables())
def test_executables_are_where_ros2_run_looks(package, executable):
    program = Path(get_package_prefix(package), "lib", package, executable)
    assert program.is_file()
    assert program.stat().st_mode & 0o111


@pytest.mark.parametrize("package", [name for name in PYTHON_PACKAGES if name not in ("singulation_node",)])
def test_libraries_do_not_import_ros(package):
    """Algorithms work where ROS is absent: only the border modules may know it."""
    program = (
        "import sys, importlib.abc\n"
        "class NoRos(importlib.abc.MetaPathFinder):\n"
        "    def find_spec(self, name, path=None, target=None):\n"
        "        top = name.split('.')[0]\n"
        "        if top == 'rclpy' or top.endswith('_msgs'):\n"
        "            raise ImportError(f'{name} is ROS')\n"
        "sys.meta_path.insert(0, NoRos())\n"
        f"import {package}\n"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120, check=False)
    assert result.returncode == 0, result.stderr


def test_the_licence_is_apache():
    text = (ROOT / "LICENSE").read_text()
    assert "Apache License" in text
    assert "Version 2.0, January 2004" in text
