"""Point Cloud Library (C++) as a rival in a process of its own; built here, from sources of ours beside this file."""

import shutil
import subprocess
from pathlib import Path
from types import TracebackType

import numpy as np
from numpy.typing import NDArray

from singulation_core import ResultCode, SingulationError
from singulation_core.polygon import FloatArray

_SOURCES = Path(__file__).parent / "pcl"
_MODULES = ("common", "filters", "kdtree", "search", "segmentation", "surface")
_FLAGS = ("-std=c++17", "-O3", "-DNDEBUG")
_BUILD_LIMIT = 600.0  # s


def build(folder: Path) -> Path:
    """The rival's program, compiled unless it is newer than its sources.

    Raises:
        SingulationError: ``NOT_READY``: no compiler or no libpcl; ``INTERNAL``: it does not compile.
    """
    program = folder / "pcl_rival"
    sources = [*_SOURCES.glob("*.cpp"), *_SOURCES.glob("*.hpp")]
    if program.exists() and program.stat().st_mtime > max(file.stat().st_mtime for file in sources):
        return program
    folder.mkdir(parents=True, exist_ok=True)
    units = [str(file) for file in sources if file.suffix == ".cpp"]
    command = ["g++", *_FLAGS, *_package("--cflags"), *units, "-o", str(program), *_package("--libs")]
    made = subprocess.run(command, capture_output=True, text=True, timeout=_BUILD_LIMIT, check=False)
    if made.returncode != 0:
        raise SingulationError(ResultCode.INTERNAL, f"the PCL program does not compile: {made.stderr[-2000:]}")
    return program


def version() -> str:
    """Of the installed PCL."""
    return _package("--modversion", ("common",))[0]


def _package(question: str, modules: tuple[str, ...] = _MODULES) -> list[str]:
    if shutil.which("g++") is None or shutil.which("pkg-config") is None:
        raise SingulationError(ResultCode.NOT_READY, "no g++ or no pkg-config; install them or leave the rival out")
    command = ["pkg-config", question, *(f"pcl_{name}" for name in modules)]
    answer = subprocess.run(command, capture_output=True, text=True, timeout=30.0, check=False)
    if answer.returncode != 0:
        raise SingulationError(
            ResultCode.NOT_READY, f"no PCL ({answer.stderr.strip()}); apt-get install libpcl-dev, or --without-pcl"
        )
    return answer.stdout.split()


class PclRival:
    """Asks the program line by line; for use in a ``with`` block.

    Args:
        folder: where the program is built and clouds are handed over.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        program = build(folder)
        pipe = subprocess.PIPE
        self._process = subprocess.Popen([str(program)], stdin=pipe, stdout=pipe, text=True)

    def __enter__(self) -> "PclRival":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._process.communicate(timeout=60.0)

    def load(self, points: NDArray[np.float32]) -> None:
        """Hand over (..., 3) points [m]."""
        path = self._folder / "points.bin"
        np.ascontiguousarray(points, np.float32).tofile(path)
        self._ask(f"load {path}")

    def convert(self) -> tuple[float, float]:
        """Processor and wall milliseconds from a message with these points to PCL's own cloud."""
        processor, wall = self._ask("convert").split()
        return float(processor), float(wall)

    def pipeline(
        self,
        leaf: float,
        tolerance: float,
        min_size: int,
        workspace: tuple[float, ...],
        pose: FloatArray,
        *,
        pass_through: bool = False,
    ) -> tuple[float, float, list[FloatArray]]:
        """Processor and wall milliseconds, and outlines (k, 2) in ``table`` [m]; see ``pcl/pipeline.hpp``."""
        words = (leaf, tolerance, min_size, int(pass_through), *workspace, *pose[:3].ravel())
        numbers = [float(word) for word in self._ask("pipeline " + " ".join(map(str, words))).split()]
        outlines, place = [], 4
        for _ in range(int(numbers[3])):
            count = int(numbers[place])
            outlines.append(np.reshape(numbers[place + 1 : place + 1 + 2 * count], (count, 2)))
            place += 1 + 2 * count
        return numbers[0], numbers[1], outlines

    def clusters(self, tolerance: float, *, sorted_tree: bool) -> tuple[float, float, NDArray[np.int32]]:
        """Processor and wall milliseconds, and labels (N,)."""
        path = self._folder / "labels.bin"
        processor, wall = self._ask(f"clusters {tolerance!r} {int(sorted_tree)} {path}").split()
        return float(processor), float(wall), np.fromfile(path, dtype=np.int32)

    def _ask(self, line: str) -> str:
        assert self._process.stdin is not None and self._process.stdout is not None
        self._process.stdin.write(line + "\n")
        self._process.stdin.flush()
        answer = self._process.stdout.readline().rstrip("\n")
        if not answer.startswith("ok "):
            raise SingulationError(ResultCode.INTERNAL, f"the PCL program: {answer or 'ended'}; asked for {line[:80]}")
        return answer[3:]
