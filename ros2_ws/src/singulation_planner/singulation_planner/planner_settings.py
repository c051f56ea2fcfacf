"""Parameters of ``planner_node``."""

from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

from singulation_core import CellGeometry, ContactMode, InvalidInputError, PusherGeometry
from singulation_core.polygon import FloatArray, validated_outline
from singulation_core.push_world.physics import PushPhysics
from singulation_node.parameters import parameter
from singulation_planner.placement import Placement
from singulation_planner.plan import PUSH_DISTANCE_FACTOR
from singulation_planner.policies import POLICIES, find_policy
from singulation_planner.rollout.options import Options
from singulation_planner.scene import OVERLAP_TOLERANCE

_CELL, _JAWS, _PLACEMENT, _ROLLOUT = CellGeometry(), PusherGeometry(), Placement(), Options()


@dataclass(frozen=True)
class PlannerSettings:
    """Parameters of ``planner_node``; lengths in metres."""

    policy: str = parameter("cluster_push", "how pushes are chosen", choices=tuple(sorted(POLICIES)))
    policy_options: str = parameter("", "further options of that policy: name=value, separated by spaces")
    objective: str = parameter(
        _ROLLOUT.objective, "rollout_push: what a push is to increase", choices=("singulation_distance", "clearance")
    )
    clearance_width: float = parameter(
        _ROLLOUT.clearance_width,
        "rollout_push: gap that is wide enough [m]; 0: 0.4 mean bounding radii",
        low=0.0,
        high=1.0,
    )
    budget: float = parameter(
        _ROLLOUT.budget,
        "rollout_push: processor time for planning [ms]; 0: no simulation",
        low=0.0,
        high=600000.0,
    )
    rollouts: int = parameter(_ROLLOUT.rollouts, "rollout_push: simulated pushes at most", low=1, high=10**9)
    worlds: int = parameter(
        _ROLLOUT.worlds, "rollout_push: sampled worlds in which the best pushes are judged", low=1, high=1000
    )
    look_ahead: int = parameter(
        _ROLLOUT.look_ahead, "rollout_push: pushes ahead that the best ones are judged by; 1: greedy", low=1, high=3
    )
    contact_mode: str = parameter(
        ContactMode.SINGLE_POINT.label,
        "how the jaws touch, for pushes planned on arrival; a request says it itself",
        choices=tuple(mode.label for mode in ContactMode),
    )
    best_contact_mode: bool = parameter(
        False, "simulate the push of each contact mode and take the best, whatever mode is asked for"
    )
    push_distance_factor: float = parameter(
        PUSH_DISTANCE_FACTOR, "travel after contact [mean bounding radii of the scene]", low=0.1, high=20.0
    )
    plan_on_arrival: bool = parameter(True, "plan on every new arrangement; else on plan_push only")
    seed: int = parameter(0, "seed of policies that draw at random", low=0, high=2**31 - 1)
    tip_radius: float = parameter(_JAWS.tip_radius, "radius of a jaw tip [m]", low=0.0005, high=0.1)
    edge_width: float = parameter(_JAWS.edge_width, "width of the jaws' side [m]", low=0.0005, high=0.2)
    edge_thickness: float = parameter(_JAWS.edge_thickness, "thickness of the jaws behind it [m]", low=0.0005, high=0.2)
    widest_jaw: float = parameter(_PLACEMENT.widest_jaw, "largest distance of two points [m]", low=0.001, high=0.5)
    clearance: float = parameter(
        _JAWS.tip_radius / 6.0, "gap between pusher and every object at the start [m]", low=0.0001, high=0.05
    )
    workspace: tuple[float, ...] = parameter(
        _CELL.workspace,
        "in the frame of the table [m]: x_min, x_max, y_min, y_max; or the corners of a convex polygon, "
        "x and y in turn, counter-clockwise",
    )
    physics: str = parameter(
        "quasi_static", "physics of policies that simulate", choices=("quasi_static", "fine", "fast")
    )
    leave_separated: bool = parameter(False, "push nothing where all gaps are at least min_gap")
    min_gap: float = parameter(0.01, "gap between outlines that counts as separated [m]", low=0.0, high=1.0)
    overlap_tolerance: float = parameter(
        OVERLAP_TOLERANCE, "deepest overlap of outlines taken for noise [smaller bounding radii]", low=0.0, high=1.0
    )
    frame: str = parameter("table", "frame that arrangements must be in")
    max_age: float = parameter(5.0, "oldest acceptable arrangement [s]", low=0.01, high=3600.0)
    max_future: float = parameter(0.1, "how far a stamp may lie in the future [s]", low=0.0, high=10.0)

    def __post_init__(self) -> None:
        self.options(self.policy)
        self.workspace_polygon()

    def options(self, policy: str, asked: str = "") -> dict[str, Any]:
        """Options of a policy as keyword arguments.

        Args:
            policy: its name.
            asked: name=value, separated by spaces; they go before the parameters.

        Raises:
            InvalidInputError: not name=value, or not an option of the policy.
            SingulationError: ``UNKNOWN_POLICY``.
        """
        chosen = find_policy(policy)
        given: dict[str, Any] = {one.name: getattr(self, one.name) for one in fields(_ROLLOUT)}
        given = given if isinstance(chosen.defaults, Options) else {}
        if policy == self.policy:
            given |= _pairs("parameter policy_options", self.policy_options)
        given |= _pairs("policy_options", asked)
        chosen.read_options(given)
        return given

    def workspace_polygon(self) -> FloatArray:
        """(k, 2) corners [m].

        Raises:
            InvalidInputError: neither four limits in order nor a convex polygon.
        """
        numbers = self.workspace
        if len(numbers) == 4:
            x_min, x_max, y_min, y_max = numbers
            numbers = (x_min, y_min, x_max, y_min, x_max, y_max, x_min, y_max)
            if not (x_min < x_max and y_min < y_max):
                raise InvalidInputError(f"parameter workspace {self.workspace}: need x_min < x_max, y_min < y_max")
        if len(numbers) % 2:
            raise InvalidInputError(f"parameter workspace has {len(numbers)} numbers, need 4 limits or x, y pairs")
        corners = [numbers[k : k + 2] for k in range(0, len(numbers), 2)]
        return validated_outline(corners, "parameter workspace")

    @cached_property
    def arguments(self) -> dict[str, Any]:
        """Keyword arguments of ``plan_push``, without policy, its options and the contact mode."""
        return {
            "best_contact_mode": self.best_contact_mode,
            "push_distance_factor": self.push_distance_factor,
            "pusher": PusherGeometry(self.tip_radius, self.edge_width, self.edge_thickness),
            "workspace": self.workspace_polygon(),
            "seed": self.seed,
            "placement": Placement(clearance=self.clearance, widest_jaw=self.widest_jaw),
            "min_gap": self.min_gap if self.leave_separated else None,
            "overlap_tolerance": self.overlap_tolerance,
            "physics": PushPhysics.named(self.physics),
        }


def _pairs(name: str, text: str) -> dict[str, str]:
    pairs = [item.partition("=") for item in text.split()]
    for key, sign, value in pairs:
        if not (key and sign and value):
            raise InvalidInputError(f"{name}: {key + sign + value!r}, need name=value")
    return {key: value for key, _, value in pairs}
