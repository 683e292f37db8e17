"""Logs that stay of bounded size, and disks that are full."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from graphflow.cli.graphs.streaming import LogReader
from graphflow.supervisor import logfile

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="an open file cannot be put aside there")

WRITER = """
import sys
from graphflow.supervisor import logfile
logfile.LIMIT = 10_000
told = []
logfile.write_to(sys.argv[1], told.append)
{body}
sys.stdout.flush()
import os
os.write(2, b"".join(t.encode() + b"|" for t in told))
"""


def write(path: Path | str, body: str) -> None:
    """Run a program whose output goes to a log."""
    fd = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
    code = WRITER.format(body=body)
    subprocess.run([sys.executable, "-c", code, str(path)], stdout=fd, stderr=fd, check=True, timeout=60.0)
    os.close(fd)


def test_a_log_is_put_aside_when_it_is_long(tmp_path: Path) -> None:
    """Two files have the last of it, without a gap; standard error and what C writes go the same way."""
    path = tmp_path / "a.log"
    write(path, "for i in range(3000): print('line', i, file=(sys.stdout, sys.stderr)[i % 2])")
    older, newer = (tmp_path / "a.log.1").read_text(), path.read_text()
    assert len(older) < 13_000
    numbers = [int(line.split()[1]) for line in (older + newer).splitlines()]
    assert numbers == list(range(numbers[0], 3000))


def test_a_short_log_stays(tmp_path: Path) -> None:
    """In one file; characters that have no bytes do no harm."""
    path = tmp_path / "a.log"
    write(path, "print('gr\\u00fc\\u00df', '\\ud800')")
    assert path.read_text() == "grüß \\ud800\n"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no full disk to try")
def test_a_full_disk_costs_lines_and_not_the_program(capfd: pytest.CaptureFixture[str]) -> None:
    """It is told once; the program goes on."""
    told: list[str] = []
    file = logfile.LogFile("/dev/full", told.append)
    kept = os.dup(1)
    full = os.open("/dev/full", os.O_WRONLY)
    try:
        os.dup2(full, 1)
        assert [file.write(b"abc"), file.write(b"de")] == [3, 2]
        os.dup2(kept, 1)
        assert file.write(b"room\n") == 5
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(full)
    assert told == ["No space left on device"]
    assert capfd.readouterr().out == "(5 bytes could not be written here)\nroom\n"


def test_who_follows_a_log_misses_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Lines that were not read before the rotation are read from the old file."""
    path = tmp_path / "a.log"
    reader = LogReader([path], width=1)
    path.write_text("1\n2\n")
    reader.show()
    with path.open("a") as file:
        file.write("3\nfo")
    path.rename(tmp_path / "a.log.1")
    path.write_text("ur\n")
    reader.show()
    assert capsys.readouterr().out.split("\n") == ["a | 1", "a | 2", "a | 3", "a | four", ""]
