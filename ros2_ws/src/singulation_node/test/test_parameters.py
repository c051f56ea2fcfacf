from dataclasses import dataclass

import pytest
import rclpy
from rclpy.parameter import Parameter

from singulation_core import InvalidInputError
from singulation_node.parameters import ParameterSet, parameter


@dataclass(frozen=True)
class Settings:
    rate: float = parameter(10.0, "publishing rate [Hz]", low=0.1, high=100.0)
    count: int = parameter(3, "how many", low=1, high=9)
    policy: str = parameter("a", "which one", choices=("a", "b"))
    corners: tuple[float, ...] = parameter((0.0, 1.0), "corners [m]", low=-5.0, high=5.0)
    name: str = parameter("x", "fixed name", read_only=True)

    def __post_init__(self) -> None:
        if not self.rate >= self.count:
            raise InvalidInputError(f"rate {self.rate} is below count {self.count}")


@pytest.fixture
def node(ros_context):
    made = rclpy.create_node("parameter_test", context=ros_context)
    yield made
    made.destroy_node()


def set_one(node, name, value):
    return node.set_parameters([Parameter(name, value=value)])[0]


def test_defaults_are_declared_with_range_and_text(node):
    settings = ParameterSet(node, Settings).current
    assert settings == Settings()
    descriptor = node.describe_parameter("rate")
    assert descriptor.description == "publishing rate [Hz]"
    assert descriptor.floating_point_range[0].to_value == 100.0


def test_a_good_change_replaces_the_snapshot(node):
    parameters = ParameterSet(node, Settings)
    before = parameters.current
    assert set_one(node, "corners", [1.0, 2.0]).successful
    assert parameters.current.corners == (1.0, 2.0)
    assert before.corners == (0.0, 1.0)


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        ("rate", 1000.0, "range"),
        ("rate", float("nan"), "rate"),
        ("rate", "fast", "type"),
        ("policy", "c", "one of ['a', 'b']"),
        ("corners", [9.0, 0.0], "corners"),
        ("rate", 2.0, "below count"),
        ("name", "y", "read-only"),
    ],
)
def test_a_bad_change_is_rejected_with_its_reason_and_changes_nothing(node, name, value, reason):
    parameters = ParameterSet(node, Settings)
    result = set_one(node, name, value)
    assert not result.successful
    assert reason in result.reason
    assert parameters.current == Settings()
    assert set_one(node, "rate", 20.0).successful
    assert parameters.current.rate == 20.0


@pytest.mark.parametrize(
    ("name", "value"), [("rate", 50), ("count", 1.5), ("policy", "z"), ("rate", 500.0), ("rate", 1.0)]
)
def test_a_bad_start_value_is_refused_with_the_parameters_name(ros_context, name, value):
    node = rclpy.create_node("parameter_test", context=ros_context, parameter_overrides=[Parameter(name, value=value)])
    with pytest.raises(InvalidInputError, match=name):
        ParameterSet(node, Settings)
    node.destroy_node()
