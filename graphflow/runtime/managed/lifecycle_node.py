"""Managed nodes: what users subclass, a facade over its `ManagedCore`."""

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
    """A node with ROS 2's life cycle: set up by `configure`, at work from `activate` to `deactivate`.

    Until it is active its handlers do not run: timers rest, messages are left out, requests are answered with an error
    and goals are rejected; what it publishes is not sent. Everything is on the network all the same, so that activating
    it takes no time.

    Override the hooks that you need; `super()` is not needed. A hook succeeds by returning. `raise
    TransitionRefused("no camera")` leads back to where the node was; any other error to `on_error`.

    What a step up enters (`self.enter`), makes (`self.create_...`) and starts (`self.spawn`) is undone by the step
    down, last first, after the hook.

    Source: ROS 2 design, "Managed nodes"; rclpy.lifecycle, for the names.
    """

    _core: ManagedCore
    _core_class = ManagedCore
    is_managed = True

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        declared.check_attributes(cls, LifecycleNode)
        for name in HOOKS:
            _check_hook(cls, name)

    @property
    def lifecycle_state(self) -> LifecycleState:
        """Where in its life the node is."""
        return self._core.state

    async def on_configure(self) -> None:
        """For subclasses: set up what the node needs. What is entered here is left by `cleanup`."""

    async def on_activate(self) -> None:
        """For subclasses: begin. Publishers send already; handlers and tasks start when it has returned."""

    async def on_deactivate(self) -> None:
        """For subclasses: pause. Handlers and tasks have ended; publishers still send."""

    async def on_cleanup(self) -> None:
        """For subclasses: undo what `on_configure` did and did not enter."""

    async def on_shutdown(self) -> None:
        """For subclasses: finish, from any state. Runs once, when the node is shut down or stops."""

    async def on_error(self) -> None:
        """For subclasses: put things right after an error in another hook.

        When it returns the node is unconfigured; an error in it ends the node's life in `finalized`.
        """

    async def trigger_configure(self) -> None:
        """Set the node up: from unconfigured to inactive.

        Raises:
            TransitionFailed: That is not possible from the present state, was refused, or failed.
        """
        await self._core.trigger("configure")

    async def trigger_activate(self) -> None:
        """Start the node's work: from inactive to active. Raises TransitionFailed as `trigger_configure` does."""
        await self._core.trigger("activate")

    async def trigger_deactivate(self) -> None:
        """Pause the node's work: from active to inactive. A handler that calls this is cancelled by it.

        Raises:
            TransitionFailed: As for `trigger_configure`.
        """
        await self._core.trigger("deactivate")

    async def trigger_cleanup(self) -> None:
        """Undo the setup: from inactive to unconfigured. Raises TransitionFailed as `trigger_configure` does."""
        await self._core.trigger("cleanup")

    async def trigger_shutdown(self) -> None:
        """End the node's life; the process goes on. Raises TransitionFailed as `trigger_configure` does."""
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
