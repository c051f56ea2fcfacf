"""Which sets of blocks the experiments use."""

from collections.abc import Sequence
from dataclasses import dataclass

from singulation_bringup.closed_loop.trial import Trial
from singulation_bringup.policy_choice import DEFAULT_MIN_GAP, FALLBACK_POLICIES
from singulation_core import ContactMode

SQUARES, MIXED = "squares", "mixed"
ONE_PUSH, SEPARATE = "one_push", "separate"
TABLE_POLICIES = ("cluster_push", "cluster_diffusion")
MODES = tuple(mode.label for mode in ContactMode)
_NEVER = 10.0  # m; a gap that is never reached, so that the push is always done


@dataclass(frozen=True, slots=True)
class Configuration:
    """Kind and number of blocks."""

    kind: str
    blocks: int


# The paper has 8 configurations of 3 to 7 blocks and 5 sets of each, does not list them, and calls three squares easy
# and mixed shapes hard. Ours: squares and mixed shapes, 3, 4, 5 and 7 of them.
CONFIGURATIONS = tuple(Configuration(kind, blocks) for kind in (SQUARES, MIXED) for blocks in (3, 4, 5, 7))
EASY = Configuration(SQUARES, 3)
COUNTS = (3, 4, 5, 6, 7)


def one_push_trials(sets: int, policies: Sequence[str] = TABLE_POLICIES, modes: Sequence[str] = MODES) -> list[Trial]:
    """Table III: one push of each policy and mode on the same ``sets`` sets of every configuration.

    Sets outermost, so that a run that stops early is balanced. There is no other policy to fall back on: a push that
    cannot be performed counts as no change.
    """
    return [
        Trial(ONE_PUSH, one.kind, one.blocks, seed, policy, mode, 1, _NEVER)
        for seed in range(sets)
        for one in CONFIGURATIONS
        for policy in policies
        for mode in modes
    ]


def separate_trials(
    sets: int, policies: Sequence[str], modes: Sequence[str], counts: Sequence[int] = COUNTS, max_pushes: int = 10
) -> list[Trial]:
    """Mixed blocks, pushed until separated, with the coordinator's own policies to fall back on."""
    return [
        Trial(SEPARATE, MIXED, blocks, seed, policy, mode, max_pushes, DEFAULT_MIN_GAP, FALLBACK_POLICIES)
        for seed in range(sets)
        for blocks in counts
        for policy in policies
        for mode in modes
    ]
