"""Buffers of transforms that nothing fills."""

from __future__ import annotations

import pytest
from tf2_ros import Buffer, LookupException, TransformListener

from rclpy.impl.watches import unfilled
from rclpy.node import Node
from rclpy.time import Time
from tests.rclpy.conftest import Spinner

REMARK = "nothing fills this Buffer; write in __init__ self.listener = TransformListener({}, self)"


class Asks:
    """Code that asks one."""

    def __init__(self) -> None:
        self.tf = Buffer()

    def can(self) -> bool:
        return bool(self.tf.can_transform("odom", "base", Time()))


@pytest.fixture(autouse=True)
def alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Other tests of the run fill buffers themselves."""
    monkeypatch.setattr(unfilled, "_users_files", lambda: [__file__])


def told(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [record.getMessage() for record in caplog.records if "nothing fills" in record.getMessage()]


def test_it_is_told_once(caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch) -> None:
    """A while after the first question, with its line and what to write, and in a note of the error."""
    asks = Asks()
    assert not asks.can()
    assert told(caplog) == []
    monkeypatch.setattr(unfilled, "WARN_AFTER", 0.0)
    for _ in range(2):
        assert not asks.can()
    line = Asks.can.__code__.co_firstlineno + 1
    assert told(caplog) == [f"test_unfilled.py:{line}: {REMARK.format('self.tf')}"]
    with pytest.raises(LookupException, match=r"does not exist. ") as caught:
        asks.tf.lookup_transform("odom", "base", Time())
    assert caught.value.__notes__ == [f"note: {REMARK.format('self.tf')}"]


def test_buffers_that_are_filled(node: Node, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch) -> None:
    """By a listener, or perhaps by code of the program's, which may have had nothing to put in yet."""
    monkeypatch.setattr(unfilled, "WARN_AFTER", 0.0)
    listened, own = Asks(), Asks()
    TransformListener(listened.tf, node)
    assert not listened.can()
    monkeypatch.setattr(unfilled, "_names_a_filler", lambda _: True)
    assert not own.can()
    monkeypatch.undo()
    assert own.tf._graphflow.remark == ""
    assert told(caplog) == []


def test_a_new_one_in_each_call(node: Node, spin: Spinner, caplog: pytest.LogCaptureFixture) -> None:
    """It is told once, at the second; one that a program makes beside its callbacks is its own affair."""
    made: list[Buffer] = []

    told_at: list[int] = []

    def tick() -> None:
        made.append(Buffer())
        told_at.append(len(caplog.messages))

    tick()
    tick()
    assert caplog.messages == []
    node.create_timer(0.01, tick)
    spin(lambda: len(made) > 5)
    assert told_at[:4] == [0, 0, 0, 1]  # two calls were made above
    line = tick.__code__.co_firstlineno + 1
    assert caplog.messages == [
        f"test_unfilled.py:{line}: each call creates a new Buffer, which holds no transforms yet: create it and its "
        "TransformListener in __init__, and keep both in attributes"
    ]
