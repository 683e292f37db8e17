"""A subscription for a view: the latest message of a topic, and the times of the last ones."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from graphflow.errors import GraphflowError
from graphflow.names import nearest
from graphflow.qos import BEST_AVAILABLE

if TYPE_CHECKING:
    from graphflow.tui.feeds.graph_feed import Live


class TopicMonitor:
    """The latest message of one topic, and the arrival times of the last ones."""

    STAMPS = 2000
    """Arrival times remembered."""

    def __init__(self, live: Live, topic: str) -> None:
        self.topic = topic
        self.trouble = ""
        """The reason why there is no subscription; empty if there is none."""
        self.type_name = ""
        self.count = 0
        self.message: Any = None
        self.info: Any = None
        self.arrivals: deque[float] = deque(maxlen=self.STAMPS)
        """Arrival times in seconds, by the monotonic clock."""
        self.heard: Callable[[Any, float], None] | None = None
        """Called with each message and its arrival time, on the event loop."""
        self._live = live
        self._subscription: Any = None

    @property
    def is_open(self) -> bool:
        return self._subscription is not None

    @property
    def dropped(self) -> int:
        """Number of messages dropped because they came too fast."""
        return 0 if self._subscription is None else int(self._subscription.dropped)

    @property
    def lost(self) -> int:
        """Number of messages that never arrived, by gaps in their publishers' sequence numbers."""
        return 0 if self._subscription is None else int(self._subscription.lost)

    def look(self) -> None:
        """Subscribe once the topic exists."""
        if self._subscription is not None or self._live.node is None:
            return
        topics = self._live.cache.topics(hidden=True)
        types = topics.get(self.topic)
        if not types:
            near = nearest(self.topic, topics)
            self.trouble = f"nobody publishes {self.topic} yet" + (f"; did you mean {near}?" if near else "")
            return
        self.type_name, self.trouble = types[0], ""
        from graphflow.msgs import registry

        try:
            type_: Any = registry.interface_class(self.type_name)
            self._subscription = self._live.node.create_subscription(
                type_, self.topic, self._arrived, replace(BEST_AVAILABLE, depth=200), takes_info=True
            )
        except GraphflowError as error:
            self.trouble = str(error)

    def _arrived(self, message: Any, info: Any) -> None:
        now = time.monotonic()
        self.count += 1
        self.message, self.info = message, info
        self.arrivals.append(now)
        if self.heard is not None:
            self.heard(message, now)

    def close(self) -> None:
        """Stop listening."""
        if self._subscription is not None:
            self._subscription.close()
            self._subscription = None
