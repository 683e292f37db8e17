"""Messages lost to a subscription's full queue: nothing reads them, or the handler is too slow."""

from __future__ import annotations

from graphflow.runtime.part import Host
from graphflow.transport.inbox import BYTES_BOUND

MANY_LOSSES = 100
"""Messages dropped from a full queue before a warning that most are lost."""


class Losses:
    """The warnings about the queue of one subscription, each given once.

    Args:
        label: The subscription in messages about its handler.
    """

    def __init__(self, host: Host, name: str, label: str) -> None:
        self._host, self._name, self._label = host, name, label
        self._has_warned_of_loss = self._has_warned_of_full = False

    def warn(self, dropped: int, received: int, deep: int | None, *, is_unread: bool, is_busy: bool) -> None:
        """Warn that a deep queue overflowed, or that most messages are lost.

        Args:
            deep: The length of a deep queue.
            is_unread: Whether the messages wait for an iteration that has never begun.
            is_busy: Whether the handler runs.
        """
        if is_unread:
            if not self._has_warned_of_loss and (dropped >= MANY_LOSSES or deep is not None):
                self._has_warned_of_loss = True
                text = "nothing has read %s yet, and its messages are lost, %d so far: write "
                text += "`async for message in ...` in a @task, or put @subscription on a method"
                self._host.log.warning(text, self._name, dropped)
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
        elif not self._has_warned_of_loss and dropped >= MANY_LOSSES and 2 * dropped >= received:
            self._has_warned_of_loss = True
            self._host.log.warning(
                "%s: most messages are lost, %d of %d so far: they come faster than they are handled. Do less in the "
                "handler, give it a group of its own, or have less sent%s; graphflow doctor goes on counting",
                self._label,
                dropped,
                received,
                where,
            )
