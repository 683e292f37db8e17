"""The tree that view_frames draws."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tf2_py import BufferCore
from tf2_py.core import message

from graphflow.tf.poses import IDENTITY

S = 10**9


def test_frames_are_drawn_below_their_parents(program: Callable[[str], Any]) -> None:
    """In the terminal and for Graphviz; names are quoted there."""
    buffer = BufferCore()
    buffer.set_transform_static(message(IDENTITY, "map", 'a "b"', 0))
    for i in range(5):
        buffer.set_transform(message(IDENTITY, "map", "odom", i * S))
        buffer.set_transform(message(IDENTITY, "odom", "base", i * S))
    buffer.set_transform_static(message(IDENTITY, "world", "moon", 0))
    view = program("tf2_tools/view_frames")
    known = view["frames"](buffer.all_frames_as_yaml())
    assert view["drawn"](known).splitlines() == [
        "map",
        '├── a "b"   (static)',
        "└── odom   (1.0 Hz, over 4.0 s)",
        "    └── base   (1.0 Hz, over 4.0 s)",
        "world",
        "└── moon   (static)",
    ]
    assert '"map" -> "a \\"b\\"" [label="static"];\n' in view["graphviz"](known)
    assert view["frames"](BufferCore().all_frames_as_yaml()) == []
