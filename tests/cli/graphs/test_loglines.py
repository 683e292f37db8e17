"""Filtering log lines by level and time."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from graphflow.cli.graphs.loglines import Chosen, record, time_of
from graphflow.errors import UsageFault

A, B = Path("a.log"), Path("b.log")
LINES = [
    "hello from print",
    "[DEBUG] [1000.100000000] [a]: one",
    "[INFO] [1001.100000000] [a]: two",
    "[ERROR] [1002.100000000] [a]: three",
    "Traceback (most recent call last):",
    "[INFO] [1003.100000000] [a]: four",
    "[supervisor] process 5 has ended: exit code 1",
]


def test_by_level() -> None:
    """A traceback goes with its message; how a process ended is always of interest; without a level all is wanted."""
    assert Chosen("error", None).of(A, LINES) == [*LINES[3:5], LINES[6]]
    assert Chosen("info", None).of(A, LINES) == LINES[2:]
    assert Chosen(None, None).of(A, LINES) == LINES


def test_what_was_read_before_counts() -> None:
    """A file may be read in pieces, between the lines of a traceback too; another file is another matter."""
    chosen = Chosen("error", None)
    assert chosen.of(A, LINES[:4]) == LINES[3:4]
    assert chosen.of(B, LINES[4:5]) == []
    assert chosen.of(A, LINES[4:5]) == LINES[4:5]


def test_by_time() -> None:
    """Messages since some time."""
    now = f"[INFO] [{time.time():.9f}] [a]: now"
    assert Chosen(None, "1h").of(A, [*LINES[:6], now]) == [now]


@pytest.mark.parametrize(
    ("text", "before"), [("30s", 30), ("5m", 300), ("2h", 7200), ("1d", 86400), ("7", 7), ("0.5h", 1800)]
)
def test_so_long_ago(text: str, before: float) -> None:
    """Seconds, unless another unit is named."""
    assert time_of(text, 100_000.0) == 100_000.0 - before


def test_a_time_of_the_day() -> None:
    """The last that was."""
    noon = time.mktime((2026, 11, 23, 12, 0, 0, 0, 0, -1))
    assert time_of("11:59", noon) == noon - 60
    assert time_of("11:59:30", noon) == noon - 30
    assert time_of("12:01", noon) == noon + 60 - 86400


@pytest.mark.parametrize("text", ["", "soon", "25:00", "12:60", "5w", "-3s", "1:2:3:4"])
def test_no_time(text: str) -> None:
    """The error shows the format of a time."""
    with pytest.raises(UsageFault, match="write a duration such as 30s, 5m or 2h"):
        time_of(text, 0.0)


def test_for_programs() -> None:
    """A line with a head in its parts, any other as text."""
    found = record("a", "[WARN] [1795223522.100807190] [lab.a]: no]: way")
    parts = {"level": "WARN", "stamp_ns": 1795223522100807190, "logger": "lab.a", "text": "no]: way"}
    assert found == {"event": "log", "node": "a", **parts}
    nothing = dict.fromkeys(("level", "stamp_ns", "logger"))
    assert record("a", LINES[0]) == {"event": "log", "node": "a", **nothing, "text": LINES[0]}
