"""What a result folder holds, as far as the page shows it."""

import base64
import json
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from singulation_core import ResultCode, SingulationError

_KINDS = {".png": "image/png", ".gif": "image/gif"}
_LISTS = ("frames", "pushes", "singulation_distance", "smallest_gap", "files")


@dataclass(frozen=True, slots=True)
class RunFolder:
    """A result folder.

    Args:
        path: of the folder.
        summary: content of its ``summary.json``.
        written: when that was written.
    """

    path: Path
    summary: dict[str, Any]
    written: datetime

    @classmethod
    def read(cls, path: Path) -> "RunFolder":
        """Read a folder.

        Raises:
            SingulationError: ``BAD_FILE`` if there is no summary, or it is none of ours.
        """
        source = path / "summary.json"
        try:
            summary = json.loads(source.read_text(encoding="utf-8"))
            written = datetime.fromtimestamp(source.stat().st_mtime).astimezone()
        except (OSError, ValueError) as error:
            raise SingulationError(
                ResultCode.BAD_FILE, f"{source}: {error}; need a result folder of the demo"
            ) from None
        missing = [name for name in _LISTS if not isinstance(summary, dict) or not isinstance(summary.get(name), list)]
        if missing or not isinstance(summary.get("seconds"), dict):
            raise SingulationError(
                ResultCode.BAD_FILE, f"{source}: lacks {', '.join(missing) or 'seconds'}; not a summary of the demo"
            )
        return cls(path, summary, written)

    def picture(self, name: str) -> str | None:
        """A picture of the folder as a data URI; None if there is none of this name."""
        file = self.path / name
        if not file.is_file():
            return None
        return f"data:{_KINDS[file.suffix]};base64,{base64.b64encode(file.read_bytes()).decode('ascii')}"
