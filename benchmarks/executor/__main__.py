"""Plans random pushes over the lab's workspace, audits every motion, and draws the three kinds.

scripts/bench executor [--pushes 1000] [--seed 0] [--out DIR] [--no-pictures | --no-animations] [--no-audit]
"""

import argparse
from pathlib import Path

from benchmarks.executor.pictures import save_pictures
from benchmarks.executor.pushes import random_tasks
from benchmarks.executor.reach import reach_map
from benchmarks.executor.report import write_report
from benchmarks.executor.trials import run, write_trials


def main() -> None:
    """Run everything and write Markdown, CSV and pictures."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--pushes", type=int, default=1000, help="with blocks, and as many without")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=Path("bench_results/executor"))
    parser.add_argument("--no-pictures", action="store_true")
    parser.add_argument("--no-animations", action="store_true", help="pictures only")
    parser.add_argument("--no-audit", action="store_true", help="only plan and measure time")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    reach = reach_map(0.02)
    sets = {
        name: run(random_tasks(options.pushes, options.seed, blocks), reach, not options.no_audit)
        for name, blocks in (("empty table", False), ("3 to 7 blocks", True))
    }
    write_report(options.out / "executor.md", reach, sets)
    for name, trials in sets.items():
        write_trials(options.out / f"pushes_{name.replace(' ', '_')}.csv", trials)
    print((options.out / "executor.md").read_text())
    if not options.no_pictures:
        print("pictures:", *save_pictures(options.out, not options.no_animations))


if __name__ == "__main__":
    main()
