"""The life of a context."""

from __future__ import annotations

import asyncio
import threading

import pytest

from graphflow.errors import GraphflowError, TransportError
from graphflow.rclpy import context_state as lives
from graphflow.rclpy.context_state import ContextState, parse_only_ros
from graphflow.rclpy.wake import Wake
from graphflow.runtime.context import Context


def test_only_what_follows_ros_args_is_for_ros() -> None:
    """The rest of a command line is the program's own, whatever it looks like."""
    args = parse_only_ros(["me.py", "-p", "no:cache", "--ros-args", "-p", "rate:=2", "--what", "--", "-r", "a:=b"])
    assert [(name, value) for _, name, value, _ in args.params] == [("rate", 2)]
    assert (args.remaps, args.unknown) == ([], ["--what"])
    with pytest.raises(GraphflowError):
        parse_only_ros(["--ros-args", "-r", "no-rule"])


def test_its_end_wakes_all_who_wait_for_it() -> None:
    """Once; those who come later at once, and those who have left not at all."""
    life, first, left, late = ContextState([], 3), Wake(), Wake(), Wake()
    life.on_end(first)
    life.on_end(left)
    life.forget(left)
    assert (life.end(), life.end()) == (True, False)
    life.on_end(late)
    assert (first.wait(0), left.wait(0), late.wait(0)) == (True, False, True)


def test_the_network_is_joined_when_it_is_needed_and_left_at_the_end() -> None:
    """Once, and in the life's own domain."""
    life = ContextState([], 7)
    network = life.network()
    assert life.network() is network
    assert network.domain == 7
    assert life.end_with_process in lives.LOOP.at_exit
    life.close()
    life.close()
    assert life.end_with_process not in lives.LOOP.at_exit


def test_leaving_is_waited_for_by_all_who_ask(monkeypatch: pytest.MonkeyPatch) -> None:
    """A process that ends meanwhile would end in the middle of it."""
    begun, may_end = threading.Event(), threading.Event()
    leave = ContextState._leave

    async def leave_slowly(context: Context) -> None:
        begun.set()
        await asyncio.to_thread(may_end.wait, 10)
        await leave(context)

    monkeypatch.setattr(ContextState, "_leave", staticmethod(leave_slowly))
    life = ContextState([], 7)
    life.network()
    closers = [threading.Thread(target=life.close) for _ in range(2)]
    closers[0].start()
    assert begun.wait(10)
    closers[1].start()
    closers[1].join(0.05)
    assert closers[1].is_alive()
    assert life.end_with_process in lives.LOOP.at_exit
    may_end.set()
    for closer in closers:
        closer.join(10)
        assert not closer.is_alive()
    assert life.end_with_process not in lives.LOOP.at_exit


def test_joining_is_tried_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where others find each other, somebody may just be leaving; for good it is not tried."""
    monkeypatch.undo()
    monkeypatch.setattr(lives, "ASK_AGAIN", (0.0, 0.0))
    tries = []

    async def refuse(domain: int) -> Context:
        tries.append(domain)
        raise TransportError("nobody answers")

    monkeypatch.setattr(Context, "open", refuse)
    with pytest.raises(TransportError, match="nobody answers"):
        ContextState([], 1).network()
    assert tries == [1, 1, 1]
