"""For all tests: Ctrl-C works in the processes they start, and which of them may run beside each other."""

import signal
from pathlib import PurePosixPath
from typing import Any

import pytest
from hypothesis import settings
from xdist.scheduler import LoadFileScheduling

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # as in background commands of a shell
    signal.signal(signal.SIGINT, signal.default_int_handler)

settings.register_profile("any speed", deadline=None)  # no test is about time: the machine may be busy
settings.load_profile("any speed")


class OneDemoAtATime(LoadFileScheduling):
    """Tests of a file share its fixtures and so one process; demos refuse to run beside each other."""

    def _split_scope(self, nodeid: str) -> str:
        file = super()._split_scope(nodeid)
        return "demos" if _is_demo(file) else file


def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> LoadFileScheduling:
    return OneDemoAtATime(config, log)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The demos come first: they take longest, and what is short fills the rest of the other process's time."""
    items.sort(key=lambda item: not _is_demo(item.nodeid.split("::")[0]))


def _is_demo(file: str) -> bool:
    return PurePosixPath(file).name.startswith("test_demo")
