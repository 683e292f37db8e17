"""The counters of a domain's nodes, and the rates between two samples of them."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import NamedTuple

REPLY_BOUND = 1 << 20
"""Most bytes of one process's answer."""
NODES_BOUND = 10_000
"""Most endpoints that are tracked."""
_COUNTED = {"publisher": "published", "subscription": "received"}


class Flow(NamedTuple):
    """One endpoint of one node: a publisher or a subscription."""

    node: str
    kind: str
    """`publisher` or `subscription`."""
    topic: str


@dataclass
class Numbers:
    """The last two samples of all processes of a domain."""

    rates: dict[Flow, float] = field(default_factory=dict)
    """Messages per second by endpoint."""
    dropped: dict[Flow, int] = field(default_factory=dict)
    """Messages that subscriptions have dropped since their start."""
    lags: dict[str, float] = field(default_factory=dict)
    """Delay of the event loop of each node, in seconds."""
    _counts: dict[Flow, int] = field(default_factory=dict)
    _at: float = 0.0

    def take(self, replies: list[bytes], now: float) -> None:
        """Add a sample of all processes.

        Args:
            now: Its time, in seconds on a monotonic clock.
        """
        counts: dict[Flow, int] = {}
        self.lags, self.dropped = {}, {}
        for reply in replies:
            self._read(reply, counts)
        span = now - self._at
        if self._at and span > 0:
            # A count that has become smaller is that of a node which was started again.
            self.rates = {
                flow: (n - self._counts[flow]) / span
                for flow, n in counts.items()
                if flow in self._counts and n >= self._counts[flow]
            }
        self._counts, self._at = counts, now

    def _read(self, reply: bytes, counts: dict[Flow, int]) -> None:
        if len(reply) > REPLY_BOUND:
            return
        try:
            data = json.loads(reply)
            for node, parts in dict(data["nodes"]).items():
                self.lags[node] = float(data["lag"])
                for title, numbers in dict(parts).items():
                    kind, _, topic = str(title).partition(" ")
                    if kind in _COUNTED and len(counts) < NODES_BOUND:
                        flow = Flow(node, kind, topic)
                        counts[flow] = counts.get(flow, 0) + int(numbers[_COUNTED[kind]])
                        if numbers.get("dropped"):
                            self.dropped[flow] = int(numbers["dropped"])
        except (ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError):
            return  # a process of another version: leave its numbers out

    def published(self, topic: str) -> float | None:
        """Return how many messages per second graphflow's nodes publish on a topic; None if none does."""
        found = [r for flow, r in self.rates.items() if flow.topic == topic and flow.kind == "publisher"]
        return sum(found) if found else None

    def fastest(self, node: str) -> float | None:
        """Return the rate of a node's fastest publisher, without its log and parameter events."""
        found = [r for flow, r in self.rates.items() if flow.node == node and flow.kind == "publisher"]
        return max(found) if found else None
