"""Rollout Push against Brute Force: gain against time, with noise, choosing the contact mode, pushes to separation.

scripts/bench rollout [--seeds 10] [--noise-seeds 4] [--separation 50] [--fast] [--only PART ...] [--out DIR]

A run that was stopped goes on where it was; start a new folder (--out) where the planner has changed. Processor time of
one core. Seeds of the judged scenes: from 7000 (pushes of one scene), 8000 (separation), 9000 (simulators). What was
calibrated in the planner was calibrated on scenes with seeds 3000 to 3199.
"""

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from benchmarks.rollout.judges import JUDGES
from benchmarks.rollout.planners import BRUTE_FORCE, FAST_BRUTE_FORCE, LONG, MODES, NOMINAL, ROBUST, WORKED, Planner
from benchmarks.rollout.plans import Store, recipes
from benchmarks.rollout.report import frontier, hindsight, share_table
from benchmarks.rollout.separation import LIMITS, WAYS, separation_report
from benchmarks.rollout.timing import timing_report
from benchmarks.rollout.validation import validation_report

from singulation_planner import warm_up
from singulation_planner.benchmark.evaluate import SceneRecipe

_TIMED = ("cluster_push", "rollout_0ms", "rollout_8", "rollout_32", "rollout_96", "rollout_160", "rollout_400")
_CLEAN = {"pymunk": "fine pymunk", "box2d": "Box2D"}


def nominal(options: argparse.Namespace) -> str:
    """Gain against time."""
    store, scenes = Store(options.out), recipes(options.seeds)
    _complete(options, store, scenes, NOMINAL, _CLEAN)
    drawn = [one for one in NOMINAL if one.policy != "rollout_push" or one in WORKED or one.name == "rollout_0ms"]
    drawn += [one for one in LONG if one.policy == "rollout_push"]
    frontier(store, scenes, drawn, options.out / "rollout_frontier.png", options.reference)
    table = share_table(store, scenes, NOMINAL, _CLEAN, options.reference)
    return table + "\n![Gain against time](rollout_frontier.png)\n"


def long(options: argparse.Namespace) -> str:
    """Budgets of seconds."""
    store, scenes = Store(options.out), recipes(1)
    _complete(options, store, scenes, LONG, _CLEAN)
    return share_table(store, scenes, LONG, _CLEAN, options.reference)


def noise(options: argparse.Namespace) -> str:
    """With noise of perception and friction."""
    store, scenes = Store(options.out), recipes(options.noise_seeds)
    columns = {"noise": "start moved back", "noise_or_nothing": "blocked start gains nothing"}
    _complete(options, store, scenes, ROBUST, columns)
    best = hindsight(store, scenes, ROBUST, columns, options.reference)
    return share_table(store, scenes, ROBUST, columns, options.reference) + best


def modes(options: argparse.Namespace) -> str:
    """Choosing the contact mode too."""
    store, scenes = Store(options.out), recipes(options.seeds)
    _complete(options, store, scenes, MODES, _CLEAN)
    return share_table(store, scenes, MODES, _CLEAN, options.reference)


def separation(options: argparse.Namespace) -> str:
    """Pushes until every gap is wider than 0.4 bounding radii."""
    return separation_report(
        options.out, 0 if options.tables_only else options.separation, list(LIMITS), WAYS[: options.ways]
    )


def simulators(options: argparse.Namespace) -> str:
    """Errors of the simulators."""
    return validation_report(options.out, options.validation_seeds, 0 if options.tables_only else options.pushes)


def _complete(
    options: argparse.Namespace,
    store: Store,
    scenes: Sequence[SceneRecipe],
    planners: Sequence[Planner],
    judges: Mapping[str, str],
) -> None:
    if options.tables_only:
        return
    wanted = [one for one in planners if one.policy != "brute_force"]
    store.complete(scenes, [*wanted, options.reference], {name: JUDGES[name] for name in judges})


def timing(_options: argparse.Namespace) -> str:
    """Processor time."""
    return timing_report([one for one in NOMINAL if one.name in _TIMED], (3, 5, 10, 15))


PARTS: dict[str, tuple[str, Callable[[argparse.Namespace], str]]] = {
    "long": ("Budgets of seconds, 52 scenes", long),
    "nominal": ("Gain against time", nominal),
    "noise": ("With noise: poses 0.05 bounding radii and 0.05 rad, friction 0.1 (standard deviations)", noise),
    "modes": ("Choosing the contact mode too", modes),
    "timing": ("Processor time, least of 12 repetitions", timing),
    "simulators": ("Errors of the simulators against pymunk in steps of 0.005 bounding radii", simulators),
    "separation": ("Pushes until all gaps are wider than 0.4 bounding radii", separation),
}


def main() -> int:
    """Run the parts and gather them in ``rollout.md``."""
    options = _options()
    if not options.tables_only:
        warm_up()
    options.out.mkdir(parents=True, exist_ok=True)
    texts = [f"# Rollout Push benchmark\n\nCommand: `scripts/bench rollout {' '.join(sys.argv[1:])}`\n"]
    for name in options.only:
        title, part = PARTS[name]
        print(f"== {title}", file=sys.stderr)
        texts.append(f"## {title}\n\n{part(options)}")
    (options.out / "rollout.md").write_text("\n".join(texts), encoding="utf-8")
    print("\n".join(texts))
    return 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="scripts/bench rollout", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("--seeds", type=int, default=10, help="52 scenes each, without noise (default: %(default)s)")
    add("--noise-seeds", type=int, default=4, help="the same with noise (default: %(default)s)")
    add("--validation-seeds", type=int, default=2, help="the same for the simulators (default: %(default)s)")
    add("--pushes", type=int, default=30, help="for each scene, for the simulators (default: %(default)s)")
    add("--separation", type=int, default=50, help="scenes for each number of blocks (default: %(default)s)")
    add("--ways", type=int, default=len(WAYS), help="how many of the ways to separate (default: all %(default)s)")
    add("--only", nargs="+", choices=list(PARTS), default=list(PARTS), metavar="PART", help=", ".join(PARTS))
    add("--out", type=Path, default=Path("bench_results/rollout"))
    add("--fast", action="store_true", help="compare with Brute Force in the compiled simulator, a tenth of the work")
    add("--tables-only", action="store_true", help="plan nothing, make the tables of what is there")
    options = parser.parse_args()
    options.reference = FAST_BRUTE_FORCE if options.fast else BRUTE_FORCE
    return options


if __name__ == "__main__":
    sys.exit(main())
