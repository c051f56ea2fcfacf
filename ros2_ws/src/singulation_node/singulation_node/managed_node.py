"""Lifecycle node of the suite: transitions that say why they failed, settings, diagnostics."""

from typing import Any, Generic, TypeVar

from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn

from singulation_core import SingulationError
from singulation_node.diagnostics import Diagnostics
from singulation_node.guard import report_failure
from singulation_node.parameters import ParameterSet

SettingsType = TypeVar("SettingsType")


class ManagedNode(LifecycleNode, Generic[SettingsType]):
    """Base of the lifecycle nodes.

    A subclass overrides the hooks ``configure``, ``activate``, ``deactivate``, ``cleanup``. Subscriptions, services,
    clients and timers that ``activate`` creates exist only while the node is active, and publishers and the like that
    ``configure`` creates only while it is configured: rclpy itself would let them go on in the inactive state.
    A hook fails by raising; the reason is logged and shown in the diagnostics.

    Args:
        name: node name.
        settings_class: frozen dataclass of ``singulation_node.parameters.parameter`` fields.
        **options: for rclpy's node: context, namespace, parameter_overrides, ...

    Raises:
        InvalidInputError: a start value of a parameter is not acceptable.
    """

    def __init__(self, name: str, settings_class: type[SettingsType], **options: Any) -> None:
        super().__init__(name, **options)
        self._parameter_set: ParameterSet[SettingsType] = ParameterSet(self, settings_class)
        self._autostart = bool(self.declare_parameter("autostart", False).value)
        self.diagnostics = Diagnostics(self)
        self._configured: list[Any] = []
        self._activated: list[Any] = []
        self.is_active = False
        self.own_process = False  # whether nothing else lives in it, so that its memory may be tuned for the node
        self.diagnostics.report("state", True, "unconfigured")

    @property
    def settings(self) -> SettingsType:
        """The present, consistent parameter values; take it once per unit of work."""
        return self._parameter_set.current

    @property
    def autostart(self) -> bool:
        """Whether the node shall configure and activate itself."""
        return self._autostart

    def configure(self) -> None:
        """Create publishers, load models. May raise."""

    def activate(self) -> None:
        """Create subscriptions, services, timers. May raise."""

    def deactivate(self) -> None:
        """Stop what is going on; what ``activate`` created is destroyed afterwards."""

    def cleanup(self) -> None:
        """Release what ``configure`` took; what it created is destroyed afterwards."""

    def start(self) -> bool:
        """Configure and activate; whether both succeeded."""
        return (
            self.trigger_configure() == TransitionCallbackReturn.SUCCESS
            and self.trigger_activate() == TransitionCallbackReturn.SUCCESS
        )

    def on_configure(self, state: Any) -> Any:
        """Called by the lifecycle."""
        return self._transition("configure", self.configure, self._configured, "inactive")

    def on_activate(self, state: Any) -> Any:
        """Called by the lifecycle."""
        super().on_activate(state)
        result = self._transition("activate", self.activate, self._activated, "active")
        self.is_active = result == TransitionCallbackReturn.SUCCESS
        if not self.is_active:
            super().on_deactivate(state)
        return result

    def on_deactivate(self, state: Any) -> Any:
        """Called by the lifecycle."""
        self.is_active = False
        result = self._transition("deactivate", self.deactivate, [], "inactive")
        self._destroy(self._activated)
        super().on_deactivate(state)
        return result

    def on_cleanup(self, state: Any) -> Any:
        """Called by the lifecycle."""
        result = self._transition("cleanup", self.cleanup, [], "unconfigured")
        self._destroy(self._configured)
        return result

    def on_shutdown(self, state: Any) -> Any:
        """Called by the lifecycle, from any state."""
        if self.is_active:
            self.on_deactivate(state)
        if self._configured:
            self.on_cleanup(state)
        self.diagnostics.report("state", True, "finalized")
        return TransitionCallbackReturn.SUCCESS

    def _transition(self, name: str, hook: Any, created: list[Any], reached: str) -> Any:
        before = self._entities()
        try:
            hook()
        except Exception as error:
            fresh = [item for item in self._entities() if item not in before]
            self._destroy(fresh)
            self._explain(name, error)
            return TransitionCallbackReturn.FAILURE
        created += [item for item in self._entities() if item not in before]
        self.diagnostics.report("state", True, reached)
        return TransitionCallbackReturn.SUCCESS

    def _explain(self, name: str, error: Exception) -> None:
        if isinstance(error, SingulationError):
            self.get_logger().error(f"cannot {name}: {error}")
        else:
            report_failure(self, name, error)
        self.diagnostics.report("state", False, f"cannot {name}: {error}")

    def _entities(self) -> list[Any]:
        kinds = (self.subscriptions, self.timers, self.services, self.clients, self.publishers)
        return [item for kind in kinds for item in kind]

    def _destroy(self, entities: list[Any]) -> None:
        for item in entities:
            for kind, destroy in (
                (self.subscriptions, self.destroy_subscription),
                (self.timers, self.destroy_timer),
                (self.services, self.destroy_service),
                (self.clients, self.destroy_client),
                (self.publishers, self.destroy_publisher),
            ):
                if item in list(kind):
                    destroy(item)
        entities.clear()
