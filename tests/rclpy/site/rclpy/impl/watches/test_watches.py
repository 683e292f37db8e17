"""The watches over a context's nodes."""

from __future__ import annotations

import pytest

from rclpy.impl.deadlock import waiting
from rclpy.impl.watches import starvation
from rclpy.impl.watches.watches import Watches
from rclpy.node import Node
from tests.until import until


def test_they_look_and_keep_what_still_holds(node: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    """All are asked again and again, on the loop; reports that are over are dropped."""
    monkeypatch.setattr(starvation, "WARN_AFTER", 0.05)
    monkeypatch.setattr(waiting, "LOOK_EVERY", 0.02)
    life = node.context.life
    assert life is not None
    watches: Watches = life.network().elsewhere[0].watches  # type: ignore[attr-defined]
    assert watches.texts == []
    timer = node.create_timer(0.01, lambda: None)
    [text] = until(lambda: watches.texts)
    assert text.startswith("/node has not been spun for ")
    timer.cancel()
    node.destroy_node()
    until(lambda: watches.texts == [])
