"""Parameter values as text of a YAML file."""

from decimal import Decimal
from typing import Any


def yaml_value(value: Any) -> str:
    """A value as YAML that rcl reads with the same type; floats keep a dot and have no exponent."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        plain = format(Decimal(repr(float(value))), "f")
        return plain if "." in plain else f"{plain}.0"
    if isinstance(value, tuple | list):
        return f"[{', '.join(yaml_value(item) for item in value)}]"
    return f'"{value}"' if isinstance(value, str) else str(value)
