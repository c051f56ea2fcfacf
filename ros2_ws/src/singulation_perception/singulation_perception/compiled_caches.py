"""Compiled code that is older than the sources it was made of.

Numba keeps compiled functions on disk and compiles anew when a function's own file changes, but not when a function
that it calls has changed in another file. After an update some compiled functions would then still contain old code.
"""

from pathlib import Path


def drop_stale_caches(sources: Path, caches: Path) -> int:
    """Removes compiled functions older than the newest source file that has any.

    Args:
        sources: folder of the package.
        caches: folder in which its compiled functions are kept.

    Returns:
        How many files were removed. What may not be removed stays.
    """
    newest = max(
        (file.stat().st_mtime for file in sources.glob("*.py") if b"@compiled" in file.read_bytes()), default=0.0
    )
    removed = 0
    for file in (*caches.glob("*.nbi"), *caches.glob("*.nbc")):
        try:
            if file.stat().st_mtime < newest:
                file.unlink()
                removed += 1
        except OSError:  # another process was faster, or the folder is read-only
            continue
    return removed
