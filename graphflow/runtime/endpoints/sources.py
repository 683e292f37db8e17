"""A subscription's records of its publishers."""

from __future__ import annotations

from graphflow.qos import INFINITE_NS
from graphflow.runtime.endpoints.events import SilenceTimer
from graphflow.transport.base import Closable


class Source:
    """One publisher, as a subscription knows it."""

    __slots__ = ("alive", "lease", "lifespan_ns", "needs_care", "sequence")

    def __init__(self, lifespan_ns: int) -> None:
        self.sequence = 0
        self.lease: SilenceTimer | None = None
        self.alive: Closable | None = None
        self.expects(lifespan_ns)

    def expects(self, lifespan_ns: int, lease: SilenceTimer | None = None) -> None:
        """Set the lifespan of its messages, in nanoseconds, and its liveliness timer."""
        self.lifespan_ns = lifespan_ns
        self.lease = lease or self.lease
        self.needs_care = lifespan_ns != INFINITE_NS or self.lease is not None
        """Whether the time of each message matters."""
