"""Files that are found: which are read, and how much of them."""

from __future__ import annotations

import ast
import os
from pathlib import Path

import pytest

from graphflow.reading import found_bytes, found_text, lenient_text, parsed, why_no_file
from tests.parser import disturb

pytestmark = pytest.mark.timeout(20)


def test_a_regular_file(tmp_path: Path) -> None:
    """Is read as `open` would read it, also through a link; a byte order mark is no part of the text."""
    file, link = tmp_path / "package.xml", tmp_path / "link"
    file.write_bytes(b"<name>\r\nl\xc3\xa4mp</name>\r")
    link.symlink_to(file)
    assert found_bytes(file) == file.read_bytes()
    assert found_text(link) == file.read_text(encoding="utf-8") == "<name>\nlämp</name>\n"
    file.write_bytes(b"\xef\xbb\xbfimport rclpy\n")
    assert found_text(file) == found_text(file, "replace") == "import rclpy\n"
    file.write_bytes(b"\xff")
    assert found_text(file, "replace") == "\ufffd"
    with pytest.raises(UnicodeDecodeError):
        found_text(file)


def test_what_would_keep_its_reader_waiting(tmp_path: Path) -> None:
    """Is no regular file, and refused with its name before it is opened."""
    fifo, device = tmp_path / "package.xml", tmp_path / "setup.py"
    os.mkfifo(fifo)
    device.symlink_to("/dev/zero")
    for file in (fifo, device):
        with pytest.raises(OSError, match="it is not a regular file") as caught:
            found_bytes(file)
        assert caught.value.filename == str(file)
    with pytest.raises(IsADirectoryError):
        found_bytes(tmp_path)
    with pytest.raises(FileNotFoundError):
        found_bytes(tmp_path / "none")


def test_a_file_of_great_size(tmp_path: Path) -> None:
    """Is not read to its end."""
    file = tmp_path / "setup.py"
    file.touch()
    os.truncate(file, 1 << 40)
    with pytest.raises(OSError, match="it has more than 10,000,000 bytes"):
        found_bytes(file)
    os.truncate(file, 5)
    assert found_bytes(file, 5) == bytes(5)
    with pytest.raises(OSError, match="more than 4 bytes"):
        found_bytes(file, 4)


def test_another_file_is_not_even_opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Opening a device may have effects; and what takes a file's place in between is refused, too."""
    fifo, file = tmp_path / "fifo", tmp_path / "file"
    os.mkfifo(fifo)
    file.touch()
    real = os.open
    monkeypatch.setattr(os, "open", lambda *_: pytest.fail("it was opened"))
    with pytest.raises(OSError, match="it is not a regular file"):
        found_bytes(fifo)
    monkeypatch.setattr(os, "open", lambda _, flags: real(fifo, flags))
    with pytest.raises(OSError, match="it is not a regular file"):
        found_bytes(file)


def test_why_there_is_no_file(tmp_path: Path) -> None:
    """A FIFO is there, and what is not there gets the sentence of its kind."""
    fifo = tmp_path / "bag.mcap"
    os.mkfifo(fifo)
    assert why_no_file(fifo) == "it is not a regular file"
    assert why_no_file(tmp_path / "other", "there is no bag") == "there is no bag"
    assert why_no_file(tmp_path) == "there is no such file"


def test_a_file_that_may_be_anything(tmp_path: Path) -> None:
    """Its text, with other bytes replaced; nothing of one that is not there, or is too large."""
    file = tmp_path / "any"
    assert lenient_text(file) == lenient_text(tmp_path) == ""
    file.write_bytes(b"a\xff\r\n")
    assert lenient_text(file) == "a\ufffd\n"
    assert lenient_text(file, 2) == ""


@pytest.mark.parametrize(("failures", "is_parsed"), [(4, True), (5, False)])
def test_a_parser_that_other_threads_disturb(monkeypatch: pytest.MonkeyPatch, failures: int, is_parsed: bool) -> None:
    """It is asked again, a few times."""
    disturb(monkeypatch, failures)
    if is_parsed:
        assert ast.unparse(parsed("a = 1")) == "a = 1"
    else:
        with pytest.raises(ValueError, match="other threads keep Python's parser busy"):
            parsed("a = 1")
