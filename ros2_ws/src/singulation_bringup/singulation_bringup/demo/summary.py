"""What a demo found: ``summary.json`` for programs, ``summary.txt`` for people."""

import json
import math
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from singulation_core import Arrangement, Push, ResultCode


@dataclass(slots=True)
class Summary:
    """Filled while the demo runs, written whatever happens.

    ``singulation_distance`` and ``smallest_gap`` [m] have one value before the first push and one after each;
    ``min_gap`` [m] is the gap that counts as separated; ``stages`` says how often the loop looked, planned and pushed,
    and how long that took in all [s].
    """

    code: ResultCode = ResultCode.OK
    message: str = ""
    loop_code: ResultCode | None = None
    loop_message: str = ""
    frames: list[dict[str, Any]] = field(default_factory=list)
    pushes: list[dict[str, Any]] = field(default_factory=list)
    singulation_distance: list[float] = field(default_factory=list)
    smallest_gap: list[float] = field(default_factory=list)
    min_gap: float | None = None
    stages: dict[str, dict[str, float]] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)
    files: list[str] = field(default_factory=list)

    @contextmanager
    def timed(self, stage: str) -> Iterator[None]:
        """Add the wall time of the block to a stage."""
        started = time.monotonic()
        try:
            yield
        finally:
            self.seconds[stage] = self.seconds.get(stage, 0.0) + time.monotonic() - started

    def fail(self, code: ResultCode, message: str) -> None:
        """Note the first failure; later ones follow from it."""
        if self.code is ResultCode.OK:
            self.code, self.message = code, message

    def write(self, folder: Path) -> None:
        """``summary.json`` and ``summary.txt`` into the result folder."""
        (folder / "summary.json").write_text(json.dumps(self.as_json(), indent=2, allow_nan=False) + "\n")
        (folder / "summary.txt").write_text(self.as_text())

    def as_json(self) -> dict[str, Any]:
        """Plain values; a number that JSON does not know (no pair of objects, no prediction) becomes null."""
        content = {
            "code": int(self.code),
            "code_name": self.code.name,
            "message": self.message,
            "loop": None
            if self.loop_code is None
            else {"code": int(self.loop_code), "code_name": self.loop_code.name, "message": self.loop_message},
            "frames": self.frames,
            "pushes": self.pushes,
            "singulation_distance": self.singulation_distance,
            "smallest_gap": self.smallest_gap,
            "min_gap": self.min_gap,
            "stages": self.stages,
            "seconds": {stage: round(value, 3) for stage, value in self.seconds.items()},
            "files": self.files,
        }
        return dict(_finite(content))

    def as_text(self) -> str:
        """A page for people."""
        lines = [f"result: {self.code.name} ({int(self.code)}) {self.message}".rstrip()]
        if self.frames:
            lines += ["", f"{len(self.frames)} recorded clouds"]
            lines += [f"  {_frame_line(frame)}" for frame in self.frames]
        if self.singulation_distance:
            lines += ["", "closed loop in the simulated cell", _row("", "s(A)", "smallest gap", "push")]
            names = ["before", *(f"push {number}" for number in range(1, len(self.pushes) + 1))]
            pushes = ["", *(f"{push['policy']}, {push['contact_mode']}: {push['code_name']}" for push in self.pushes)]
            for name, distance, gap, push in zip(
                names, self.singulation_distance, self.smallest_gap, pushes, strict=True
            ):
                lines.append(_row(name, f"{distance:.3f}", f"{1e3 * gap:.1f} mm", push))
        if self.loop_code is not None:
            lines.append(f"  {self.loop_code.name}: {self.loop_message}")
        lines += [_stage_line(name, **stage) for name, stage in self.stages.items()]
        lines += ["", "seconds: " + ", ".join(f"{stage} {value:.1f}" for stage, value in self.seconds.items())]
        return "\n".join(lines) + "\n"


def object_entry(arrangement: Arrangement) -> list[dict[str, Any]]:
    """Objects of an arrangement as plain values [m]."""
    return [
        {
            "id": item.id,
            "outline": item.outline.tolist(),
            "centroid": item.centroid.tolist(),
            "height": item.height,
            "confidence": item.confidence,
        }
        for item in arrangement.objects
    ]


def push_entry(push: Push) -> dict[str, Any]:
    """A push as plain values [m]."""
    return {
        "policy": push.policy,
        "contact_mode": push.contact_mode.label,
        "start": push.start.tolist(),
        "end": push.end.tolist(),
        "contact_width": push.contact_width,
        "target_id": push.target_id,
    }


def _frame_line(frame: dict[str, Any]) -> str:
    push = frame["push"]
    plan = f"push object {push['target_id']} ({push['policy']})" if push else frame["message"]
    return f"{frame['source']}: {len(frame['objects'])} objects, {plan}"


def _stage_line(name: str, count: float, seconds: float) -> str:
    return f"  {name:<8} {count:.0f} times, {seconds / max(count, 1.0):.2f} s each"


def _row(name: str, distance: str, gap: str, push: str) -> str:
    return f"  {name:<8} {distance:>8} {gap:>14}  {push}".rstrip()


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(part) for part in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
