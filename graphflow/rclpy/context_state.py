"""The life of an rclpy context: its arguments, its connection to the network, and the threads that wait for its end."""

from __future__ import annotations

import asyncio
import logging
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress

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
"""Seconds that joining, or leaving, the network may take."""
ASK_AGAIN = (0.2, 0.5)
"""Seconds between two attempts to join the network."""
logger = logging.getLogger("graphflow")


def parse_only_ros(words: Sequence[str]) -> RosArgs:
    """Return the ROS arguments, those after `--ros-args`; as in ROS 2, the program reads the rest itself.

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
    """The state of one context, from `rclpy.init` to its shutdown.

    Args:
        words: The command line, including the program's name.
        domain: None to use the environment's.

    Raises:
        GraphflowError: An argument, or the domain, is wrong.
    """

    def __init__(self, words: Sequence[str], domain: int | None) -> None:
        self.args = parse_only_ros(words)
        self.domain = domain_id(domain)
        self.is_ok = True
        """Whether the context has not been shut down."""
        self.was_interrupted = False
        """Whether a signal has shut it down, such as that of Ctrl-C."""
        self._ends_with_process = False
        self._context: Context | None = None
        self._lock = threading.Lock()
        self._wakes: dict[Wake, None] = {}
        self.nodes: dict[object, Callable[[], None]] = {}
        """The function that closes each of the context's nodes."""
        self.on_leaving: list[Callable[..., None]] = []
        """Called with each node that leaves, or that is still open at the end."""

    def network(self) -> Context:
        """The network, joined on first use. Raises TransportError."""
        with self._lock:
            if self._context is None:
                self._context = LOOP.wait(self._open, timeout=OPEN_LIMIT)
                LOOP.at_exit.append(self.end_with_process)
            return self._context

    async def _open(self) -> Context:
        for pause in ASK_AGAIN:
            try:
                return await Context.open(self.domain)
            except TransportError as error:  # the process that hosts the rendezvous may just be leaving
                logger.debug("joining the network: %s", error)
                await asyncio.sleep(pause)
        return await Context.open(self.domain)

    def on_loop(self, fn: Callable[[], object], *, wait: bool = True) -> None:
        """Call `fn()` on the loop, unless the context has left the network."""
        if wait and self.is_ok:
            LOOP.call(fn)
        elif self.is_ok:
            LOOP.soon(fn)

    def on_end(self, wake: Wake) -> None:
        """Register `wake` to be set at the end; set it at once if the context has ended."""
        self._wakes[wake] = None
        if not self.is_ok:
            wake.set()

    def forget(self, wake: Wake) -> None:
        """Unregister `wake`."""
        self._wakes.pop(wake, None)

    def leave(self, node: object) -> None:
        """Note that a node was destroyed, or that the context has ended. Idempotent."""
        if self.nodes.pop(node, None) is not None:
            for notify in self.on_leaving:
                notify(node)

    def interrupt(self) -> bool:
        """End the context because of a signal; return whether it was still running. Signal-safe."""
        self.was_interrupted |= self.is_ok
        return self.end()

    def end(self) -> bool:
        """Mark the context as ended and wake all waiting threads; return whether it was still running. Signal-safe."""
        # No lock: a signal handler may have interrupted the thread that holds it.
        was_ok, self.is_ok = self.is_ok, False
        for wake in list(self._wakes):
            wake.set()
        return was_ok

    def end_with_process(self) -> None:
        """Leave the network because the program has ended, without waking its daemon threads."""
        self._ends_with_process = True
        self.close()

    def end_daemon(self) -> None:
        """End a daemon thread quietly once the program has ended. Raises SystemExit in such a thread."""
        if self._ends_with_process and threading.current_thread().daemon:
            raise SystemExit  # threading ends the thread without a traceback

    def close(self) -> None:
        """Leave the network; if another thread is already doing so, wait for it."""
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
                pass  # a peer blocks the close; the session ends with the process
        with suppress(ValueError):  # at last: the process must not end meanwhile
            LOOP.at_exit.remove(self.end_with_process)

    @staticmethod
    async def _leave(context: Context) -> None:
        for node in list(context.nodes):
            await node.stop()  # type: ignore[attr-defined]
        await context.close()
