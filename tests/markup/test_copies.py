"""Copies of files in which substitutions have been made."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.markup.copies import copy_of


def test_what_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One file for each content, with nothing beside it."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    first, again, other = copy_of("é", "p.yaml"), copy_of("é", "p.yaml"), copy_of("b", "p.yaml")
    assert (first == again, first == other) == (True, False)
    assert (first.read_text(encoding="utf-8"), list(first.parent.iterdir())) == ("é", [first])
