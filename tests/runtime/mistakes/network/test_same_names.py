"""Other nodes of this process's names."""

from __future__ import annotations

import asyncio
import os

import pytest

from graphflow import Context, Node, service
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.runtime.mistakes.network import same_names
from graphflow.runtime.mistakes.network.same_names import WARN_AFTER
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from graphflow.transport.config import CONNECT_VARIABLE
from graphflow.wire import process

Caplog = pytest.LogCaptureFixture


def told(caplog: Caplog) -> list[str]:
    return [record.getMessage() for record in caplog.records if record.getMessage().startswith("another node")]


async def test_two_nodes_of_one_process(graph: Graph, caplog: Caplog) -> None:
    """They are reported once, however many follow."""
    context = Context(graph.network.session(asyncio.get_running_loop()), clock=graph.clock)
    nodes = [Node(name) for name in ("twin", "twin", "other", "_hidden", "_hidden", "twin")]
    for node in nodes:
        await core_of(node).start(context)
        await graph.clock.advance(WARN_AFTER)
    assert told(caplog) == [
        "another node is called /twin, in this process, too: parameters, services and tools reach one of them by "
        "chance; rename one"
    ]
    for node in nodes:
        await core_of(node).stop()
    await context.close()


async def run_two(graph: Graph) -> None:
    """Nodes of one name in two processes, of which the other has a token."""
    await graph.start(Node("twin"))
    elsewhere = Context(graph.network.session(asyncio.get_running_loop()), clock=graph.clock)
    elsewhere.session.announce(process.token(elsewhere.domain, elsewhere.session.zid))
    twin = Node("twin")
    await core_of(twin).start(elsewhere)
    await graph.clock.advance(WARN_AFTER)
    await core_of(twin).stop()
    await elsewhere.close()


async def test_two_nodes_of_two_processes(graph: Graph, caplog: Caplog) -> None:
    """Both report it, with the other's process if its token is known."""
    await run_two(graph)
    first, second = sorted(told(caplog))
    assert first.startswith(f"another node is called /twin, in process {os.getpid()} (")
    assert first.endswith(
        "reach one of them by chance; rename one: --ros-args -r __node:=NAME, or name='NAME' in a launch file"
    )
    assert "in session " in second
    assert ", no graphflow process: parameters" in second


async def test_a_node_on_another_machine(graph: Graph, caplog: Caplog, monkeypatch: pytest.MonkeyPatch) -> None:
    """With a link to others, its process may be there."""
    monkeypatch.setenv(CONNECT_VARIABLE, "tcp/10.0.0.2:7447")
    await run_two(graph)
    _, second = sorted(told(caplog))
    assert ", no graphflow process, or on another machine: parameters" in second


async def test_a_node_that_is_restarted(graph: Graph, caplog: Caplog) -> None:
    """Is no twin of the one that is just leaving; one that comes later is."""
    first = Node("twin")
    await graph.start(first)
    await graph.start(Node("twin"))
    await graph.stop(first)
    await graph.clock.advance(WARN_AFTER)
    assert told(caplog) == []
    await graph.start(Node("twin"))
    await graph.clock.advance(WARN_AFTER)
    assert len(told(caplog)) == 2  # by both


async def test_too_many_processes(graph: Graph, caplog: Caplog, monkeypatch: pytest.MonkeyPatch) -> None:
    """The number of tracked processes is limited; others are reported by session."""
    monkeypatch.setattr(same_names, "PROCESSES_BOUND", 0)
    await run_two(graph)
    assert [" in session " in text for text in told(caplog)] == [True, True]


class Goer(Node):
    """A node with two services."""

    @service(Empty, "go")
    async def go(self, request: Empty.Request) -> None:
        """Do nothing."""

    @service(Empty, "stay")
    async def stay(self, request: Empty.Request) -> None:
        """Do nothing."""


async def test_services_of_two_nodes(graph: Graph, caplog: Caplog) -> None:
    """Both report them once and together, unless one of the nodes is just leaving."""
    first = Goer("first")
    await graph.start(first)
    await graph.start(Goer("second"))
    await graph.stop(first)
    await graph.clock.advance(WARN_AFTER)
    assert caplog.messages == []
    await graph.start(third := Goer("third"))
    await graph.clock.advance(WARN_AFTER)
    [told, _] = caplog.messages  # in the logs of both
    assert told == (
        "/go, /stay are offered by /second and /third: each call reaches all of them; move one: --ros-args -r "
        "__ns:=/NAMESPACE"
    )
    await graph.stop(third)
    await graph.start(Goer("third"))
    await graph.clock.advance(WARN_AFTER)
    assert caplog.messages == [told] * 3  # in the new one's


async def test_many_nodes_of_one_service(graph: Graph, caplog: Caplog) -> None:
    """They are reported once, without naming all: other processes may create any number."""
    await graph.start(Goer("first"))
    for number in range(6):
        await graph.start(Goer(f"other{number}"))
    await graph.clock.advance(WARN_AFTER)
    mine = {text for text in caplog.messages if text.startswith("/go")}
    assert len(mine) == 1
    assert "/first, /other0, /other1, /other2 and 3 more: each call" in mine.pop()

    caplog.clear()
    await graph.start(Goer("late"))
    await graph.clock.advance(WARN_AFTER)
    [told] = caplog.messages  # in the new one's log alone
    assert "and 4 more" in told


async def test_a_process_that_ends(graph: Graph, caplog: Caplog) -> None:
    """It stops reporting, since it does not see the other leave."""
    await graph.start(Goer("twin"))
    elsewhere = Context(graph.network.session(asyncio.get_running_loop()), clock=graph.clock)
    nodes = [Goer("twin"), Goer("second")]
    for node in nodes:
        await core_of(node).start(elsewhere)
    await graph.settle()
    elsewhere.twins.close()
    await graph.clock.advance(WARN_AFTER)
    kinds = [text.partition(" ")[0] for text in caplog.messages]
    assert sorted(kinds) == ["/go,", "another"]  # in the log of the process that goes on
    for node in nodes:
        await core_of(node).stop()
    await elsewhere.close()
