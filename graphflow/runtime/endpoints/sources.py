"""A subscription's records of its publishers, and their leases."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from graphflow.qos import DEFAULT, INFINITE_NS
from graphflow.runtime.endpoints.events import SilenceTimer
from graphflow.runtime.endpoints.intra_process import Handed
from graphflow.runtime.endpoints.publishers import alive_key
from graphflow.runtime.part import Host
from graphflow.transport.base import Closable
from graphflow.transport.inbox import Inbox
from graphflow.wire.liveliness import Entity


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


class Leases:
    """The liveliness of a subscription's publishers: one with a lease is alive while it asserts that it is.

    Args:
        sources, matched: The subscription's records and publishers, which it keeps up to date.
        tell: Called with (change, number of publishers alive, node of the publisher).
    """

    def __init__(
        self,
        host: Host,
        sources: Mapping[bytes, Source],
        matched: Mapping[Any, Entity],
        tell: Callable[[int, int, str], None],
    ) -> None:
        self._host, self._sources, self._matched, self._tell = host, sources, matched, tell

    def watch(self, other: Entity, source: Source, waiting: Inbox) -> None:
        """Begin the lease of a publisher.

        Args:
            waiting: The subscription's queue: a publisher with a message in it is alive.
        """

        def silent() -> None:
            assert source.lease is not None
            if any(_gid_of(arrival, read) == other.gid for arrival in waiting.items):
                source.lease.touch()  # it has published: the handler is late, not the publisher
                return
            source.lease.stop()
            self.changed(-1, other.node_name)

        session = self._host.context.session
        read = session.read
        lease = SilenceTimer(self._host.clock, other.qos.lease_ns, silent)
        source.expects(source.lifespan_ns, lease)
        lease.start()
        inbox = Inbox(session.bell, 1, lambda: self.revive(other.gid))
        source.alive = session.open_receiver(alive_key(other), DEFAULT, inbox)

    def revive(self, gid: bytes) -> None:
        """Note a liveliness assertion of a publisher."""
        source = self._sources.get(gid)
        if source is None or source.lease is None:
            return
        source.lease.touch()
        if not source.lease.is_running:
            source.lease.start()
            self.changed(1, next((e.node_name for e in self._matched.values() if e.gid == gid), ""))

    def changed(self, change: int, node: str) -> None:
        """Report that a publisher of a node has become alive, or no longer is."""
        silent = sum(1 for s in self._sources.values() if s.lease is not None and not s.lease.is_running)
        self._tell(change, len(self._matched) - silent, node)


def end_lease(source: Source | None) -> None:
    """End the lease of a publisher, if it has one."""
    if source is not None and source.lease is not None and source.alive is not None:
        source.lease.stop()
        source.alive.close()


def _gid_of(arrival: Any, read: Callable[[Any], tuple[bytes, bytes | None]]) -> bytes:
    """Return an arrival's sender GID; b"" if unknown."""
    if isinstance(arrival, Handed):
        return arrival.fields[2]
    beside = read(arrival)[1]
    return beside[-16:] if beside is not None else b""
