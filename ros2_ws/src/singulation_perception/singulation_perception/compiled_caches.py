"""Compiled code that is older than the sources it was made of.

Numba keeps compiled functions on disk and compiles anew when a function's own file changes, but not when a function
that it calls has changed in another file. After an update some compiled functions would then still contain old code.
"""

from collections.abc import Sequence
from pathlib import Path

_SIGNS = (b"@compiled", b"njit")  # of a file with compiled functions, or one that says how they are compiled


def drop_stale_caches(sources: Sequence[Path], caches: Path) -> int:
    """Removes compiled functions older than the newest source file that has any or says how they are compiled.

    Args:
        sources: folders of the package and of what it is compiled with.
        caches: folder in which its compiled functions are kept.

    Returns:
        How many files were removed. What may not be removed stays.
    """
    files = [file for folder in sources for file in folder.glob("*.py")]
    newest = max((file.stat().st_mtime for file in files if _matters(file.read_bytes())), default=0.0)
    removed = 0
    for file in (*caches.glob("*.nbi"), *caches.glob("*.nbc")):
        try:
            if file.stat().st_mtime < newest:
                file.unlink()
                removed += 1
        except OSError:  # another process was faster, or the folder is read-only
            continue
    return removed


def _matters(text: bytes) -> bool:
    return any(sign in text for sign in _SIGNS)
