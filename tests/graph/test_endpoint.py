"""Endpoints: accepted, or told how to write them."""

from __future__ import annotations

import pytest

from graphflow.graph.endpoint import endpoint


@pytest.mark.parametrize("text", ["tcp/10.0.0.7:7447", "tls/robot.local:1", "tcp/[::1]:65535"])
def test_endpoints(text: str) -> None:
    """Protocol, host and port."""
    assert endpoint(text) == text


@pytest.mark.parametrize("text", ["", "robot", "robot:7447", "udp/robot:7447", "tcp/:7447", "tcp/robot:0", "tcp/r:x"])
def test_what_is_no_endpoint(text: str) -> None:
    """Anything else is told how to write one."""
    with pytest.raises(ValueError, match="write tcp/HOST:7447"):
        endpoint(text)
