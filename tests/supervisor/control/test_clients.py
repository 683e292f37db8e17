"""The clients of a graph: their events, and the events and layout kept for later ones."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.supervisor.control.clients import HISTORY, LAYOUT_BOUND, TEXT_BOUND, Clients


def test_those_who_come_later_are_told_what_happened() -> None:
    """Not who else has come meanwhile; and not more than so many events."""
    clients = Clients(lambda: None)
    for i in range(HISTORY + 5):
        clients.broadcast({"event": "note", "text": str(i)})
    clients.announce("restart /a", "pts/1")
    heard: list[Any] = []
    stop = clients.subscribe(heard.append, replay=True)
    assert len(heard) == HISTORY
    assert heard[-1]["text"] == str(HISTORY + 4)
    clients.broadcast({"event": "checked"})
    stop()
    clients.broadcast({"event": "end", "exit_code": 0})
    assert heard[-1] == {"event": "checked"}


def test_consoles_come_and_go() -> None:
    """All are told who is there; the last one that leaves is noticed."""
    left: list[str] = []
    heard: list[Any] = []
    clients = Clients(lambda: left.append("empty"))
    clients.subscribe(heard.append, replay=False)
    first, second = clients.join("pts/1"), clients.join("pts/2")
    assert [c["name"] for c in heard[-1]["consoles"]] == ["pts/1", "pts/2"]
    first()
    assert left == []
    second()
    assert left == ["empty"]
    assert clients.consoles == []


def test_names_and_announcements_are_bounded_and_printable() -> None:
    """A client's name is cut and made printable."""
    clients = Clients(lambda: None)
    clients.join("\x1b[31m" + "x" * 1000)
    assert len(clients.consoles[0]["name"]) <= TEXT_BOUND + 10
    assert "\x1b" not in clients.consoles[0]["name"]
    heard: list[Any] = []
    clients.subscribe(heard.append, replay=False)
    clients.announce("\x1b[31m" + "x" * 1000, "\x07" + "y" * 1000)
    assert heard == [
        {"event": "announced", "text": "\\x1b[31m" + "x" * (TEXT_BOUND - 5), "by": "\\x07" + "y" * (TEXT_BOUND - 1)}
    ]


@pytest.mark.parametrize("layout", [None, [], "x", {"windows": "x" * LAYOUT_BOUND}])
def test_only_a_layout_of_some_size_is_kept(layout: object) -> None:
    """The former one stays."""
    clients = Clients(lambda: None)
    clients.keep_layout({"windows": []})
    with pytest.raises(ValueError, match="not a layout"):
        clients.keep_layout(layout)
    assert clients.layout == {"windows": []}
