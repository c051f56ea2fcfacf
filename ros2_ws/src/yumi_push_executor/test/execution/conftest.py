"""Fixtures of the executor's tests; the robots they talk to are in the modules beside this file."""

import pathlib
import sys

import pytest

from singulation_core import ResultCode, SingulationError
from singulation_node.testing import ros_context

sys.path.insert(0, str(pathlib.Path(__file__).parent))

from rig import Rig

__all__ = ["ros_context"]


@pytest.fixture
def rig():
    return Rig()


@pytest.fixture
def refusal():
    """The code and text with which a motion is refused before anything is ordered."""

    def start(rig, segments=None):
        with pytest.raises(SingulationError) as caught:
            rig.supervisor(segments).start(rig.driver, rig.instant())
        return ResultCode(caught.value.code), caught.value.message

    return start
