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
    from graphflow.msgs.base import Message
    from graphflow.runtime.endpoints.subscriptions import TopicSubscription
    from graphflow.tui.feeds.graph_feed import Live
    from graphflow.wire.attachment import MessageInfo


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
        """Of the topic's type, which is known only at run time."""
        self.info: MessageInfo | None = None
        self.arrivals: deque[float] = deque(maxlen=self.STAMPS)
        """Arrival times in seconds, by the monotonic clock."""
        self.on_message: Callable[[Any, float], None] | None = None
        """Called with each message and its arrival time, on the event loop."""
        self._live = live
        self._subscription: TopicSubscription[Message] | None = None

    @property
    def is_open(self) -> bool:
        return self._subscription is not None

    @property
    def dropped(self) -> int:
        """Number of messages dropped because they came too fast."""
        return 0 if self._subscription is None else self._subscription.dropped

    @property
    def lost(self) -> int:
        """Number of messages that never arrived, by gaps in their publishers' sequence numbers."""
        return 0 if self._subscription is None else self._subscription.lost

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
        from graphflow.msgs import registry  # slow to import, and not needed for the first screen

        try:
            type_: type[Message] = registry.interface_class(self.type_name)
            self._subscription = self._live.node.create_subscription(
                type_, self.topic, self._arrived, replace(BEST_AVAILABLE, depth=200), takes_info=True
            )
        except GraphflowError as error:
            self.trouble = str(error)

    def _arrived(self, message: Message, info: MessageInfo) -> None:
        now = time.monotonic()
        self.message, self.info = message, info
        self.count += 1  # last: the screen's thread takes the message when this has changed
        self.arrivals.append(now)
        if self.on_message is not None:
            self.on_message(message, now)

    def close(self) -> None:
        """Stop listening."""
        if self._subscription is not None:
            self._subscription.close()
            self._subscription = None
