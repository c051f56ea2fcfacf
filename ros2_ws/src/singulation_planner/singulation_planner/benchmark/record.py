"""One result: what a policy's push did to a scene."""

from dataclasses import asdict, dataclass, fields
from typing import Any

BEST_MODE = "best"  # in place of a contact mode: the planner tries all three and takes the best
FITS = ("contact_mode", "every_mode")  # which jaws must fit at the start, see ``Placement.fits``


@dataclass(frozen=True, slots=True)
class Job:
    """What to do with a scene.

    Args:
        policy: name.
        contact_mode: label of a contact mode, or ``BEST_MODE``.
        fits: whether only the jaws used must be free at the start, or those of every mode, for equal pushes.
    """

    policy: str
    contact_mode: str = "single_point"
    fits: str = "contact_mode"


@dataclass(frozen=True, slots=True)
class Record:
    """A line of the results.

    Args:
        scenario: key of the scene.
        n, group, seed: of the scene.
        policy, contact_mode, fits: as in ``Job``.
        code: name of the result code; anything but OK means that no push was done, and then s' = s.
        unit: length that counts as 1 in s [m].
        before: s of the scene.
        after: s' after the push.
        judged: the same by the judge of the setting, or ``after`` if it has none.
        planning: processor time of planning [s].
        simulating: processor time of simulating the push [s].
        text: of the error, if there was one.
    """

    scenario: str
    n: int
    group: int
    seed: int
    policy: str
    contact_mode: str
    fits: str
    code: str
    unit: float
    before: float
    after: float
    judged: float
    planning: float
    simulating: float
    text: str = ""

    @property
    def key(self) -> tuple[str, str, str, str]:
        """What makes it unique."""
        return self.scenario, self.policy, self.contact_mode, self.fits

    def as_row(self) -> dict[str, Any]:
        """Column name to value."""
        return asdict(self)


COLUMNS = tuple(one.name for one in fields(Record))
