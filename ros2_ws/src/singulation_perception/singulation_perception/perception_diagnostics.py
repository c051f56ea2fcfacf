"""What perception_node says on /diagnostics."""

from typing import Any

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
