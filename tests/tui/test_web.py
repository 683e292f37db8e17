"""The console in a browser."""

from __future__ import annotations

import pytest

server = pytest.importorskip("textual_serve.server", reason="the extra `web` is not installed")


def test_it_listens_on_this_machine_only(monkeypatch: pytest.MonkeyPatch) -> None:
    """There is no password, so only this machine may connect."""
    from graphflow.tui import web

    made: list[tuple[str, str, int]] = []

    class Server:
        def __init__(self, command: str, *, host: str, port: int, title: str) -> None:
            made.append((command, host, port))

        def serve(self) -> None:
            """Returns at once: there are no clients."""

    monkeypatch.setattr(web, "OwnPageServer", Server)
    web.serve(["python", "-m", "graphflow", "attach", "--graph", "a b"], 8147)
    assert made == [("python -m graphflow attach --graph 'a b'", "127.0.0.1", 8147)]
