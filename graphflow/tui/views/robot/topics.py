"""The topics of some types, from which views of a robot choose."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from graphflow.tui.feeds.graph_feed import Live


def topics_of(live: Live | None, *types: str) -> list[str]:
    """Return the topics of any of some types, sorted."""
    if live is None or live.node is None:
        return []
    return sorted(topic for topic, found in live.cache.topics().items() if any(type_ in found for type_ in types))


def next_of(topics: Sequence[str], topic: str) -> str:
    """Return the topic after one, the first after the last; the one itself if there is no other."""
    if not topics:
        return topic
    return topics[(topics.index(topic) + 1) % len(topics)] if topic in topics else topics[0]
