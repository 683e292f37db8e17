"""rclpy under its own name, on a network in memory: what is real about it is tested in test_programs.py."""

from __future__ import annotations

import asyncio
import sys
import threading
import time
from collections.abc import Callable, Iterator
from types import ModuleType
from typing import Any

import pytest

from graphflow.rclpy import enabling
from graphflow.rclpy.context_state import ContextState
from graphflow.rclpy.messages.finder import MessagePackages
from graphflow.runtime.context import Context
from graphflow.system import SITE
from graphflow.transport.memory import MemorySession, Network

enabling.here()

import rclpy  # noqa: E402 - it can be imported from here on
import rclpy.node  # noqa: E402
from rclpy.executors import SingleThreadedExecutor  # noqa: E402
from rclpy.impl.rcutils_logger import RcutilsLogger  # noqa: E402
from rclpy.node import Node  # noqa: E402
from rclpy.signals import uninstall_signal_handlers  # noqa: E402


def hide() -> None:
    """Let nothing be imported under ROS's names: tests elsewhere, in the same process, are to know nothing of it."""
    if SITE in sys.path:
        sys.path.remove(SITE)
    sys.meta_path[:] = [finder for finder in sys.meta_path if not isinstance(finder, MessagePackages)]
    for name, module in list(sys.modules.items()):
        if "__graphflow__" in getattr(module, "__dict__", {}) or str(getattr(module, "__file__", "")).startswith(SITE):
            hidden[name] = sys.modules.pop(name)


def show() -> None:
    """Undo `hide`."""
    enabling.here()
    sys.modules.update(hidden)
    hidden.clear()


hidden: dict[str, ModuleType] = {}


def pytest_collection_finish() -> None:
    """The modules of these tests have been imported."""
    hide()


class AnyThread:
    """An event loop that may be called from other threads, as those of a real network are."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self.call_soon = loop.call_soon_threadsafe
        self.is_closed = loop.is_closed

    def __getattr__(self, name: str) -> Any:
        return getattr(self._loop, name)


@pytest.fixture(autouse=True)
def network(monkeypatch: pytest.MonkeyPatch) -> Iterator[Network]:
    """The network that contexts join."""
    show()
    joined = Network()

    async def open_context(self: ContextState) -> Context:
        loop: Any = AnyThread(asyncio.get_running_loop())
        return Context(MemorySession(joined, loop), domain=self.domain)

    monkeypatch.setattr(ContextState, "_open", open_context)
    monkeypatch.setattr("sys.argv", ["program"])
    yield joined
    for thread in threading.enumerate():
        if isinstance(thread, threading.Timer):
            thread.join(5)
    rclpy.try_shutdown()
    uninstall_signal_handlers()
    RcutilsLogger("").set_level(0)
    RcutilsLogger._has_root_level = False
    hide()


@pytest.fixture
def node(network: Network) -> Node:
    """A node called /node."""
    rclpy.init()
    return Node("node")


class Spinner:
    """Spins nodes until something has come about."""

    def __init__(self) -> None:
        self.executor = SingleThreadedExecutor()

    def __call__(self, condition: Callable[[], object], limit: float = 5.0) -> None:
        """Spin until `condition()` holds."""
        until = time.monotonic() + limit
        while not condition():
            assert time.monotonic() < until, "it did not come about in time"
            self.executor.spin_once(timeout_sec=0.05)


@pytest.fixture
def spin(node: Node) -> Iterator[Spinner]:
    """Spins `node`."""
    spinner = Spinner()
    spinner.executor.add_node(node)
    yield spinner
    spinner.executor.shutdown()
