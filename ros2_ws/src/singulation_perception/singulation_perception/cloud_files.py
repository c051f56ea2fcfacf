"""Point clouds from files, by their ending: ``.pcd`` and ``.ply``."""

from collections.abc import Callable
from pathlib import Path

from singulation_perception.clouds import RecordedCloud
from singulation_perception.pcd_file import read_pcd
from singulation_perception.ply_file import read_ply
from singulation_perception.point_records import bad_file

CLOUD_READERS: dict[str, Callable[[Path], RecordedCloud]] = {".pcd": read_pcd, ".ply": read_ply}


def read_cloud_file(path: Path) -> RecordedCloud:
    """The cloud of a PCD or PLY file, all fields, image order kept.

    Raises:
        SingulationError: ``BAD_FILE``: missing, not readable, another ending, damaged.
    """
    reader = CLOUD_READERS.get(path.suffix.lower())
    if reader is None:
        raise bad_file(path, f"ending {path.suffix!r}, need one of {sorted(CLOUD_READERS)}")
    try:
        return reader(path)
    except OSError as error:
        raise bad_file(path, f"cannot be read: {error.strerror or error}") from None
