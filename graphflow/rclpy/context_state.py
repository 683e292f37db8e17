"""The life of a context of rclpy's: its arguments, the network once a node needs it, and who waits for its end."""

from __future__ import annotations

import asyncio
import logging
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

from graphflow.domain import domain_id
from graphflow.errors import TransportError
from graphflow.rclpy.loop import LoopThread
from graphflow.rclpy.wake import Wake
from graphflow.runtime.args import RosArgs, parse_ros_args
from graphflow.runtime.context import Context

LOOP = LoopThread()
"""The event loop of this process."""
OPEN_LIMIT = 10.0
CLOSE_LIMIT = 5.0
"""Seconds that the network has to be joined, and to be left."""
ASK_AGAIN = (0.2, 0.5)
"""Seconds until it is tried again to join the network."""
logger = logging.getLogger("graphflow")


def parse_only_ros(words: Sequence[str]) -> RosArgs:
    """What stands after `--ros-args` in a command line: as in ROS 2, the rest is the program's own.

    Raises:
        GraphflowError: An argument is wrong.
    """
    inside: list[str] = []
    is_inside = False
    for word in words:
        if word == "--ros-args":
            is_inside = True
        elif word == "--" and is_inside:
            is_inside = False
        elif is_inside:
            inside.append(word)
    return parse_ros_args(["--ros-args", *inside], refuses_unknown=False)


class ContextState:
    """One context's, from `rclpy.init` to its shutdown.

    Args:
        words: The command line, its first word the program's.
        domain: None for what the environment says.

    Raises:
        GraphflowError: An argument, or the domain, is wrong.
    """

    def __init__(self, words: Sequence[str], domain: int | None) -> None:
        self.args = parse_only_ros(words)
        self.domain = domain_id(domain)
        self.is_ok = True
        """Whether it has not been shut down."""
        self._ends_with_process = False
        self._context: Context | None = None
        self._lock = threading.Lock()
        self._wakes: dict[Wake, None] = {}
        self.nodes: dict[object, Callable[[], None]] = {}
        """What closes each of its nodes, by node."""
        self.on_leaving: list[Callable[[Any], None]] = []
        """Called with each node that leaves, or that the end finds."""

    def network(self) -> Context:
        """The network, joined now if it was not before. Raises TransportError."""
        with self._lock:
            if self._context is None:
                self._context = LOOP.wait(self._open, timeout=OPEN_LIMIT)
                LOOP.at_exit.append(self.end_with_process)
            return self._context

    async def _open(self) -> Context:
        for pause in ASK_AGAIN:
            try:
                return await Context.open(self.domain)
            except TransportError as error:  # where others find each other, somebody may just be leaving
                logger.debug("joining the network: %s", error)
                await asyncio.sleep(pause)
        return await Context.open(self.domain)

    def on_loop(self, fn: Callable[[], object], *, wait: bool = True) -> None:
        """Call `fn()` on the loop, if the network has not been left."""
        if wait and self.is_ok:
            LOOP.call(fn)
        elif self.is_ok:
            LOOP.soon(fn)

    def on_end(self, wake: Wake) -> None:
        """Wake somebody when it ends; at once if it has."""
        self._wakes[wake] = None
        if not self.is_ok:
            wake.set()

    def forget(self, wake: Wake) -> None:
        """Wake it no more."""
        self._wakes.pop(wake, None)

    def leave(self, node: object) -> None:
        """A node is destroyed, or all have ended. Twice is harmless."""
        if self.nodes.pop(node, None) is not None:
            for told in self.on_leaving:
                told(node)

    def end(self) -> bool:
        """Say that it is over, and wake all who wait; whether it was not over before. For signal handlers too."""
        was_ok, self.is_ok = self.is_ok, False
        for wake in list(self._wakes):
            wake.set()
        return was_ok

    def end_with_process(self) -> None:
        """Leave the network because the program has ended; its daemon threads are not told."""
        self._ends_with_process = True
        self.close()

    def end_daemon(self) -> None:
        """End a daemon thread of a program that has ended, without a word. Raises SystemExit in such a one."""
        if self._ends_with_process and threading.current_thread().daemon:
            raise SystemExit  # which threads end by

    def close(self) -> None:
        """Leave the network; where another thread does so already, wait until it has."""
        self.end()
        for node in list(self.nodes):
            self.leave(node)
        with self._lock:
            context, self._context = self._context, None
            if context is None:
                return
            try:
                LOOP.wait(self._leave, context, timeout=CLOSE_LIMIT)
            except TimeoutError:
                pass  # a peer holds it; the process that ends takes the session with it
        with suppress(ValueError):  # at last: the process must not end meanwhile
            LOOP.at_exit.remove(self.end_with_process)

    @staticmethod
    async def _leave(context: Context) -> None:
        for node in list(context.nodes):
            await node.stop()  # type: ignore[attr-defined]
        await context.close()
