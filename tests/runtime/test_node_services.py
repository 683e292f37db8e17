"""Type descriptions and logger levels."""

from __future__ import annotations

import logging
from typing import Any

import pytest

from graphflow import LifecycleNode, Node
from graphflow.interface import COMMON_SERVICES, LIFECYCLE_SERVICES
from graphflow.msgs import registry
from graphflow.msgs.geometry_msgs.msg import PoseStamped
from graphflow.msgs.rcl_interfaces.msg import LoggerLevel
from graphflow.msgs.rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels
from graphflow.msgs.type_description_interfaces.msg import TypeDescription
from graphflow.msgs.type_description_interfaces.srv import GetTypeDescription
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from graphflow.wire import typehash
from graphflow.wire.liveliness import Kind
from tests.cases import slow
from tests.runtime.cast import Adder


async def describe(graph: Graph, node: str, name: str, hash_: str = "") -> Any:
    request = GetTypeDescription.Request(type_name=name, type_hash=hash_, include_type_sources=True)
    return await graph.call(GetTypeDescription, f"{node}/get_type_description", request)


@slow
@pytest.mark.parametrize("name", ["geometry_msgs/msg/PoseStamped", "example_interfaces/srv/AddTwoInts"])
async def test_the_description_is_what_was_hashed(graph: Graph, name: str) -> None:
    """A node describes the types of its endpoints; the description gives the hash again."""
    node = Adder()
    node.create_publisher(PoseStamped, "pose")
    await graph.start(node)
    answer = await describe(graph, "/adder", name, registry.hash_of(name))

    assert (answer.successful, answer.failure_reason) == (True, "")
    described: TypeDescription = answer.type_description
    text = typehash.type_description(registry.whole_schema(name), registry.message_schema)
    names = [described.type_description.type_name, *(t.type_name for t in described.referenced_type_descriptions)]
    assert [n for n in names if f'"type_name": "{n}"' not in text] == []
    for part in (described.type_description, *described.referenced_type_descriptions):
        for field in part.fields:
            assert f'"name": "{field.name}", "type": {{"type_id": {field.type.type_id}, ' in text
    assert sorted(names[1:]) == names[1:]


@slow
async def test_sources_are_the_definition_files(graph: Graph) -> None:
    """Types that have a file come with its text, derived ones are implicit."""
    await graph.start(Adder())
    answer = await describe(graph, "/adder", "example_interfaces/srv/AddTwoInts")
    sources = {s.type_name: (s.encoding, s.raw_file_contents) for s in answer.type_sources}
    assert sources["example_interfaces/srv/AddTwoInts"] == ("srv", "int64 a\nint64 b\n---\nint64 sum\n")
    assert sources["builtin_interfaces/msg/Time"] == ("msg", "int32 sec\nuint32 nanosec\n")
    assert sources["example_interfaces/srv/AddTwoInts_Request"] == ("implicit", "")


async def test_types_it_does_not_use_and_other_hashes_are_refused(graph: Graph) -> None:
    """The response has the reason."""
    await graph.start(Adder())
    answer = await describe(graph, "/adder", "std_msgs/msg/Bool")
    assert (answer.successful, answer.failure_reason) == (False, "this node uses no type 'std_msgs/msg/Bool'")
    answer = await describe(graph, "/adder", "example_interfaces/srv/AddTwoInts", "RIHS01_00")
    assert not answer.successful
    assert "RIHS01_e118de6b" in answer.failure_reason


async def test_it_can_be_left_out(graph: Graph) -> None:
    """With start_type_description_service false there is no such service."""
    node = Node("quiet", start_type_description_service=False)
    await graph.start(node)
    assert "/quiet/get_type_description" not in node.context.cache.services()


async def test_logger_levels_are_read_and_set(graph: Graph) -> None:
    """By ROS 2's names and numbers, for the node's own logger and those below it."""
    node = Node("arm", namespace="/left")
    await graph.start(node)
    try:
        asked = SetLoggerLevels.Request(
            levels=[
                LoggerLevel(name="left.arm", level=10),
                LoggerLevel(name="left.arm.hand", level=40),
                LoggerLevel(name="right.arm", level=10),
                LoggerLevel(name="left.arm", level=11),
            ]
        )
        results = (await graph.call(SetLoggerLevels, "/left/arm/set_logger_levels", asked)).results
        assert [r.successful for r in results] == [True, True, False, False]
        assert results[2].reason == "'right.arm' is not a logger of this node; its own is 'left.arm'"
        assert results[3].reason.startswith("11 is not a level")
        assert node.log.isEnabledFor(logging.DEBUG)

        names = GetLoggerLevels.Request(names=["left.arm", "left.arm.hand", "left.arm.foot", "other"])
        levels = (await graph.call(GetLoggerLevels, "/left/arm/get_logger_levels", names)).levels
        assert [(level.name, level.level) for level in levels] == [
            *(("left.arm", 10), ("left.arm.hand", 40), ("left.arm.foot", 10), ("other", 0))
        ]
    finally:
        for logger in (node.log, node.log.getChild("hand")):
            logger.setLevel(logging.NOTSET)


async def test_the_services_that_every_node_has_are_known(graph: Graph) -> None:
    """As the tables have them by which graph files are checked."""
    for made, known in ((Node("plain"), COMMON_SERVICES), (LifecycleNode("led"), COMMON_SERVICES | LIFECYCLE_SERVICES)):
        await graph.start(made)
        services = [e for e in core_of(made).endpoints if e.kind == Kind.SERVICE]
        assert {e.name: e.type_name for e in services} == {f"{made.full_name}/{n}": t for n, t in known.items()}
