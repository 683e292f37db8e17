"""Endpoints: accepted, or told how to write them."""

from __future__ import annotations

import pytest

from graphflow.graph.zenoh_address import endpoint


@pytest.mark.parametrize("text", ["tcp/10.0.0.7:7447", "tls/robot.local:1", "tcp/[::1]:65535"])
def test_endpoints(text: str) -> None:
    """Protocol, host and port."""
    assert endpoint(text) == text


@pytest.mark.parametrize("text", ["", "robot", "robot:7447", "udp/robot:7447", "tcp/:7447", "tcp/r:x"])
def test_what_is_no_endpoint(text: str) -> None:
    """Anything else is told how to write one."""
    with pytest.raises(ValueError, match="write tcp/HOST:7447"):
        endpoint(text)


@pytest.mark.parametrize("port", ["0", "65536", "99999"])
def test_what_is_no_port(port: str) -> None:
    """Is told as that."""
    with pytest.raises(ValueError, match=f"a port is 1 to 65535, not {port}"):
        endpoint(f"tcp/robot:{port}")
