"""The choice among topics."""

from __future__ import annotations

from graphflow.tui.views.robot.topics import next_of, topics_of


def test_the_next() -> None:
    """After the last comes the first; one that is gone is followed by the first."""
    assert [next_of(["a", "b"], topic) for topic in ("a", "b", "c")] == ["b", "a", "a"]
    assert next_of([], "a") == "a"
    assert topics_of(None, "x") == []
