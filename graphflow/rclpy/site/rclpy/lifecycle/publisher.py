"""Publishers of nodes that have a life cycle."""

from __future__ import annotations

from typing import Any

from rclpy.impl.passing import passed_on
from rclpy.lifecycle.managed_entity import SimpleManagedEntity
from rclpy.publisher import Publisher


class LifecyclePublisher(SimpleManagedEntity, Publisher):
    """A publisher that sends only while its node is active."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        SimpleManagedEntity.__init__(self)
        Publisher.__init__(self, *args, **kwargs)

    @SimpleManagedEntity.when_enabled
    def publish(self, msg: Any) -> None:
        """Send a message, while the node is active."""
        Publisher.publish(self, msg)


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)
