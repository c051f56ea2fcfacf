"""No callback may end a node: rclpy re-raises what a callback throws and takes the process down."""

import functools
import traceback
from collections.abc import Callable
from typing import Any, TypeVar

from singulation_core import ResultCode, SingulationError

Callback = TypeVar("Callback", bound=Callable[..., Any])

_LOG_PERIOD = 1.0  # s between two log lines of one guard


def guarded(callback: Callback) -> Callback:
    """Decorates a callback method of a node: what it throws is counted, logged and shown in the diagnostics."""

    @functools.wraps(callback)
    def safe(self: Any, *args: Any, **kwargs: Any) -> Any:
        try:
            return callback(self, *args, **kwargs)
        except Exception as error:
            report_failure(self, callback.__name__, error)
            return None

    return safe  # type: ignore[return-value]  # functools.wraps keeps the signature


def guarded_service(callback: Callback) -> Callback:
    """As ``guarded``, for service callbacks: the response says what went wrong and is always sent.

    ``code`` and ``message`` (or ``success`` and ``message``) of the response are filled.
    """

    @functools.wraps(callback)
    def safe(self: Any, request: Any, response: Any) -> Any:
        try:
            return callback(self, request, response)
        except SingulationError as error:
            return fill_failure(response, error.code, error.message)
        except Exception as error:
            report_failure(self, callback.__name__, error)
            return fill_failure(response, ResultCode.INTERNAL, f"{type(error).__name__}: {error}")

    return safe  # type: ignore[return-value]  # functools.wraps keeps the signature


def fill_failure(response: Any, code: ResultCode, message: str) -> Any:
    """The service response or action result with the failure written into it."""
    if hasattr(response, "code"):
        response.code = int(code)
    if hasattr(response, "success"):
        response.success = False
    response.message = message
    return response


def report_failure(node: Any, name: str, error: Exception) -> None:
    """Log (at most once a second) and show in the diagnostics that a callback failed."""
    diagnostics = getattr(node, "diagnostics", None)
    if diagnostics is not None:
        diagnostics.count_failure(name, f"{type(error).__name__}: {error}")
    text = "".join(traceback.format_exception(error))
    node.get_logger().error(f"{name} failed and was ignored: {text}", throttle_duration_sec=_LOG_PERIOD)
