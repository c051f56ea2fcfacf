"""Entry point of ``scripts/demo``."""

import os
import signal
import sys
import webbrowser
from collections.abc import Sequence
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any

from singulation_node.large_messages import prepare_for_large_messages  # before ROS: keeps memory

# isort: split
from singulation_bringup.demo.cell_part import CellPart
from singulation_bringup.demo.observer import Observer
from singulation_bringup.demo.options import DemoOptions, parse
from singulation_bringup.demo.processes import NodeProcesses
from singulation_bringup.demo.replay_part import ReplayPart
from singulation_bringup.demo.run_lock import only_demo
from singulation_bringup.demo.summary import Summary
from singulation_bringup.demo.terminal import complain, say
from singulation_bringup.run_page import PAGE, write_page
from singulation_core import ResultCode, SingulationError
from singulation_node.domain import reserved_domain
from singulation_perception.playback import Recording, find_recording

_OWN_BAG = Path("share", "recordings", "sim_cell")
_WRONG_INPUT = (ResultCode.BAD_FILE, ResultCode.INVALID_INPUT, ResultCode.BUSY, ResultCode.UNKNOWN_POLICY)
EXIT_FAILED, EXIT_USAGE, EXIT_INTERRUPTED = 1, 2, 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the demo; the exit code."""
    root = Path(os.environ.get("SINGULATION_ROOT", Path.cwd()))
    for number in (signal.SIGINT, signal.SIGTERM):  # also where a shell starts us with SIGINT ignored
        signal.signal(number, _interrupt)
    try:
        options = parse(sys.argv[1:] if arguments is None else arguments, root)
        with only_demo(root / ".demo.lock"):
            paths = [options.bag] if options.bag else list(options.clouds) or [root / _OWN_BAG]
            # Input is looked at before anything is started or written.
            recording = find_recording(paths, options.topic, 1.0) if options.part != "cell" else None
            _require_screen(options)
            _make_folder(options.out)
            prepare_for_large_messages()
            return _run(options, paths, recording)
    except SingulationError as error:
        complain(str(error))
        return EXIT_USAGE if error.code in _WRONG_INPUT else EXIT_FAILED
    except KeyboardInterrupt:
        complain("interrupted")
        return EXIT_INTERRUPTED


def _run(options: DemoOptions, paths: list[Path], recording: Recording | None) -> int:
    """The two parts; the summary is written however they end."""
    summary = Summary()
    code = 0
    try:
        with summary.timed("total"):
            if recording is not None:
                own = not options.bag and not options.clouds
                _part("replay", options, summary, ReplayPart(options, paths, own, summary), recording)
            if options.part != "replay":
                _part("cell", options, summary, CellPart(options, summary))
    except SingulationError as error:
        summary.fail(error.code, error.message)
        complain(str(error))
        code = EXIT_USAGE if error.code in _WRONG_INPUT else EXIT_FAILED
    except KeyboardInterrupt:
        summary.fail(ResultCode.CANCELLED, "interrupted")
        complain("interrupted; what was done so far is kept")
        code = EXIT_INTERRUPTED
    finally:
        summary.write(options.out)
        write_page(options.out)
    say(f"\n{summary.as_text()}\nresults: {options.out}\npage: {options.out / PAGE}")
    if code == 0 and not options.headless:
        webbrowser.open((options.out / PAGE).as_uri())
    return code


def _part(name: str, options: DemoOptions, summary: Summary, part: Any, *arguments: Any) -> None:
    """One part with its own processes in its own ROS domain."""
    with reserved_domain() as reserved:
        domain = int(os.environ.get("ROS_DOMAIN_ID", reserved))
        processes = NodeProcesses(options.out / "logs" / name, {"ROS_DOMAIN_ID": str(domain)})
        try:
            with Observer(domain, processes.check) as observer:
                part.run(*arguments, processes, observer)
        finally:
            with summary.timed("stop"), _uninterrupted():
                processes.stop()


def _make_folder(folder: Path) -> None:
    """An empty result folder.

    Raises:
        SingulationError: ``INVALID_INPUT``: exists with content, or cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        occupied = any(folder.iterdir())
        probe = folder / ".writable"
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise SingulationError(
            ResultCode.INVALID_INPUT, f"--out {folder}: cannot be written: {error.strerror}; name another folder"
        ) from None
    if occupied:
        raise SingulationError(
            ResultCode.INVALID_INPUT, f"--out {folder}: is not empty, and results are never overwritten; name another"
        )


def _require_screen(options: DemoOptions) -> None:
    if not options.headless and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise SingulationError(
            ResultCode.INVALID_INPUT, "--no-headless needs a screen (DISPLAY is not set); leave it out here"
        )


def _interrupt(number: int, frame: FrameType | None) -> None:
    raise KeyboardInterrupt


@contextmanager
def _uninterrupted() -> Any:
    """A second Ctrl-C does not keep the processes from being stopped."""
    before = {number: signal.signal(number, signal.SIG_IGN) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


if __name__ == "__main__":
    sys.exit(main())
