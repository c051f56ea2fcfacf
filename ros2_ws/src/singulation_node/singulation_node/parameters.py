"""Parameters of a node as one frozen dataclass: name, type, default, range and text stand in one place.

    @dataclass(frozen=True)
    class Settings:
        rate: float = parameter(10.0, "publishing rate [Hz]", low=0.1, high=100.0)

Rules between parameters go into ``__post_init__`` and raise ``InvalidInputError``.
"""

import dataclasses
from typing import Any, Generic, TypeVar

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, SetParametersResult
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.parameter import Parameter

from singulation_core import InvalidInputError, SingulationError

SettingsType = TypeVar("SettingsType")


@dataclasses.dataclass(frozen=True, slots=True)
class _Spec:
    text: str
    low: float | None
    high: float | None
    choices: tuple[Any, ...] | None
    read_only: bool


def parameter(
    default: Any,
    text: str,
    *,
    low: float | None = None,
    high: float | None = None,
    choices: tuple[Any, ...] | None = None,
    read_only: bool = False,
) -> Any:
    """A dataclass field that is also a ROS parameter.

    Args:
        default: bool, int, float, str, or a tuple of floats or strings.
        text: what it means, with the unit in brackets.
        low: smallest allowed number (for each element of a tuple).
        high: largest allowed number.
        choices: the allowed values, if they can be listed.
        read_only: fixed once the node runs.
    """
    spec = _Spec(text, low, high, choices, read_only)
    return dataclasses.field(default=default, metadata={"parameter": spec})


class ParameterSet(Generic[SettingsType]):
    """Declares the fields of a settings class on a node and keeps a consistent frozen snapshot of their values.

    A change is checked as a whole before it is applied; a bad one is rejected with its reason and changes nothing.

    Raises:
        InvalidInputError: a start value of the wrong type, out of range, or inconsistent with another.
    """

    def __init__(self, node: Any, settings_class: type[SettingsType]) -> None:
        self._class = settings_class
        self._specs: dict[str, _Spec] = {
            item.name: item.metadata["parameter"]
            for item in dataclasses.fields(settings_class)  # type: ignore[arg-type]  # always a dataclass
        }
        values = {}
        for item in dataclasses.fields(settings_class):  # type: ignore[arg-type]
            values[item.name] = _declare(node, item.name, item.default, self._specs[item.name])
        self.current: SettingsType = self._build(values)
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._apply)

    def _build(self, values: dict[str, Any]) -> SettingsType:
        for name, value in values.items():
            _check_value(name, value, self._specs[name])
        return self._class(**values)

    def _changed(self, parameters: list[Any]) -> SettingsType:
        changes = {item.name: _plain(item.value) for item in parameters if item.name in self._specs}
        for name, value in changes.items():
            _check_value(name, value, self._specs[name])
        return dataclasses.replace(self.current, **changes)  # type: ignore[type-var]

    def _check(self, parameters: list[Any]) -> Any:
        try:
            self._changed(parameters)
        except SingulationError as error:
            return SetParametersResult(successful=False, reason=error.message)
        return SetParametersResult(successful=True)

    def _apply(self, parameters: list[Any]) -> None:
        self.current = self._changed(parameters)


def _declare(node: Any, name: str, default: Any, spec: _Spec) -> Any:
    kind = Parameter.Type.from_parameter_value(_wire(default))
    try:
        declared = node.declare_parameter(name, _wire(default), _descriptor(name, kind, spec))
    except (InvalidParameterTypeException, InvalidParameterValueException) as error:
        raise InvalidInputError(
            f"parameter {name} of {node.get_name()}: {error}; need {kind.name.lower()}, such as {default!r}"
        ) from None
    return _plain(declared.value)


def _descriptor(name: str, kind: Any, spec: _Spec) -> Any:
    descriptor = ParameterDescriptor(
        name=name, type=kind.value, description=spec.text, read_only=spec.read_only, dynamic_typing=False
    )
    if spec.choices is not None:
        descriptor.additional_constraints = f"one of {list(spec.choices)}"
    if spec.low is not None and spec.high is not None:
        if kind == Parameter.Type.DOUBLE:
            descriptor.floating_point_range = [
                FloatingPointRange(from_value=float(spec.low), to_value=float(spec.high), step=0.0)
            ]
        elif kind == Parameter.Type.INTEGER:
            descriptor.integer_range = [IntegerRange(from_value=int(spec.low), to_value=int(spec.high), step=1)]
    return descriptor


def _check_value(name: str, value: Any, spec: _Spec) -> None:
    if spec.choices is not None and value not in spec.choices:
        raise InvalidInputError(f"parameter {name} is {value!r}; one of {list(spec.choices)}")
    low = float("-inf") if spec.low is None else spec.low
    high = float("inf") if spec.high is None else spec.high
    for number in value if isinstance(value, tuple) else (value,):
        if isinstance(number, int | float) and not (low <= number <= high):
            raise InvalidInputError(f"parameter {name} is {value}; need {low} <= {name} <= {high}")


def _wire(value: Any) -> Any:
    return list(value) if isinstance(value, tuple) else value


def _plain(value: Any) -> Any:
    """ROS hands arrays out as lists or array.array; settings hold tuples."""
    return value if isinstance(value, bool | int | float | str) else tuple(value)
