"""Whether a push still fits the table: it must have been planned on a view taken after the last motion."""

from collections import OrderedDict

from singulation_core import Arrangement, ResultCode, SingulationError

_KEPT = 50  # arrangements; five seconds at 10 Hz
_SAME = 1e-6  # s; two times that differ by the rounding of a float are the same

Stamp = tuple[int, int]
"""Seconds and nanoseconds: two stamps are the same only if both are."""


class PushGate:
    """Remembers the arrangements that were seen, and when the arm last was among the blocks.

    Args:
        max_age: of the arrangement that a push was planned on [s].
        max_skew: how far in the future its stamp may lie [s].
        need_objects: whether a push is refused as long as no arrangement has been seen.
    """

    def __init__(self, max_age: float, max_skew: float, need_objects: bool) -> None:
        self._max_age = max_age
        self._max_skew = max_skew
        self._need_objects = need_objects
        self._seen: OrderedDict[Stamp, Arrangement] = OrderedDict()
        self._moved_at = float("-inf")

    def add(self, stamp: Stamp, arrangement: Arrangement) -> None:
        """Remember an arrangement."""
        self._seen.pop(stamp, None)
        self._seen[stamp] = arrangement
        while len(self._seen) > _KEPT:
            self._seen.popitem(last=False)

    def moved(self, time: float) -> None:
        """The arm has moved until ``time`` [s, ROS clock]: what was seen before may lie elsewhere now."""
        self._moved_at = time

    def require_fresh(self, stamp: Stamp, now: float) -> Arrangement:
        """What to keep clear of for a push with this stamp.

        Args:
            stamp: of the push, that is of the arrangement it was planned on.
            now: ROS time [s].

        Returns:
            The arrangement of that stamp if it has been seen here, else the newest one (empty if none is needed).

        Raises:
            SingulationError: ``STALE_INPUT`` or ``NOT_READY``.
        """
        time = stamp[0] + 1e-9 * stamp[1]
        age = now - time
        if stamp == (0, 0):
            raise _stale("the push has no stamp; it needs that of the arrangement it was planned on")
        if not (age <= self._max_age):
            raise _stale(f"the push was planned on a view {age:.1f} s old, limit {self._max_age} s")
        if not (age >= -self._max_skew):
            raise _stale(f"the push is stamped {-age:.2f} s in the future, limit {self._max_skew} s")
        if not (time >= self._moved_at - _SAME):
            since = self._moved_at - time
            raise _stale(f"the push was planned on a view taken {since:.2f} s before the last motion ended; look again")
        return self._arrangement(stamp)

    def newest(self) -> Arrangement:
        """The arrangement that came last, empty if none has come."""
        return next(reversed(self._seen.values()), Arrangement(()))

    def _arrangement(self, stamp: Stamp) -> Arrangement:
        if stamp in self._seen:
            return self._seen[stamp]
        if self._need_objects and not self._seen:
            raise SingulationError(
                ResultCode.NOT_READY, "no arrangement has come yet: what to keep clear of is unknown"
            )
        return self.newest()


def _stale(text: str) -> SingulationError:
    return SingulationError(ResultCode.STALE_INPUT, text)
