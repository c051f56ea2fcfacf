"""Makes a process fit to send and receive clouds of tens of megabytes.

Two things: a transport profile, which ``prepare_for_large_messages`` chooses before rclpy is initialised, and memory
that is kept instead of fetched anew from the kernel for each of the six copies between two Python processes. Importing
this module keeps it, and only where that happens before the import of ``rclpy``: loading ROS starts threads (LTTng's
listeners), each with a heap of its own, which the threads of the middleware later share; such heaps give back what
is freed, whatever the settings. ``scripts/bench transport`` measures both.
"""

import ctypes
import fcntl
import os
import shutil
import sys
import time
from pathlib import Path
from xml.etree import ElementTree

PROFILE = Path(__file__).with_name("fastdds_large_clouds.xml")
PROFILE_VARIABLE = "FASTRTPS_DEFAULT_PROFILES_FILE"
HEAPS_VARIABLE = "MALLOC_ARENA_MAX"  # of glibc; who sets it wants to manage the memory of the process himself

_SHARED_MEMORY = Path("/dev/shm")
_PROCESSES = 6  # of one cell that handle clouds, or inherit the profile from one that does
_YOUNG = 10.0  # s in which its owner may not have taken the lock yet
_M_TRIM_THRESHOLD, _M_MMAP_MAX, _M_ARENA_MAX = -1, -4, -8  # malloc.h of glibc
_NEVER_TRIM = 2**31 - 1


def prepare_for_large_messages() -> bool:
    """Choose the transport profile, unless the user chose one.

    Returns:
        Whether large messages will arrive reliably; if not, the reason has been printed.
    """
    chosen = os.environ.get(PROFILE_VARIABLE)
    if chosen and chosen != str(PROFILE):
        return True
    # A process that has the profile from its parent needs room for itself, the first one for all that may follow.
    processes = 1 if chosen else _PROCESSES
    needed = processes * segment_size()
    # Not only for their room: who opens a queue that was left behind gets it as small as it was made.
    remove_abandoned()
    free = shared_memory_free()
    if free < needed:
        os.environ.pop(PROFILE_VARIABLE, None)
        print(
            f"warning: {_SHARED_MEMORY} has {free >> 20} MB free, large clouds need {needed >> 20} MB; clouds may get "
            "lost. In a container: docker run --shm-size=1g, or --ipc=host",
            file=sys.stderr,
        )
        return False
    os.environ[PROFILE_VARIABLE] = str(PROFILE)
    return True


def segment_size() -> int:
    """Shared memory that the profile takes for each process [bytes].

    Raises:
        ValueError: the profile does not say.
    """
    found = ElementTree.parse(PROFILE).getroot().find(".//{*}segment_size")
    if found is None or found.text is None:
        raise ValueError(f"{PROFILE}: no segment_size")
    return int(found.text)


def shared_memory_free() -> int:
    """Room for shared-memory segments on this machine [bytes], 0 if there is none at all."""
    return shutil.disk_usage(_SHARED_MEMORY).free if _SHARED_MEMORY.is_dir() else 0


def remove_abandoned() -> int:
    """Remove the shared memory of processes that were killed (as ``fastdds shm clean`` does): segments and queues.

    The owner of either holds a lock on the file beside it as long as it lives.

    Returns:
        How many were removed.
    """
    removed = 0
    for memory in _SHARED_MEMORY.glob("fastrtps_*"):
        if not memory.name.endswith("_el"):
            try:
                removed += _remove_if_abandoned(memory, memory.with_name(f"{memory.name}_el"))
            except OSError:  # in use, not ours, or somebody else was faster
                continue
    return removed


def _remove_if_abandoned(memory: Path, lock: Path) -> bool:
    locked = lock.exists()
    if time.time() - (lock if locked else memory).stat().st_mtime < _YOUNG:
        return False
    if not locked:
        memory.unlink()
        return True
    with lock.open("rb") as file:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        memory.unlink()
        lock.unlink()
    return True


def keep_memory() -> None:
    """Large blocks come from one heap that never shrinks: fresh pages for each would cost more than the copying."""
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is None or HEAPS_VARIABLE in os.environ:  # not glibc, or the user's choice
        return
    mallopt(_M_MMAP_MAX, 0)
    mallopt(_M_TRIM_THRESHOLD, _NEVER_TRIM)
    mallopt(_M_ARENA_MAX, 1)


keep_memory()
