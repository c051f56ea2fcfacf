"""The paper's own figures, to stand beside ours."""

from typing import NamedTuple

# Scenes of the columns of Table I.
CASES = {"easy": "n == 3 and group < 2", "hard": "n == 15 and group > 1", "average": "n > 0"}


class TableOneRow(NamedTuple):
    """Runtime [ms] (with simulation of the push), then (s' - s)/s and its percentage of Brute Force's."""

    label: str
    runtime: float
    easy: tuple[float, float]
    hard: tuple[float, float]
    average: tuple[float, float]


TABLE_ONE = {
    "brute_force": TableOneRow("Brute Force", 16150.023, (0.751, 100.0), (0.078, 100.0), (0.244, 100.0)),
    "quasi_random": TableOneRow("Quasi-random", 7.850, (0.429, 57.2), (0.018, 23.4), (0.104, 42.8)),
    "boundary_shear": TableOneRow("Boundary Shear", 12.495, (0.510, 67.9), (0.020, 26.2), (0.124, 51.1)),
    "cluster_diffusion": TableOneRow("Cluster Diffusion", 10.474, (0.534, 71.0), (0.032, 41.4), (0.131, 53.9)),
    "center_object_removal": TableOneRow("Center Object Removal", 8.437, (0.647, 86.2), (0.030, 38.3), (0.160, 65.8)),
    "min_contact_range": TableOneRow("Min Contact Range", 12.381, (0.547, 72.8), (0.033, 42.6), (0.153, 62.9)),
    "min_overlap": TableOneRow("Min Overlap", 11.493, (0.666, 88.7), (0.026, 34.6), (0.157, 64.8)),
    "two_cluster_separation": TableOneRow(
        "Two Cluster Separation", 10.609, (0.512, 68.2), (0.025, 31.5), (0.149, 61.4)
    ),
    "cluster_push": TableOneRow("ClusterPush", 8.475, (0.666, 88.7), (0.038, 49.4), (0.171, 70.2)),
}

# (s' - s)/s with a single point, then edge and two points in percent of it (10 to 15 objects).
TABLE_TWO = {
    "quasi_random": (0.027, 114.8, 107.4),
    "boundary_shear": (0.032, 112.5, 109.4),
    "cluster_diffusion": (0.043, 144.2, 151.2),
    "center_object_removal": (0.046, 108.7, 102.2),
    "min_contact_range": (0.050, 110.6, 104.1),
    "min_overlap": (0.042, 105.9, 101.4),
    "two_cluster_separation": (0.044, 113.6, 106.8),
    "cluster_push": (0.056, 112.5, 107.1),
}

# The authors' code in the authors' simulator (its leak of pushers mended), 312 scenes with brute force, measured for
# this project: percent of Brute Force's mean s' - s, all, easy, hard.
AUTHORS_CODE = {
    "quasi_random": (52.8, 60.9, 29.2),
    "boundary_shear": (50.6, 75.2, 16.1),
    "cluster_diffusion": (58.8, 58.9, 41.3),
    "center_object_removal": (60.6, 97.8, 36.0),
    "min_contact_range": (56.2, 68.8, 35.1),
    "min_overlap": (64.5, 89.5, 45.2),
    "two_cluster_separation": (56.1, 53.6, 43.2),
    "cluster_push": (64.8, 89.5, 52.3),
}


def label(policy: str) -> str:
    """The paper's name of a policy, or the policy's own."""
    return TABLE_ONE[policy].label if policy in TABLE_ONE else policy


def in_order(policies: set[str]) -> list[str]:
    """Policies in the order of the paper's tables, others behind them."""
    return [name for name in TABLE_ONE if name in policies] + sorted(policies - set(TABLE_ONE))
