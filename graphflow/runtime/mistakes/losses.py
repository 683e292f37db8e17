"""Messages lost to a subscription's full queue: nothing reads them, or the handler or loop is too slow.

A queue of one message keeps the newest on purpose, and a loop may be left for a while, as in a state machine: losses
then fall into few pauses, whereas a loop that is too slow loses some between nearly all messages that it reads.
"""

from __future__ import annotations

from collections.abc import Iterator
from types import CodeType, FunctionType

from graphflow.analysis.user_code import is_users_module
from graphflow.runtime.part import Host
from graphflow.transport.inbox import BYTES_BOUND
from graphflow.wire.liveliness import Kind

MANY_LOSSES = 50
"""Messages dropped from a full queue before a warning that most are lost."""
MANY_GAPS = 10
"""Messages read right after a loss before a loop counts as slow."""

_FASTER = (
    "Do less in the handler, have less sent, or keep only the newest with a depth of 1; a group of its own helps if "
    "other handlers hold it up"
)


class Losses:
    """The warnings about the queue of one subscription, each given once.

    Args:
        label: The subscription in messages about its handler.
        depth: The depth of its queue, unless it keeps all.
    """

    def __init__(self, host: Host, name: str, label: str, depth: int = 10) -> None:
        self._host, self._name, self._label, self._depth = host, name, label, depth
        self._has_warned_of_loss = self._has_warned_of_full = False

    def warn(
        self,
        dropped: int,
        received: int,
        deep: int | None,
        *,
        is_unread: bool,
        is_busy: bool,
        gaps: int | None = None,
    ) -> None:
        """Warn that a deep queue overflowed, or that most messages are lost.

        Args:
            deep: The length of a deep queue.
            is_unread: Whether the messages wait for an iteration that has never begun.
            is_busy: Whether the handler runs.
            gaps: The number of messages that a loop has read right after a loss; None if there is a handler.
        """
        if is_unread:
            if not self._has_warned_of_loss and (dropped >= MANY_LOSSES or deep is not None):
                self._has_warned_of_loss = True
                self._warn_of_unread(dropped)
            return
        where = "; graphflow waits says where it is now" if is_busy else ""
        if dropped and not self._has_warned_of_full and deep is not None:
            self._has_warned_of_full = True
            self._host.log.warning(
                "%s: its queue was full, and dropped the oldest messages, %d so far: it holds %d messages and %d MB; "
                "do less in the handler, give it a group of its own, or have less sent%s",
                self._label,
                dropped,
                deep,
                BYTES_BOUND >> 20,
                where,
            )
        elif not self._has_warned_of_loss and dropped >= MANY_LOSSES and 2 * dropped >= received and self._depth > 1:
            if gaps is None:
                handled, way = "handled", _FASTER
            elif gaps >= MANY_GAPS and 2 * gaps >= received - dropped:
                handled, way = "read", "Do less in the loop, have less sent, or keep only the newest with a depth of 1"
            else:
                return
            self._has_warned_of_loss = True
            self._host.log.warning(
                "%s: most messages are lost, %d of %d so far: they come faster than they are %s. %s%s; later "
                "losses are counted by graphflow doctor",
                *(self._label, dropped, received, handled, way, where),
            )

    def _warn_of_unread(self, dropped: int) -> None:
        node = getattr(self._host, "instance", None)
        values = {**getattr(self._host, "objects", {}), **getattr(node, "__dict__", {})}
        used = [values[name] for name in _names_used(type(node)) if name in values]
        if any(getattr(x, "kind", None) is Kind.SUBSCRIPTION and x.name == self._name for x in used):
            return  # a method will read it, which has not come so far
        text = "nothing has read %s yet, and its messages are lost, %d so far: write "
        text += "`async for message in ...` in a @task, or put @subscription on a method"
        self._host.log.warning(text, self._name, dropped)


def _names_used(node: type) -> Iterator[str]:
    """Yield the attributes that the methods of a node's class use, besides `__init__`, which may make them."""
    for cls in node.__mro__:
        if is_users_module(cls.__module__):
            methods = (method for name, method in vars(cls).items() if name != "__init__")
            codes = [method.__code__ for method in methods if isinstance(method, FunctionType)]
            while codes:
                code = codes.pop()
                codes += [part for part in code.co_consts if isinstance(part, CodeType)]
                yield from code.co_names
