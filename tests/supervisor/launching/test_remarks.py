"""Remarks for the clients of a graph that is coming up."""

from __future__ import annotations

import logging

from graphflow.supervisor.launching.remarks import forward_network_logs


def test_the_network_is_remarked_on() -> None:
    """Nothing else that is logged is."""
    notes: list[str] = []
    before = {name: list(logging.getLogger(name).handlers) for name in ("graphflow.link", "graphflow.rendezvous")}
    forward_network_logs(notes.append)
    try:
        logging.getLogger("graphflow.link").warning("the link to %s is refused", "tcp/10.0.0.7")
        logging.getLogger("graphflow.supervisor").warning("something else")
    finally:
        for name, handlers in before.items():
            logging.getLogger(name).handlers[:] = handlers
    assert notes == ["the link to tcp/10.0.0.7 is refused"]
