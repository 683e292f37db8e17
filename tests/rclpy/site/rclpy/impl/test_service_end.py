"""What clients and servers have in common."""

from __future__ import annotations

import pytest
from std_srvs.srv import Trigger

from rclpy.exceptions import InvalidHandle
from rclpy.node import Node


def test_it_has_a_name_until_it_is_withdrawn(node: Node) -> None:
    """Which the end of a block does, too."""
    server = node.create_service(Trigger, "ask", lambda request, response: response)
    client = node.create_client(Trigger, "ask")
    for end in (server, client):
        with end as entered:
            assert entered is end
            assert end.service_name == "/ask"
            assert not end.handle.is_destroyed
        assert end.handle.is_destroyed
        with pytest.raises(InvalidHandle):
            assert end.service_name
        end.destroy()  # twice is harmless
