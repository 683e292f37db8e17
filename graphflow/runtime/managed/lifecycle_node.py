"""The lifecycle node class that users derive from, a facade over its `ManagedCore`."""

from __future__ import annotations

import inspect
from typing import Any

from graphflow.errors import DeclarationError, Place
from graphflow.machines.lifecycle import LifecycleState
from graphflow.runtime.declarations import declared
from graphflow.runtime.managed.managed_core import ManagedCore
from graphflow.runtime.node import Node

HOOKS = ("on_configure", "on_activate", "on_deactivate", "on_cleanup", "on_shutdown", "on_error")


class LifecycleNode(Node):
    """A node with ROS 2's managed states: set up by `configure`, working from `activate` to `deactivate`.

    Handlers run only while the node is active. Otherwise timers pause, messages are dropped, requests are answered
    with an error, goals are rejected, and published messages are discarded. The endpoints are on the network all the
    time, so that activation is immediate.

    Override the hooks that you need; `super()` is not needed. A hook succeeds by returning. `raise
    TransitionRefused("no camera")` restores the previous state; any other error leads to `on_error`.

    Everything that a transition enters (`self.enter`), creates (`self.create_...`) or starts (`self.spawn`) is undone
    by the reverse transition, last first, after its hook.

    Source: ROS 2 design, "Managed nodes"; rclpy.lifecycle, for the names.
    """

    _core: ManagedCore
    _core_class = ManagedCore
    is_managed = True

    def __init_subclass__(cls, **kwargs: object) -> None:
        super().__init_subclass__(**kwargs)
        declared.check_attributes(cls, LifecycleNode)
        for name in HOOKS:
            _check_hook(cls, name)

    def _hint(self, name: str) -> str:
        if name in ("configure", "activate", "deactivate", "cleanup"):
            return f"write await IT.trigger_{name}()"
        return super()._hint(name)

    @property
    def lifecycle_state(self) -> LifecycleState:
        """The node's lifecycle state."""
        return self._core.state

    async def on_configure(self) -> None:
        """Set up the node; for subclasses. Context managers entered here are exited by `cleanup`."""

    async def on_activate(self) -> None:
        """Start working; for subclasses. Publishers already send; handlers and tasks start after it returns."""

    async def on_deactivate(self) -> None:
        """Pause; for subclasses. Handlers and tasks have ended; publishers still send."""

    async def on_cleanup(self) -> None:
        """Undo the parts of `on_configure` that were not entered as context managers; for subclasses."""

    async def on_shutdown(self) -> None:
        """Clean up, from any state; for subclasses. Runs once, when the node is shut down or stops."""

    async def on_error(self) -> None:
        """Recover from an error in another hook; for subclasses.

        If it returns, the node is unconfigured; if it raises, the node is finalized.
        """

    async def trigger_configure(self) -> None:
        """Set up the node: from unconfigured to inactive.

        Raises:
            TransitionFailed: The transition is not possible from the current state, was refused, or failed.
        """
        await self._core.trigger("configure")

    async def trigger_activate(self) -> None:
        """Start work: from inactive to active. Raises TransitionFailed as `trigger_configure` does."""
        await self._core.trigger("activate")

    async def trigger_deactivate(self) -> None:
        """Pause work: from active to inactive. A handler that calls this is cancelled by it.

        Raises:
            TransitionFailed: As for `trigger_configure`.
        """
        await self._core.trigger("deactivate")

    async def trigger_cleanup(self) -> None:
        """Undo the setup: from inactive to unconfigured. Raises TransitionFailed as `trigger_configure` does."""
        await self._core.trigger("cleanup")

    async def trigger_shutdown(self) -> None:
        """Finalize the node; the process keeps running. Raises TransitionFailed as `trigger_configure` does."""
        await self._core.trigger("shutdown")


def _check_hook(cls: type[LifecycleNode], name: str) -> None:
    hook: Any = vars(cls).get(name)
    if not inspect.isfunction(hook):
        return
    place = Place(hook.__code__.co_filename, hook.__code__.co_firstlineno)
    if not inspect.iscoroutinefunction(hook):
        raise DeclarationError(f"{place}: {name} must be an `async def`")
    if hook.__code__.co_argcount != 1:
        raise DeclarationError(f"{place}: {name} takes only self; the node's state is self.lifecycle_state")
