"""The protocols of a network."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from graphflow.transport.base import request_size


def test_the_size_of_a_request_is_its_own() -> None:
    """Inboxes of requests count it without decoding them."""
    request: Any = SimpleNamespace(size=33)
    assert request_size(request) == 33
