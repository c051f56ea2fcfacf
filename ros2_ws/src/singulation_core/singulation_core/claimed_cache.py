"""Compiled functions on disk that several processes fill together.

Numba's own cache bears processes that write at the same time, but each of them compiles everything it lacks. Here the
first one claims the function, and the others load what it made. So two nodes that start at once compile only once, and
helper processes can compile ahead of a node.
"""

import fcntl
import time
import zlib
from pathlib import Path
from typing import Any

from numba.core.caching import FunctionCache

_PATIENCE = 60.0  # s; who has waited so long for another process compiles the function as well
_POLL = 0.02  # s


class ClaimedCache(FunctionCache):  # type: ignore[misc]  # Numba has no types
    """Numba's cache of one function; see the module."""

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The function compiled for a signature, None if it has to be compiled here."""
        found = super().load_overload(sig, target_context)
        if found is not None or not self._claim(sig):
            return found
        found = super().load_overload(sig, target_context)  # somebody may have been faster
        if found is not None:
            self._release(sig)
        return found

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep what was compiled, for everybody."""
        try:
            super().save_overload(sig, data)
        finally:
            self._release(sig)

    def _claim(self, sig: Any) -> bool:
        """Whether no other process works on the function by now; False, too, where nothing can be locked."""
        try:
            self._impl.locator.ensure_cache_path()
            claims = _claims_of(Path(self.cache_path))
            deadline = time.monotonic() + _PATIENCE
            while not _locked(claims, self._place(sig)):
                if time.monotonic() > deadline:
                    return False
                time.sleep(_POLL)
        except OSError:  # a read-only folder, or a file system without locks
            return False
        return True

    def _release(self, sig: Any) -> None:
        claims = _FILES.get(Path(self.cache_path))
        if claims is not None:
            fcntl.lockf(claims, fcntl.LOCK_UN, 1, self._place(sig))

    def _place(self, sig: Any) -> int:
        return zlib.crc32(f"{self._impl.filename_base} {sig}".encode())


# One file of claims in each folder, one byte of it for each function. The system drops the claims of a process that
# ends, and all claims on a file with the first descriptor that is closed: so each file is opened once and for good.
_FILES: dict[Path, Any] = {}


def _claims_of(folder: Path) -> Any:
    if folder not in _FILES:
        _FILES[folder] = (folder / "claims.lock").open("ab")
    return _FILES[folder]


def _locked(claims: Any, place: int) -> bool:
    try:
        fcntl.lockf(claims, fcntl.LOCK_EX | fcntl.LOCK_NB, 1, place)
    except BlockingIOError:
        return False
    return True
