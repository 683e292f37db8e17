"""The contents of several files as one."""

from __future__ import annotations

from graphflow.bag.contents import Contents, together
from tests.bag.cast import CHATTER, COUNT


def test_together() -> None:
    """Messages are added up; files without any have no time."""
    one = Contents({"/chatter": CHATTER}, {"/chatter": 3}, 100, 200)
    two = Contents({"/chatter": CHATTER, "/count": COUNT}, {"/chatter": 2, "/count": 1}, 50, 150, is_whole=False)
    none = Contents({"/count": COUNT}, {"/count": 0}, 0, 0)
    assert together([one, none, two]) == Contents(
        {"/chatter": CHATTER, "/count": COUNT}, {"/chatter": 5, "/count": 1}, 50, 200, is_whole=False
    )
    assert together([one, none]).is_whole
    assert together([]) == Contents({}, {}, 0, 0)
    assert together([one, two]).message_count == 6
