"""Streams of output: data on stdout, messages to the user on stderr."""

from __future__ import annotations

import json
import sys

import numpy as np
import pytest

from graphflow.cli import output


def test_data_goes_to_stdout(capsys: pytest.CaptureFixture[str]) -> None:
    """A line for each, and nothing on stderr."""
    output.data("a")
    output.lines(["b", "c"])
    output.lines([])
    assert capsys.readouterr() == ("a\nb\nc\n", "")


def test_talk_goes_to_stderr(capsys: pytest.CaptureFixture[str]) -> None:
    """An error is marked as one, once."""
    output.talk("by the way")
    output.error("too late")
    output.error("error: too late")
    assert capsys.readouterr() == ("", "by the way\nerror: too late\nerror: too late\n")


def test_json_of_what_json_does_not_know(capsys: pytest.CaptureFixture[str]) -> None:
    """Arrays and bytes are lists of numbers, anything else is its text; all on one line."""
    output.as_json({"array": np.array([1.5, 2.0]), "bytes": b"\x01\xff", "error": ValueError("no")})
    out, err = capsys.readouterr()
    assert (out.count("\n"), err) == (1, "")
    assert json.loads(out) == {"array": [1.5, 2.0], "bytes": [1, 255], "error": "no"}


def test_no_foreign_text_commands_the_terminal(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every way of printing escapes foreign control characters; colours are graphflow's own."""
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    bad, shown = "a\x1b[31m\x07", "a\\x1b[31m\\x07"
    output.data(bad)
    output.lines([bad])
    output.colored(bad, 32, [bad])
    output.talk(bad)
    output.progress(bad)
    out, err = capsys.readouterr()
    assert out == f"{shown}\n{shown}\n\x1b[32m{shown}\x1b[0ma\\x07\n"
    assert err == f"{shown}\n\r\x1b[2K{shown}"
