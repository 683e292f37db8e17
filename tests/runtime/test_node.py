"""A node's names, its parameters, and its `create_*` methods."""

from __future__ import annotations

import asyncio
import threading
from typing import Any

import pytest

from graphflow import DeclarationError, Node, ParameterError
from graphflow.errors import InvalidName
from graphflow.msgs.std_msgs.msg import String
from graphflow.names import Remap
from graphflow.runtime.context import OFFLOAD_LIMIT
from graphflow.testing import Graph
from graphflow.testing.clock import settle
from graphflow.wire.liveliness import Kind
from tests.runtime.cast import Talker


@pytest.mark.parametrize(
    ("given", "full", "chatter", "private"),
    [
        ({}, "/talker", "/chatter", "/talker/private"),
        ({"name": "bob"}, "/bob", "/chatter", "/bob/private"),
        ({"namespace": "/a/b"}, "/a/b/talker", "/a/b/chatter", "/a/b/talker/private"),
        ({"namespace": "a"}, "/a/talker", "/a/chatter", "/a/talker/private"),
        ({"remap": ["__node:=eve", "__ns:=/c"]}, "/c/eve", "/c/chatter", "/c/eve/private"),
        ({"remap": ["chatter:=news"], "namespace": "/a"}, "/a/talker", "/a/news", "/a/talker/private"),
        ({"remap": ["/chatter:=/x/y"]}, "/talker", "/x/y", "/talker/private"),
        ({"remap": [Remap("chatter", "~/mine")]}, "/talker", "/talker/mine", "/talker/private"),
        ({"remap": ["~/private:=open"]}, "/talker", "/chatter", "/open"),
        ({"remap": ["talker:chatter:=news"]}, "/talker", "/news", "/talker/private"),
        ({"remap": ["rostopic://chatter:=news"]}, "/talker", "/news", "/talker/private"),
    ],
)
def test_names_are_resolved(given: dict[str, Any], full: str, chatter: str, private: str) -> None:
    """Namespace, node name and remaps give every endpoint its full name; an absolute one stays."""
    node = Talker(**given)

    assert node.full_name == full
    assert node.chatter.name == chatter
    assert node.private.name == private
    assert node.absolute.name == "/absolute"


def test_services_are_remapped_too() -> None:
    """A rule for one kind of name leaves the other alone."""
    assert Talker(remap=["add:=sum"]).adder.name == "/sum"
    assert Talker(remap=["rosservice://add:=sum"]).adder.name == "/sum"
    assert Talker(remap=["rostopic://add:=sum"]).adder.name == "/add"


@pytest.mark.parametrize("given", [{"name": "a/b"}, {"name": "1"}, {"namespace": "/a//b"}, {"remap": ["a:="]}])
def test_wrong_names_are_refused(given: dict[str, Any]) -> None:
    """A node is not made with a name that no ROS 2 node may have."""
    with pytest.raises(InvalidName):
        Talker(**given)


async def test_a_running_node_announces_its_names(graph: Graph) -> None:
    """The graph shows the node and every endpoint by full name, and none of them after the stop."""
    node = Talker(namespace="/a", remap=["chatter:=/news"], start_parameter_services=False)
    await graph.start(node)
    cache = node.context.cache

    assert cache.nodes() == ["/a/talker"]
    assert [e.name for e in cache.endpoints(Kind.PUBLISHER)] == [
        "/a/talker/private",
        "/absolute",
        "/news",
        "/rosout",
    ]
    assert [e.name for e in cache.endpoints(Kind.CLIENT)] == ["/a/add"]
    assert repr(node) == "<Talker /a/talker running>"

    await graph.stop(node)

    assert graph.network.tokens == {}
    assert repr(node) == "<Talker /a/talker>"
    assert not node.is_running


def test_values_from_outside() -> None:
    """By keyword, or by name with a source; the direct value takes precedence."""
    assert Talker(rate=2).rate == 2.0
    node = Talker(overrides={"rate": (3, "graph.yaml:7")})
    assert node.rate == 3.0
    assert node.parameters.source("rate") == "graph.yaml:7"
    assert Talker(overrides={"rate": (3, "graph.yaml:7")}, rate=4).rate == 4.0


def test_a_wrong_value_is_refused_when_the_node_is_made() -> None:
    """With the place where it was written."""
    with pytest.raises(ParameterError, match=r"'rate' = 0.0 is out of range: more than 0 \(from graph.yaml:7\)"):
        Talker(overrides={"rate": (0, "graph.yaml:7")})


def test_what_was_declared_at_run_time_can_be_undeclared() -> None:
    """By the node itself; a read-only one stays."""
    node = Node("n")
    node.declare_parameter("fixed", True, read_only=True)
    node.declare_parameter("wheel", 0.1)
    node.undeclare_parameter("wheel")
    assert "wheel" not in node.parameters
    with pytest.raises(ParameterError, match="read-only"):
        node.undeclare_parameter("fixed")
    with pytest.raises(ParameterError, match="no parameter 'wheel'"):
        node.undeclare_parameter("wheel")


async def test_a_node_that_did_not_call_its_parent(graph: Graph) -> None:
    """The error names the missing `super().__init__()`."""

    class Forgetful(Node):
        def __init__(self) -> None:
            self.x = 1

    with pytest.raises(
        DeclarationError, match=r"Forgetful\.__init__ \(test_node\.py:\d+\) must call super\(\)\.__init__"
    ):
        await graph.start(Forgetful())


async def test_what_is_created_while_it_runs_is_open_at_once(graph: Graph) -> None:
    """With remaps applied, as for declarations."""
    node = Talker(remap=["late:=later"])
    await graph.start(node)
    heard = graph.tap(String, "/later")
    node.create_publisher(String, "late").publish(String(data="x"))
    await graph.settle()

    assert [m.data for m in heard] == ["x"]


async def test_work_in_a_thread(graph: Graph) -> None:
    """`offload` returns the function's result or raises its error, and the loop is free."""
    node = Talker()
    await graph.start(node)

    assert await node.offload(pow, 2, 10) == 1024
    assert await node.offload(threading.get_ident) != threading.get_ident()
    with pytest.raises(ZeroDivisionError):
        await node.offload(divmod, 1, 0)


async def test_work_in_threads_is_limited(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """A call that waits for a thread is logged, and proceeds when another has ended."""
    node, gate = Talker(), threading.Event()
    graph.waits_outside = False
    await graph.start(node)
    async with asyncio.TaskGroup() as group:
        works = [group.create_task(node.offload(gate.wait)) for _ in range(OFFLOAD_LIMIT + 1)]
        await settle()
        assert "offload: wait waits, since 32 offloaded functions are running" in caplog.text
        gate.set()
    assert [work.result() for work in works] == [True] * len(works)


async def test_work_that_nobody_waits_for_counts_as_long_as_it_runs(graph: Graph) -> None:
    """The limit is one of threads, which a cancelled caller does not end."""
    node, gate, inside = Talker(), threading.Event(), list[int]()
    await graph.start(node)

    def work() -> None:
        inside.append(1)
        gate.wait()

    callers = [asyncio.create_task(node.offload(work)) for _ in range(OFFLOAD_LIMIT)]
    while len(inside) < OFFLOAD_LIMIT:
        await asyncio.sleep(0)
    for caller in callers:
        caller.cancel()
    await asyncio.gather(*callers, return_exceptions=True)
    late = asyncio.create_task(node.offload(work))
    await settle()
    assert len(inside) == OFFLOAD_LIMIT
    gate.set()
    await late
    assert len(inside) == OFFLOAD_LIMIT + 1
