"""Those who follow a graph: what they are told, and what is kept for those who come later."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.supervisor.doors import HISTORY, LAYOUT_BOUND, WORDS_BOUND, Doors


def test_those_who_come_later_are_told_what_happened() -> None:
    """Not who else has come meanwhile; and not more than so many events."""
    doors = Doors(lambda: None)
    for i in range(HISTORY + 5):
        doors.tell(event="note", text=str(i))
    doors.announce("restart /a", "pts/1")
    heard: list[dict[str, Any]] = []
    stop = doors.subscribe(heard.append, replay=True)
    assert len(heard) == HISTORY
    assert heard[-1]["text"] == str(HISTORY + 4)
    doors.tell(event="up")
    stop()
    doors.tell(event="end")
    assert heard[-1] == {"event": "up"}


def test_consoles_come_and_go() -> None:
    """All are told who is there; the last one that leaves is noticed."""
    left: list[str] = []
    heard: list[dict[str, Any]] = []
    doors = Doors(lambda: left.append("empty"))
    doors.subscribe(heard.append, replay=False)
    first, second = doors.join("pts/1"), doors.join("pts/2")
    assert [c["name"] for c in heard[-1]["consoles"]] == ["pts/1", "pts/2"]
    first()
    assert left == []
    second()
    assert left == ["empty"]
    assert doors.consoles == []


def test_names_and_announcements_are_bounded_and_printable() -> None:
    """Whatever a door may call itself."""
    doors = Doors(lambda: None)
    doors.join("\x1b[31m" + "x" * 1000)
    assert len(doors.consoles[0]["name"]) <= WORDS_BOUND + 10
    assert "\x1b" not in doors.consoles[0]["name"]


@pytest.mark.parametrize("layout", [None, [], "x", {"windows": "x" * LAYOUT_BOUND}])
def test_only_a_layout_of_some_size_is_kept(layout: object) -> None:
    """The former one stays."""
    doors = Doors(lambda: None)
    doors.keep_layout({"windows": []})
    with pytest.raises(ValueError, match="not a layout"):
        doors.keep_layout(layout)
    assert doors.layout == {"windows": []}
