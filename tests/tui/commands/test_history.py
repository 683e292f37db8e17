"""Commands that outlive a console."""

from __future__ import annotations

import logging
import stat
from pathlib import Path

import pytest

from graphflow.tui.commands import history
from graphflow.tui.commands.history import History, history_file, without_program


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "state" / "history"


def test_they_are_kept(file: Path) -> None:
    """Commands are kept in order without the program's name, repetitions once, readable by the user only."""
    first = History(file)
    for line in ("ps", "ps", "graphflow topic list", "ros2 node list", "", "two\nlines"):
        first.add(line)
    assert first.lines == ["ps", "topic list", "node list"]
    assert not History(file.parent / "none").lines
    first.add("topic pub /x String '{data: a\u2028b\x0bc}'")
    assert History(file).lines == first.lines
    assert stat.S_IMODE(file.stat().st_mode) == 0o600


def test_two_consoles_keep_one_file(file: Path) -> None:
    """Neither console loses commands of the other."""
    one, other = History(file), History(file)
    one.add("ps")
    other.add("top")
    one.add("doctor")
    assert History(file).lines == ["ps", "top", "doctor"]


def test_the_file_does_not_grow_for_ever(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file of four times the limit is trimmed to the limit."""
    monkeypatch.setattr(history, "KEPT", 3)
    monkeypatch.setattr(history, "LONGEST", 20)
    grows = History(file)
    for i in range(13):
        grows.add(f"echo {i}")
    grows.add("echo " + "x" * 20)
    assert grows.lines == ["echo 10", "echo 11", "echo 12"]
    assert len(file.read_text().splitlines()) == 13
    assert History(file).lines == ["echo 10", "echo 11", "echo 12"]
    assert file.read_text() == "echo 10\necho 11\necho 12\n"
    assert [*file.parent.iterdir()] == [file]


def test_a_folder_that_cannot_be_written(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    """Commands are kept until the console ends, and the log gives the reason."""
    (tmp_path / "taken").write_text("")
    lost = History(tmp_path / "taken" / "history")
    with caplog.at_level(logging.WARNING):
        lost.add("ps")
        lost.add("top")
    assert lost.lines == ["ps", "top"]
    assert [r.getMessage().partition(":")[0] for r in caplog.records] == [
        "commands of earlier consoles cannot be read",
        "commands are forgotten with this console",
    ]


def test_requests() -> None:
    """Requests of one service are found; commands with errors are skipped."""
    past = History()
    call = ("service", "call", "/add", "example_interfaces/srv/AddTwoInts")
    for line in (
        "service call /add example_interfaces/srv/AddTwoInts '{a: 1}'",
        "service call /add example_interfaces/srv/AddTwoInts",
        "service call /add example_interfaces/srv/AddTwoInts '{a: 1",
        "service call /add example_interfaces/srv/AddTwoInts '{a: 1'",
        "service call /add example_interfaces/srv/AddTwoInts 1",
        "service call /other example_interfaces/srv/AddTwoInts '{a: 2}'",
        """service call /add example_interfaces/srv/AddTwoInts '{b: "it'"'"'s"}'""",
    ):
        past.add(line)
    assert past.requests(*call) == [{"a": 1}, {"b": "it's"}]


@pytest.mark.parametrize("line", ["graphflow ps", " gf  ps ", "ros2 ps", "ps"])
def test_the_name_of_the_program_is_left_out(line: str) -> None:
    """The name is removed in all its forms."""
    assert without_program(line) == "ps"
    assert without_program("ros2bag") == "ros2bag"


def test_the_file_is_among_what_is_kept_for_the_user(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """No graph can have the file's name, which is beside the graphs' logs."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    assert history_file() == tmp_path / "graphflow" / ".history"
