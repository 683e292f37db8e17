"""Bags beside a path that is none."""

from __future__ import annotations

from pathlib import Path

from graphflow.bag.nearby import suggestion


def test_what_is_beside(tmp_path: Path) -> None:
    """A near name, a file without its ending, or all where they are few."""
    assert suggestion(tmp_path / "nothing" / "bag") == suggestion(tmp_path / "bag") == ""
    (tmp_path / "walk").mkdir()
    (tmp_path / "walk" / "metadata.yaml").touch()
    (tmp_path / "walk" / "walk_0.mcap").touch()
    (tmp_path / "walking.txt").touch()
    assert suggestion(tmp_path / "wlk") == f"; did you mean {str(tmp_path / 'walk')!r}?"
    assert suggestion(tmp_path / "walk.bag") == f"; did you mean {str(tmp_path / 'walk')!r}?"
    assert suggestion(tmp_path / "walk" / "walk_0") == f"; did you mean {str(tmp_path / 'walk' / 'walk_0.mcap')!r}?"
    assert suggestion(tmp_path / "zzz") == f"; there is {tmp_path / 'walk'}"
