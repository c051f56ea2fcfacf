"""How the closed loop chooses pushes unless it is told otherwise."""

from typing import Any

# What a finger needs to come down between two blocks: 12 mm wide at its tip, and it may stand at any heading [m].
DEFAULT_MIN_GAP = 0.012
# It looks for gaps all around, where the paper's policies look for a large mean distance.
DEFAULT_POLICY = "rollout_push"
# Asked in this order when a planned push cannot be performed.
FALLBACK_POLICIES = (
    "min_overlap",
    "center_object_removal",
    "cluster_diffusion",
    "boundary_shear",
    "min_contact_range",
    "two_cluster_separation",
    "quasi_random",
)
# A gap is seen within this [m]; without it, blocks that are just far enough apart look as if they were not.
_SEEN_WITHIN = 0.002


def options_towards(policy: str, min_gap: float) -> dict[str, Any]:
    """Options of a policy that can aim at gaps, so that it aims at those that end the loop [m]."""
    if policy != "rollout_push":
        return {}
    return {"objective": "clearance", "clearance_width": min_gap + _SEEN_WITHIN}
