import pytest
from ros2_ws.src.singulation_perception.test.node_bench import Bench

from singulation_node.testing import ros_context, spinning

__all__ = ["ros_context"]


@pytest.fixture
def bench(ros_context):
    made = Bench(ros_context)
    with spinning(made.node, made.camera):
        made.start()
        yield made
