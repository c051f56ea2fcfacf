"""When each recorded cloud is due: keeps the rhythm of the recording, faster or slower, over repetitions."""

import dataclasses
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from singulation_core import ResultCode, SingulationError
from singulation_perception.bag_reading import cloud_topic, is_bag, read_bag_clouds
from singulation_perception.cloud_files import read_cloud_file
from singulation_perception.clouds import RecordedCloud
from singulation_perception.point_records import bad_file

_SECOND = 1_000_000_000


@dataclass(frozen=True, slots=True)
class Recording:
    """Clouds that can be read as often as wanted, one at a time.

    Args:
        open: begins at the first cloud.
        count: number of clouds.
        name: for texts.
    """

    open: Callable[[], Iterator[RecordedCloud]]
    count: int
    name: str


def find_recording(paths: list[Path], topic: str, period: float) -> Recording:
    """One bag, or any number of PCD and PLY files played ``period`` [s] apart.

    Raises:
        SingulationError: ``BAD_FILE`` for what is missing or of another kind; ``INVALID_INPUT`` for a mixture.
    """
    for path in paths:
        if not path.exists():
            raise bad_file(path, "no such file or folder")
    if len(paths) == 1 and is_bag(paths[0]):
        chosen = cloud_topic(paths[0], topic)
        return Recording(lambda: read_bag_clouds(paths[0], chosen.name), chosen.count, f"{paths[0]} {chosen.name}")
    bags = [str(path) for path in paths if is_bag(path)]
    if bags:
        raise SingulationError(
            ResultCode.INVALID_INPUT, f"either one bag or cloud files; got the bags {bags} among them"
        )
    return Recording(lambda: _from_files(paths, period), len(paths), f"{len(paths)} files")


def _from_files(paths: list[Path], period: float) -> Iterator[RecordedCloud]:
    begin = time.time_ns()  # files carry no time, and a clock has to show something
    for number, path in enumerate(paths):
        cloud = read_cloud_file(path)
        yield dataclasses.replace(cloud, recorded=begin + round(number * period * _SECOND))


class Rhythm:
    """Maps times of a recording to times of a monotonic clock.

    Args:
        rate: 2.0 plays twice as fast.
        stepping: whether somebody else decides when the next cloud is due; time then stands still between clouds.
    """

    def __init__(self, rate: float, stepping: bool = False) -> None:
        self._rate = rate
        self._stepping = stepping
        self._anchor: tuple[float, int] | None = None  # (monotonic [s], recorded [ns]) of the first cloud

    def restart(self) -> None:
        """The next cloud is due at once and sets the time."""
        self._anchor = None

    def due(self, recorded: int, now: float) -> float:
        """Monotonic time at which the cloud recorded at ``recorded`` [ns] is to be sent [s]."""
        if self._anchor is None:
            self._anchor = (now, recorded)
        start, first = self._anchor
        return start + (recorded - first) / _SECOND / self._rate

    def recorded_at(self, now: float) -> int | None:
        """Where in the recording we are at ``now`` [ns], None before the first cloud."""
        if self._anchor is None:
            return None
        start, first = self._anchor
        if self._stepping:
            return first
        return first + round((now - start) * self._rate * _SECOND)
