"""Contexts: the scope from `rclpy.init` to `rclpy.shutdown`."""

from __future__ import annotations

import logging
import sys
import threading
import warnings
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from inspect import ismethod
from types import TracebackType
from typing import Any, Self
from weakref import WeakMethod, ref

from graphflow.errors import GraphflowError
from graphflow.rclpy.context_state import ContextState
from graphflow.runtime.args import missed, unrecognized
from graphflow.runtime.logs.rosout import log_level, setup_console
from graphflow.runtime.mistakes import unrun
from rclpy._rclpy_pybind11 import RCLError, RCLInvalidROSArgsError, UnknownROSArgsError
from rclpy.handle import Handle
from rclpy.impl.logging_severity import LoggingSeverity
from rclpy.impl.rcutils_logger import RcutilsLogger

logger = logging.getLogger("graphflow")
_ALREADY = "failed to shutdown: rcl_shutdown already called on the given context"
unrun.watch()


class Context(AbstractContextManager["Context"]):
    """The shared state of a program's nodes: arguments, domain, and shutdown."""

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._callbacks: list[Callable[[], Any]] = []
        self._life: ContextState | None = None
        self._handle: Handle | None = None

    @property
    def handle(self) -> Handle | None:
        return self._handle

    @property
    def life(self) -> ContextState | None:
        """graphflow's state of the context, which nodes, executors and sleeps consult. None before `init`."""
        return self._life

    def init(
        self, args: Sequence[str] | None = None, *, initialize_logging: bool = True, domain_id: int | None = None
    ) -> None:
        """Initialize the context.

        Args:
            args: The command line; None for the program's own.
            domain_id: None for the environment's.

        Raises:
            RuntimeError: It is already initialized, or an argument is wrong.
        """
        unrun.ran()
        words = list(sys.argv if args is None else args)
        _warn_of_ignored(args)
        # Bytes that are not UTF-8 come as lone surrogates. rclpy raises UnicodeEncodeError for them, as this does.
        for word in words:
            word.encode()
        with self._lock:
            if domain_id is not None and domain_id < 0:
                raise RuntimeError(f"Domain id ({domain_id}) should not be lower than zero.")
            if self._life is not None and self._life.is_ok:
                raise RuntimeError("Context.init() must only be called once")
            try:
                life = ContextState(words, domain_id)
                if life.args.unknown:
                    unknown = life.args.unknown
                    hint = unrecognized(unknown[0], words)
                    raise UnknownROSArgsError(f"Found unknown ROS arguments: {unknown}{hint}")
                if initialize_logging:
                    setup_console(is_quiet=not life.args.has_stdout)
                    level = log_level(life.args.log_level)
                    # INFO is the default: setting it would also override a level that the program has set before.
                    if level != LoggingSeverity.INFO:
                        RcutilsLogger().set_level(level)
                    for name, word in life.args.log_levels.items():
                        RcutilsLogger(name.replace("/", ".")).set_level(log_level(word))
                    if text := missed(words):
                        logger.warning("%s", text)
            except GraphflowError as error:
                raise RCLInvalidROSArgsError(f"Failed to parse ROS arguments: {error}") from None
            self._life = life
            self._handle = Handle(self._destroy, ok=self.ok, get_domain_id=self.get_domain_id, shutdown=self.shutdown)

    def ok(self) -> bool:
        """Whether the context is initialized and not shut down."""
        return self._life is not None and self._life.is_ok

    def get_domain_id(self) -> int:
        """Return the domain. Raises RuntimeError before `init`."""
        if self._life is None:
            raise RuntimeError("Context must be initialized before it has a domain id")
        return self._life.domain

    def shutdown(self) -> None:
        """Shut down: call the registered callbacks, and leave the network.

        Raises:
            RuntimeError: It is not initialized.
            RCLError: It is already shut down.
        """
        if self._life is None:
            raise RuntimeError("Context must be initialized before it can be shutdown")
        if not self.try_shutdown():
            raise RCLError(_ALREADY)

    def try_shutdown(self) -> bool:
        """Shut down if not done yet; return whether this call did."""
        with self._lock:
            life = self._life
            if life is None or not life.end():
                return False
        # Outside the lock, since it runs user code.
        self.finish()
        return True

    def finish(self) -> None:
        """Run the callbacks and leave the network after the end; may take a while, and runs user code."""
        with self._lock:
            life, callbacks, self._callbacks = self._life, self._callbacks, []
        for reference in callbacks:
            callback = reference()
            if callback is not None:
                callback()
        if life is not None:
            life.close()

    def on_shutdown(self, callback: Callable[[], None]) -> None:
        """Call `callback` at shutdown, if it still exists then. Raises TypeError if it is not callable."""
        if not callable(callback):
            raise TypeError(f"callback should be a callable, got {type(callback)}")
        with self._lock:
            if self._life is not None and not self._life.is_ok:
                callback()
                return
            # Weakly, as in rclpy: it must not keep a node alive. A plain `ref` of a bound method is dead at once.
            self._callbacks.append(WeakMethod(callback) if ismethod(callback) else ref(callback))

    def destroy(self) -> None:
        """Shut down for good."""
        if self._handle is not None:
            self._handle.destroy_when_not_in_use()

    def _destroy(self) -> None:
        self.try_shutdown()

    def __del__(self) -> None:
        life = getattr(self, "_life", None)
        if life is not None and life.is_ok:
            warnings.warn("a context was left without shutdown", ResourceWarning, stacklevel=1)

    def __enter__(self) -> Self:
        self.init()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.try_shutdown()


def _warn_of_ignored(args: Sequence[str] | None) -> None:
    """Warn of words on the command line that an empty list of arguments hides."""
    if args is not None and not args and "--ros-args" in sys.argv:
        ignored = " ".join(sys.argv[sys.argv.index("--ros-args") :])
        logger.warning("init(args=[]) ignores the words %s; write args=None, or args=sys.argv", ignored)
