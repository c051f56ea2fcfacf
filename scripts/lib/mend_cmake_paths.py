"""Mends the CMake files of the ROS wheels in this environment.

The wheels were built elsewhere, and the exported targets of every interface package name that machine's Python and
NumPy headers. They are replaced by this environment's own; run again, nothing is left to replace.
"""

import re
import sys
import sysconfig
from pathlib import Path

import numpy

_NUMPY = re.compile(r"/opt/python/cp\d+-cp\d+/lib/python3\.\d+/site-packages/numpy/_core/include")
_PYTHON = re.compile(r"/opt/python/cp\d+-cp\d+/include/python3\.\d+")


def mend(text: str) -> str:
    """The text with the build machine's include folders replaced."""
    include = sysconfig.get_path("include")
    return _PYTHON.sub(lambda _: include, _NUMPY.sub(lambda _: numpy.get_include(), text))


def main() -> None:
    """Mend every exported target below the environment's share folder and say how many."""
    mended = 0
    for path in sorted(Path(sys.prefix, "share").glob("*/cmake/*__rosidl_generator_pyExport.cmake")):
        before = path.read_text()
        after = mend(before)
        if after != before:
            path.write_text(after)
            mended += 1
    print(f"{mended} build files of the ROS packages now point into this environment")


if __name__ == "__main__":
    main()
