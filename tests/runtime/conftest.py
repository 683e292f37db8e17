"""Fixtures for several tests."""

from __future__ import annotations

import pytest

from graphflow.runtime.endpoints.direct_calls import ServerLines


@pytest.fixture(params=["direct", "query"])
def way(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """How calls travel: as between graphflow processes, or as with any other."""
    if request.param == "query":
        monkeypatch.setattr(ServerLines, "client_came", lambda self, client: None)
    return str(request.param)
