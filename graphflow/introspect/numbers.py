"""What the nodes of a domain count, and the rates that two looks at it give."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any, NamedTuple

REPLY_BOUND = 1 << 20
"""Bytes that one process's answer may have."""
NODES_BOUND = 10_000
"""Nodes and endpoints that are kept track of."""
_COUNTED = {"publisher": "published", "subscription": "received"}


class Flow(NamedTuple):
    """One endpoint of one node: a publisher or a subscription."""

    node: str
    kind: str
    """`publisher` or `subscription`."""
    topic: str


@dataclass
class Numbers:
    """The last two looks at all processes of a domain."""

    rates: dict[Flow, float] = field(default_factory=dict)
    """Messages a second by endpoint."""
    dropped: dict[Flow, int] = field(default_factory=dict)
    """Messages that subscriptions have dropped since their start."""
    lags: dict[str, float] = field(default_factory=dict)
    """Seconds that the event loop under each node took to come round."""
    _counts: dict[Flow, int] = field(default_factory=dict)
    _at: float = 0.0

    def take(self, replies: list[bytes], now: float) -> None:
        """Take in a look at all processes.

        Args:
            now: When it was, in seconds by any clock that only goes forward.
        """
        counts: dict[Flow, int] = {}
        self.lags, self.dropped = {}, {}
        for reply in replies:
            self._read(reply, counts)
        span = now - self._at
        if self._at and span > 0:
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
            data: Any = json.loads(reply)
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
            return  # a process of another version: its numbers are left out

    def published(self, topic: str) -> float | None:
        """Messages a second that graphflow's nodes publish on a topic; None if none of them does."""
        found = [r for flow, r in self.rates.items() if flow.topic == topic and flow.kind == "publisher"]
        return sum(found) if found else None

    def fastest(self, node: str) -> float | None:
        """The rate of a node's fastest publisher, its log and parameter events left out."""
        found = [r for flow, r in self.rates.items() if flow.node == node and flow.kind == "publisher"]
        return max(found) if found else None
