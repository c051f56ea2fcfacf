"""Which stamps of clouds are credible.

Recordings replayed with their own stamps are years old, so age alone is judged only on request. What always holds:
a measurement has a stamp, none is from the future, and each is newer than the one before.
"""

from singulation_core import ResultCode, SingulationError

_SECOND = 1_000_000_000


class StampOrder:
    """Judges the stamps of one stream of clouds, in the order they arrive.

    A stamp that goes back is refused once and begins a new time line: a camera whose clock was set, or a recording
    that starts again, costs one cloud and no restart.
    """

    def __init__(self) -> None:
        self._last: int | None = None

    def check(self, stamp: int, now: int, max_future: float, max_age: float | None) -> None:
        """Accept or refuse the next stamp.

        Args:
            stamp: of the cloud [ns].
            now: in the same clock [ns].
            max_future: how far clocks may disagree [s].
            max_age: oldest acceptable cloud [s]; None: any age.

        Raises:
            SingulationError: ``STALE_INPUT``: zero, from the future, not newer than the last one, too old.
                ``NOT_READY``: there is no time to compare with.
        """
        if not (now > 0):
            raise SingulationError(
                ResultCode.NOT_READY, "the node's clock shows zero: use_sim_time is set, but nothing came on /clock yet"
            )
        if not (stamp > 0):
            raise _stale("the stamp of the cloud is zero; the camera driver must stamp its clouds")
        ahead = (stamp - now) / _SECOND
        if not (ahead <= max_future):
            raise _stale(f"the cloud is stamped {ahead:.3f} s in the future, at most {max_future:.3f} s are accepted")
        last, self._last = self._last, stamp
        if last is not None and not (stamp > last):
            how = "equals that of" if stamp == last else f"is {(last - stamp) / _SECOND:.3f} s before"
            raise _stale(f"the stamp of the cloud {how} the cloud before; the next newer one is accepted")
        if max_age is not None and not (-ahead <= max_age):
            raise _stale(f"the cloud is {-ahead:.3f} s old, at most {max_age:.3f} s are accepted")


def _stale(text: str) -> SingulationError:
    return SingulationError(ResultCode.STALE_INPUT, text)
