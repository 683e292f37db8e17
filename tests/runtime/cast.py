"""Characters that several tests share."""

from __future__ import annotations

from typing import Any

from graphflow import Node, Publisher, Subscription
from graphflow.msgs.std_msgs.msg import String


class Log(list[Any]):
    """What a handler was called with."""

    def __call__(self, item: Any) -> None:
        self.append(item)


class Speaker(Node):
    """Holds a publisher and listens by iterating."""

    chatter = Publisher(String, "chatter")
    heard = Subscription(String, "chatter", 3)


async def nothing() -> None:
    """Do nothing."""
