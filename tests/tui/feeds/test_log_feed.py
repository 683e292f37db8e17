"""Logs: every line once, however it is split by writer and reader."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from graphflow.tui.feeds import log_feed
from graphflow.tui.feeds.log_feed import LEVELS, LogFile, Logs, plain_text
from tests.cases import cases, count


def line(number: int, node: str = "talker", level: str = "INFO") -> str:
    return f"[{level}] [{1700000000 + number / 1000:.9f}] [{node}]: line {number}\n"


@cases(count(few=40, full=150))
@given(cuts=st.lists(st.integers(1, 400), max_size=60))
def test_each_line_comes_once_whatever_the_pieces(cuts: list[int], tmp_path_factory: pytest.TempPathFactory) -> None:
    """Wherever the writer pauses and the reader reads, no line is lost or repeated."""
    path = tmp_path_factory.mktemp("l") / "talker.log"
    data = "".join(line(i) for i in range(200)).encode()
    read = Logs()
    read.follow([(str(path), ("/talker",))])
    at = 0
    with path.open("wb", buffering=0) as file:
        for cut in cuts:
            file.write(data[at : at + cut])
            at += cut
            read.read()
        file.write(data[at:])
    while read.read():
        pass
    assert [r.text for r in read.records] == [f"line {i}" for i in range(200)]
    assert [r.offset for r in read.records] == sorted({r.offset for r in read.records})


def test_coming_back_shows_what_was_written_meanwhile_once(tmp_path: Path) -> None:
    """A second console reads the whole file, including lines written since the first."""
    path = tmp_path / "talker.log"
    path.write_text("".join(line(i) for i in range(10)))
    first = Logs()
    first.follow([(str(path), ("/talker",))])
    first.read()
    with path.open("a") as file:
        file.write("".join(line(i) for i in range(10, 20)))
    second = Logs()
    second.follow([(str(path), ("/talker",))])
    second.read()
    assert [r.text for r in second.records] == [f"line {i}" for i in range(20)]


def test_a_long_log_is_read_from_a_line_near_its_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Reading never begins in the middle of a line."""
    monkeypatch.setattr(log_feed, "BACKLOG", 1000)
    path = tmp_path / "talker.log"
    path.write_text("".join(line(i) for i in range(1000)))
    file = LogFile(path, ("/talker",))
    found = file.read()
    assert [r.text for r in found] == [f"line {i}" for i in range(1000 - len(found), 1000)]
    assert 10 < len(found) < 30


def test_levels_nodes_and_what_goes_on(tmp_path: Path) -> None:
    """A traceback belongs to the record before it; a print, to the node; a child logger, to its node."""
    path = tmp_path / "arm.log"
    path.write_text(
        "hello\n" + line(1, "arm.left.motor", "WARN") + line(2, "arm.right", "ERROR") + "Traceback:\n  File\n\n"
    )
    read = Logs()
    read.follow([(str(path), ("/arm/left", "/arm/right"))])
    read.read()
    assert [(r.node, LEVELS[r.level], r.text, r.is_more) for r in read.records] == [
        ("/arm/left", "INFO", "hello", True),
        ("/arm/left", "WARN", "line 1", False),
        ("/arm/right", "ERROR", "line 2", False),
        ("/arm/right", "ERROR", "Traceback:", True),
        ("/arm/right", "ERROR", "  File", True),
    ]
    assert (read.warnings, read.errors) == ({"/arm/left": 1}, {"/arm/right": 1})
    assert [record.text for record in read.last_error.values()] == ["line 2"]


def test_errors_are_kept(tmp_path: Path) -> None:
    """Errors are kept with their tracebacks, however many records follow."""
    path = tmp_path / "arm.log"
    path.write_text(line(1, "arm", "ERROR") + "Traceback\n" + "".join(line(i, "arm") for i in range(100)))
    read = Logs(bound=30)
    read.follow([(str(path), ("/arm",))])
    read.read()
    assert read.lost == 72
    assert [record.text for record in read.serious] == ["line 1", "Traceback"]


def test_several_files_are_merged_by_time(tmp_path: Path) -> None:
    """Records of several files are ordered by time."""
    for name, numbers in (("a", range(0, 10, 2)), ("b", range(1, 10, 2))):
        (tmp_path / f"{name}.log").write_text("".join(line(i, name) for i in numbers))
    read = Logs()
    read.follow([(str(tmp_path / f"{n}.log"), (f"/{n}",)) for n in "ab"])
    read.read()
    assert [r.text for r in read.records] == [f"line {i}" for i in range(10)]


def test_the_bound_and_what_is_new_since(tmp_path: Path) -> None:
    """A limited number of records is kept; `since` counts all ever added."""
    path = tmp_path / "talker.log"
    path.write_text("".join(line(i) for i in range(100)))
    read = Logs(bound=30)
    read.follow([(str(path), ("/talker",))])
    read.read()
    assert read.total == 100
    assert [r.text for r in read.since(95)] == [f"line {i}" for i in range(95, 100)]
    assert len(list(read.since(0))) == 30
    assert list(read.since(100)) == []


def test_a_file_that_is_emptied_or_gone(tmp_path: Path) -> None:
    """A truncated file is read from its beginning; a missing one is ignored."""
    path = tmp_path / "talker.log"
    path.write_text(line(1))
    read = Logs()
    read.follow([(str(path), ("/talker",)), (str(tmp_path / "none.log"), ("/none",))])
    assert read.read() == 1
    path.write_text("")
    assert read.read() == 0
    path.write_text(line(2))
    assert read.read() == 1


@pytest.mark.parametrize(
    ("text", "plain"),
    [
        ("\x1b[31mred\x1b[0m", "red"),
        ("a\x1b]0;title\x07b", "ab"),
        ("a\x1b]52;c;aGk=\x1b\\b", "ab"),
        ("bell\x07 back\x08", "bell back"),
        ("\x9b31mc1", "31mc1"),
        ("a\tb", "a   b"),
        ("Grüße ☃", "Grüße ☃"),
    ],
)
def test_nothing_that_a_terminal_obeys_is_left(text: str, plain: str) -> None:
    """Escape sequences, control characters and titles are removed."""
    assert plain_text(text) == plain


def test_a_line_without_end_is_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A line without an end does not grow in memory."""
    monkeypatch.setattr(log_feed, "AT_ONCE", 1000)
    path = tmp_path / "talker.log"
    path.write_text("x" * 100_000)
    file = LogFile(path, ("/talker",))
    found = [r for _ in range(200) for r in file.read()]
    assert found
    assert all(len(r.text) <= log_feed.LINE_BOUND for r in found)


def test_a_long_line_is_cut(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A line is cut at the limit."""
    monkeypatch.setattr(log_feed, "LINE_BOUND", 10)
    path = tmp_path / "talker.log"
    path.write_text("x" * 100 + "\n")
    assert [r.text for r in LogFile(path, ("/talker",)).read()] == ["x" * 10]
