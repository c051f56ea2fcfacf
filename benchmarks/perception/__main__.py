"""Speed beside PCL and Open3D, quality against ground truth, start-up, pictures.

scripts/bench perception [--only PART ...] [--clouds FILE ...] [--out FOLDER] [--without-pcl]

Parts: speed, clusters, separate, touching, gaps, startup, replay, pictures. Each takes one to eight minutes on one
core and replaces only its own tables, so that they may be run one after the other. PCL (C++) is compiled here from
sources in benchmarks/perception/pcl; it needs g++, pkg-config and libpcl-dev. Run on an idle machine: processor time is
counted, but a busy neighbour still takes cache and memory bandwidth.
"""

import argparse
import platform
import sys
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path

import cv2
from benchmarks.perception import pcl_rival
from benchmarks.perception.clustering import run_clusters
from benchmarks.perception.pcl_rival import PclRival
from benchmarks.perception.pictures import draw_recorded, draw_synthetic
from benchmarks.perception.quality import gap_settings, run_quality, separate_settings, touching_settings
from benchmarks.perception.replay_memory import run_replay_memory
from benchmarks.perception.speed import RESOLUTIONS, run_speed
from benchmarks.perception.startup import run_startup
from benchmarks.perception.tables import Table

from singulation_core import SingulationError

Part = Callable[[argparse.Namespace, PclRival | None], Sequence[Table]]


def speed(options: argparse.Namespace, pcl: PclRival | None) -> Sequence[Table]:
    """The whole way."""
    return run_speed(options.scenes or 1, options.rounds, pcl, not options.without_open3d, options.resolutions)


def clusters(options: argparse.Namespace, pcl: PclRival | None) -> Sequence[Table]:
    """Euclidean clustering alone."""
    if pcl is None:
        print("clusters: left out without PCL, there is nothing to compare with", file=sys.stderr)
        return []
    return run_clusters(options.scenes or 2, options.rounds, pcl, options.clouds, options.resolutions)


def separate(options: argparse.Namespace, _: PclRival | None) -> Sequence[Table]:
    """Quality of separate blocks."""
    return run_quality("separate", "Separate blocks", separate_settings(options.scenes or 8))


def touching(options: argparse.Namespace, _: PclRival | None) -> Sequence[Table]:
    """Quality of groups without gaps."""
    return run_quality("touching", "Touching blocks, gap 0", touching_settings(options.scenes or 8))


def gaps(options: argparse.Namespace, _: PclRival | None) -> Sequence[Table]:
    """Found share over the gap."""
    return run_quality("gaps", "Pairs of equal height over the gap between them", gap_settings(options.scenes or 5))


def startup(options: argparse.Namespace, _: PclRival | None) -> Sequence[Table]:
    """Cold and warm."""
    return run_startup(options.rounds)


def replay(options: argparse.Namespace, _: PclRival | None) -> Sequence[Table]:
    """Memory of replay_clouds."""
    return run_replay_memory(options.gigabytes)


def pictures(options: argparse.Namespace, _: PclRival | None) -> Sequence[Table]:
    """PNG files beside the tables."""
    paths = [*draw_synthetic(options.out), *draw_recorded(options.clouds, options.out)]
    print("pictures:", *paths)
    return []


PARTS: dict[str, Part] = {
    one.__name__: one for one in (speed, clusters, separate, touching, gaps, startup, replay, pictures)
}


def main() -> int:
    """Run the chosen parts."""
    options = _options()
    options.out.mkdir(parents=True, exist_ok=True)
    cv2.setNumThreads(1)
    try:
        with ExitStack() as stack:
            wanted = not options.without_pcl and {"speed", "clusters"} & set(options.only)
            pcl = stack.enter_context(PclRival(options.out / "pcl")) if wanted else None
            (options.out / "machine.md").write_text(_machine(pcl), encoding="utf-8")
            for name in options.only:
                print(f"== {name}", file=sys.stderr, flush=True)
                for table in PARTS[name](options, pcl):
                    table.write(options.out)
                    print(table.markdown(), flush=True)
    except SingulationError as error:
        print(f"perception benchmark: {error}", file=sys.stderr)
        return 1
    return 0


def _machine(pcl: PclRival | None) -> str:
    described = Path("/proc/cpuinfo").read_text(encoding="utf-8") if Path("/proc/cpuinfo").exists() else ""
    models = [line.split(":")[1].strip() for line in described.splitlines() if line.startswith("model name")]
    versions = f"Python {platform.python_version()}, OpenCV {cv2.__version__}"
    versions += f", PCL {pcl_rival.version()}" if pcl is not None else ""
    return f"{len(models)} x {models[0] if models else platform.machine()}; {versions}\n"


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="scripts/bench perception", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("--only", nargs="+", choices=list(PARTS), default=list(PARTS), metavar="PART", help="parts to run")
    add("--scenes", type=int, default=0, help="scenes of each kind (default: what suits the part)")
    add("--rounds", type=int, default=5, help="of each measurement of time (default %(default)s)")
    add("--clouds", nargs="+", type=Path, default=[], metavar="FILE", help="recorded clouds (PCD, PLY) to look at too")
    add("--gigabytes", type=int, default=4, help="largest bag of the part replay, at least 2 (default %(default)s)")
    add("--without-pcl", action="store_true", help="no rival in C++, on machines without libpcl-dev")
    add("--without-open3d", action="store_true", help="part speed without Open3D, which takes longest")
    add("--resolutions", nargs="+", choices=list(RESOLUTIONS), default=list(RESOLUTIONS), help="of speed, clusters")
    add("--out", type=Path, default=Path("bench_results/perception"), help="folder (default %(default)s)")
    options = parser.parse_args()
    if not (options.gigabytes >= 2):  # half of it is the memory that the process may have
        parser.error(f"--gigabytes {options.gigabytes}: need at least 2, a cloud of 38 MB takes some 0.6 GB to play")
    return options


if __name__ == "__main__":
    sys.exit(main())
