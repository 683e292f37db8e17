"""Commands that take part in the graph for a while."""

from __future__ import annotations

import asyncio
import os
import signal
from collections.abc import Iterator
from unittest.mock import patch

import pytest

from graphflow import Node
from graphflow.cli.temporary_node import run_with_node
from tests.conftest import Machine

pytestmark = pytest.mark.real


@pytest.fixture(autouse=True)
def _here(standing: Machine) -> Iterator[None]:
    """This process is where the standing graph is; its handlers of signals are as they were afterwards."""
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    with patch.dict(os.environ, standing.env, clear=True):
        yield
    for number, handler in handlers.items():
        signal.signal(number, handler)


def test_what_the_work_returns_is_the_exit_code() -> None:
    """The work's result is the exit code; its node is up, hidden, and without parameters and /rosout."""
    name, seen = f"/_graphflow_{os.getpid()}", set[str]()

    async def work(node: Node) -> int:
        cache = node.context.cache
        await node.context.wait_for(
            lambda: "/talker" in cache.nodes() and any(e.name == f"{name}/get_logger_levels" for e in cache)
        )
        seen.update(e.name for e in cache if e.node_name == name)
        return 4

    assert run_with_node(work) == 4
    assert seen & {"/rosout", f"{name}/get_parameters"} == set()
    assert f"{name}/get_logger_levels" in seen


def test_a_name_may_be_given() -> None:
    """A node can have a name, as with `topic pub --node-name`."""

    async def work(node: Node) -> int:
        return int(node.full_name == "/visitor")

    assert run_with_node(work, "visitor") == 1


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_with_0(number: signal.Signals) -> None:
    """The work is cancelled, may clean up, and has not failed."""
    ended = []

    async def work(node: Node) -> int:
        signal.raise_signal(number)
        try:
            await asyncio.Event().wait()
        finally:
            ended.append("cleaned up")
        raise AssertionError("it was not cancelled")

    assert run_with_node(work) == 0
    assert ended == ["cleaned up"]


def test_work_that_ends_well_when_it_is_stopped_says_how() -> None:
    """A result that comes after the signal counts."""

    async def work(node: Node) -> int:
        signal.raise_signal(signal.SIGINT)
        try:
            await asyncio.Event().wait()
        except asyncio.CancelledError:
            return 3
        raise AssertionError("it was not cancelled")

    assert run_with_node(work) == 3


def test_an_error_of_the_work_is_raised_and_the_node_is_gone(standing: Machine) -> None:
    """Nothing is left behind that others would see."""

    async def work(node: Node) -> int:
        standing.until(lambda: "/visitor" in standing.look("node", "list"), "it is announced")
        raise LookupError("no such thing")

    with pytest.raises(LookupError, match="no such thing"):
        run_with_node(work, "visitor")
    assert "/visitor" not in standing.look("node", "list")


def test_late_imports_are_nobodys_business() -> None:
    """The watchdog is off: a verb's late imports may block its own loop."""

    async def work(node: Node) -> int:
        return int(node.context.search.watchdog.is_closed)

    assert run_with_node(work) == 1


def test_what_goes_wrong_is_told_plainly(capsys: pytest.CaptureFixture[str]) -> None:
    """Warnings are printed as messages of the command, once, and without control characters."""

    async def work(node: Node) -> int:
        node.log.warning("beware of %s", "\x1b[2Jothers")
        node.log.info("this is nobody's business")
        return 0

    for _ in range(2):
        assert run_with_node(work) == 0
        told = capsys.readouterr().err
        assert told.count("beware of ") == 1
        assert "\x1b" not in told
        assert "nobody" not in told
