"""How Zenoh sessions are configured, opened and closed. Free of asyncio, for the sake of short commands."""

from __future__ import annotations

import json
import os
import threading
from functools import cache

import zenoh

from graphflow.errors import TransportError

ENDPOINT_VARIABLE = "GRAPHFLOW_RENDEZVOUS"
DEFAULT_ENDPOINT = "tcp/127.0.0.1:7447"
"""Where a ROS 2 node with default settings looks for its router."""

CLOSE_LIMIT = 2.0
"""Seconds a session may take to close."""
QUERY_LIMIT_MS = 600_000
"""As rmw_zenoh; graphflow's own deadlines are shorter and kept by the runtime."""


def rendezvous_endpoint() -> str:
    """Where processes of this machine find each other."""
    return os.environ.get(ENDPOINT_VARIABLE, DEFAULT_ENDPOINT)


def config(mode: str, *, connect: str | None = None, listen: str | None = None) -> zenoh.Config:
    """A session configuration. Multicast is off and nothing listens beyond `listen`."""
    return zenoh.Config.from_json5(
        json.dumps(
            {
                "mode": mode,
                "connect": {
                    "endpoints": [connect] if connect else [],
                    "retry": {"period_init_ms": 20, "period_max_ms": 200, "period_increase_factor": 2},
                },
                "listen": {"endpoints": [listen] if listen else []},
                # Without a delay of 0 opening takes half a second, even with multicast off.
                "scouting": {"delay": 0, "multicast": {"enabled": False}, "gossip": {"enabled": True}},
                # Advanced publishers, which keep messages for late joiners, order them by time stamp.
                "timestamping": {"enabled": True},
                "queries_default_timeout": QUERY_LIMIT_MS,
                "adminspace": {"enabled": False},
                "transport": {
                    "unicast": {"open_timeout": 500, "accept_timeout": 5000},
                    "link": {"tx": {"lease": 10_000}},
                    # Shared memory for publications only: zenoh#2628 affects queries.
                    "shared_memory": {"transport_optimization": {"messages": ["put"]}},
                },
            }
        )
    )


@cache
def _quiet() -> None:
    """Keep Zenoh's own log to what RUST_LOG asks for."""
    zenoh.init_log_from_env_or("off")


def open_session(settings: zenoh.Config) -> zenoh.Session:
    """Open a raw session.

    Raises:
        TransportError: Zenoh refused.
    """
    _quiet()
    try:
        return zenoh.open(settings)
    except zenoh.ZError as error:
        raise TransportError(str(error).partition(" at /")[0]) from None


def close_session(session: zenoh.Session) -> None:
    """Close a session; give up after `CLOSE_LIMIT` seconds, since a stuck peer can hold it."""
    closer = threading.Thread(target=session.close, name="zenoh-close", daemon=True)
    closer.start()
    closer.join(CLOSE_LIMIT)
