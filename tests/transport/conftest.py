"""What several tests of the network share."""

from __future__ import annotations

import json
from collections.abc import Iterator

import pytest
import zenoh

from graphflow.transport import rendezvous


@pytest.fixture
def port(monkeypatch: pytest.MonkeyPatch) -> int:
    """A rendezvous port of the test's own."""
    endpoint = rendezvous.free_endpoint()
    monkeypatch.setenv("GRAPHFLOW_RENDEZVOUS", endpoint)
    return rendezvous.address(endpoint)[1]


@pytest.fixture
def foreign_router(port: int) -> Iterator[zenoh.Session]:
    """A Zenoh router that is not graphflow's, as rmw_zenohd is."""
    config = {
        "mode": "router",
        "listen": {"endpoints": [f"tcp/127.0.0.1:{port}"]},
        "scouting": {"delay": 0, "multicast": {"enabled": False}},
    }
    with zenoh.open(zenoh.Config.from_json5(json.dumps(config))) as session:
        yield session
