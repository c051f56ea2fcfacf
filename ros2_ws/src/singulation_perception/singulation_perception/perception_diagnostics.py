"""What perception_node says on /diagnostics and once in the log."""

import math
from typing import Any

from singulation_perception import Segmentation
from singulation_perception.frame_ledger import LedgerState
from singulation_perception.perception_settings import PerceptionSettings


def report_clouds(diagnostics: Any, state: LedgerState, settings: PerceptionSettings, publishers: int) -> None:
    """Two components: ``input`` (does the camera deliver) and ``clouds`` (what became of them)."""
    _report_input(diagnostics, state, settings, publishers)
    diagnostics.report(
        "clouds",
        state.healthy,
        "ok" if state.healthy else f"the last cloud was rejected: {state.last_error}",
        received=state.received,
        published=state.published,
        superseded=state.superseded,
        pending=state.pending,
        **{f"rejected {name}": count for name, count in sorted(state.rejected.items())},
        **{f"{name} [ms]": value for name, value in state.stages.items()},
        **{"age [s]": state.age},
    )


def _report_input(diagnostics: Any, state: LedgerState, settings: PerceptionSettings, publishers: int) -> None:
    values = {"publishers": publishers, "rate [Hz]": state.rate, "last cloud [s ago]": state.quiet, "lost": state.lost}
    if publishers == 0:
        diagnostics.warn("input", "nobody publishes clouds on points", **values)
    elif state.since_loss <= settings.quiet_after:
        diagnostics.warn(
            "input",
            "clouds are lost on their way to this node; does the camera's process use fastdds_large_clouds.xml?",
            **values,
        )
    elif publishers > 1:
        diagnostics.warn("input", f"{publishers} publishers on points: their clouds are mixed", **values)
    elif not (state.quiet <= settings.quiet_after):
        diagnostics.warn("input", f"no cloud for more than {settings.quiet_after} s", **values)
    else:
        diagnostics.report("input", True, "ok", **values)


def report_table(diagnostics: Any, result: Segmentation) -> None:
    """Component ``table``: how far the camera is from its calibration, and what the last cloud did not show clearly."""
    diagnostics.report(
        "table",
        True,
        "ok",
        **{
            "offset [mm]": 1e3 * result.table.offset,
            "tilt [deg]": math.degrees(result.table.tilt),
            "noise [mm]": 1e3 * result.table.noise,
            "objects": len(result.arrangement),
        },
        **{f"dropped {reason}": count for reason, count in result.dropped.items()},
    )


def first_words(message: Any, result: Segmentation, table_frame: str) -> str:
    """What an operator wants to see of the first cloud: sizes, frames, where the camera is, one object."""
    x, y, z = result.table.table_from_camera[:3, 3]
    objects = result.arrangement.objects
    sample = "".join(f"; object {one.id} at ({one.centroid[0]:.3f}, {one.centroid[1]:.3f}) m" for one in objects[:1])
    return (
        f"first cloud: {message.width} x {message.height} points in frame {message.header.frame_id!r}; the camera is "
        f"at ({x:.3f}, {y:.3f}, {z:.3f}) m in {table_frame!r}, {1e3 * result.table.offset:.1f} mm and "
        f"{math.degrees(result.table.tilt):.2f} degrees from its expected pose; {len(objects)} objects{sample}"
    )
