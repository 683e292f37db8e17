"""Statements that name a method without calling it: `self.timer.cancel`.

Python runs them silently and without effect.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Iterator
from contextlib import suppress
from typing import TYPE_CHECKING

from graphflow.analysis.mistakes.calls.hidden_logs import HIDDEN
from graphflow.analysis.mistakes.rclpy_source import slips
from graphflow.analysis.syntax import syntax_of
from graphflow.analysis.user_code import is_users, parts_of, short_place
from rclpy.impl.entities import entities_of
from rclpy.impl.failing import failure
from rclpy.impl.logging_severity import LoggingSeverity
from rclpy.impl.nodes import internals_of, nodes_of

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState
    from rclpy.node import Node

UNSPUN = 1.0
"""Seconds from which on a node that nobody spins is checked."""
logger = logging.getLogger("graphflow")


class Uncalled:
    """Such statements in the files of one context's nodes, each reported once."""

    def __init__(self, life: ContextState) -> None:
        self._life = life
        self._nodes: set[int] = set()
        """The ids of the nodes whose files have been read: entities exist once a node is spun, or leaves."""
        self._seen: set[int] = set()
        """The ids of the nodes whose classes have been read: one may wait in its constructor, and never be spun."""
        self._files: set[str] = set()
        life.on_leaving.append(self._leaves)

    def check(self) -> None:
        """Check the files of nodes that are spun for the first time, or that have not been spun for long."""
        for node in nodes_of(self._life):
            inner = internals_of(node)
            is_spun, is_late = inner.times_added > 0, time.monotonic() - inner.begun > UNSPUN
            if inner.core.id not in (self._nodes if is_spun else self._seen) and (is_spun or is_late):
                self._read(node, is_spun=is_spun)

    def _leaves(self, node: Node) -> None:
        ended_by = failure()
        self._read(node, is_spun=True, after=ended_by if isinstance(ended_by, Exception) else None)
        self._nodes.discard(internals_of(node).core.id)
        self._seen.discard(internals_of(node).core.id)

    def _read(self, node: Node, *, is_spun: bool, after: Exception | None = None) -> None:
        """Report on a node's files; after an error that ended the program, only on the methods it came from."""
        (self._nodes if is_spun else self._seen).add(internals_of(node).core.id)
        for file in set(_files_of(node)) - self._files:
            self._files.add(file)
            with suppress(OSError, SyntaxError, ValueError):  # its source is not available
                module = syntax_of(file).module
                for line, text in slips(module):
                    if text == HIDDEN and node.get_logger().is_enabled_for(LoggingSeverity.DEBUG):
                        continue
                    if after is not None and not any(f"'{name}'" in text for name in _functions_in(after)):
                        continue
                    logger.warning("%s: %s", short_place(file, line), text)


def _functions_in(error: Exception) -> list[str]:
    return [part.tb_frame.f_code.co_name for part in parts_of(error.__traceback__)]


def _files_of(node: Node) -> Iterator[str]:
    """Return the user's files that define a node's class and callbacks."""
    functions = [value for cls in type(node).__mro__ for value in vars(cls).values()]
    functions += [getattr(e, "callback", None) or getattr(e, "_execute_callback", None) for e in entities_of(node)]
    for function in functions:
        code = getattr(function, "__code__", None)
        if code is not None and is_users(code.co_filename):
            yield code.co_filename
