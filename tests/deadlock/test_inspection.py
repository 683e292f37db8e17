"""What a process answers when it is asked for its waits and groups, or told to look, or to move a handler."""

from __future__ import annotations

import asyncio
import json
from typing import Any

import pytest

from graphflow import Group, Node, service, subscription, timer
from graphflow.deadlock import inspection
from graphflow.deadlock.inspection import LOOKS, MOVES, groups_of
from graphflow.errors import RemoteError
from graphflow.executor.groups import GROUPS_BOUND
from graphflow.machines.waits.wait_graph_json import from_json
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from graphflow.testing.clock import settle
from graphflow.transport.base import Answer
from graphflow.wire.process import GROUPS, LOOK, WAITS, answer_key
from tests.deadlock.cast import say


class Arm(Node):
    """Has a group with two handlers, and a handler in none."""

    node_name = "arm"
    motion = Group(2, "drop_new", thread=False)

    @subscription(String, "go", group=motion)
    async def go(self, _: String) -> None:
        await self.clock.sleep(100.0)

    @service(Empty, "land", group=motion)
    async def land(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()

    @timer(1.0)
    async def tick(self) -> None:
        """Be quick."""


async def start(graph: Graph) -> Arm:
    node = Arm()
    await graph.start(node)
    return node


def report(graph: Graph, node: Node, what: str) -> bytes:
    """What a node's process answers."""
    return graph.network.reports[answer_key(0, what, node.context.session.zid)]()


async def ask(graph: Graph, node: Node, payload: bytes) -> Answer:
    """Have a handler moved, as `graphflow groups` does."""
    answers: list[Answer | None] = []
    session = graph.network.session(asyncio.get_running_loop())
    key = answer_key(0, GROUPS, node.context.session.zid)
    session.open_caller(key, lambda: None).call(payload, b"", answers.append)
    await settle()
    [answer, end] = answers
    assert answer is not None
    assert end is None
    return answer


def limited(limit: object, group: str = "motion") -> bytes:
    return json.dumps({"node": "/arm", "group": group, "limit": limit}).encode()


def wanted(**changes: object) -> bytes:
    return json.dumps({"node": "/arm", "handler": "tick", "group": "motion", **changes}).encode()


async def test_groups_and_their_handlers(graph: Graph) -> None:
    """Each group with its limit and its handlers, and at the end the handlers of none; graphflow's own are left out."""
    node = await start(graph)
    await say(graph, "/go", "/go", "/go")
    motion, rest = groups_of(core_of(node))

    assert {key: value for key, value in motion.items() if key != "handlers"} == {
        "name": "motion",
        "limit": 2,
        "when_full": "drop_new",
        "thread": False,
    }
    assert motion["handlers"] == [
        {"handler": "go", "kind": "subscription", "async": True, "running": 2, "waiting": 0, "runs": 2, "errors": 0},
        {"handler": "land", "kind": "service", "async": True, "running": 0, "waiting": 0, "runs": 0, "errors": 0},
    ]
    assert (rest["name"], [each["handler"] for each in rest["handlers"]]) == ("", ["tick"])


async def test_the_waits_of_a_process(graph: Graph) -> None:
    """They are a picture that others can read, with all that is known of the process besides."""
    node = await start(graph)
    await say(graph, "/go")
    told = json.loads(report(graph, node, WAITS))

    [activity] = from_json(told).activities.values()
    assert activity.label == "subscription go"
    assert told["process"] == node.context.session.zid
    assert told["nodes"] == {"/arm": groups_of(core_of(node))}
    assert (told["reports"], told["stalls"]) == ([], [])
    assert (told["blocked_for"], told["late"], told["longest"]) == (0.0, 0, 0.0)


async def test_to_look_when_told(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """It looks for deadlocks, and answers nothing."""
    node = await start(graph)
    looks: list[str] = []
    monkeypatch.setattr(node.context.search, "look_now", lambda: looks.append("look"))

    assert report(graph, node, LOOK) == b""
    assert looks == ["look"]


async def test_a_handler_that_is_moved(graph: Graph) -> None:
    """It takes the other group's slots from then on; the answer has the groups as they are now."""
    node = await start(graph)
    answer = await ask(graph, node, wanted())

    assert not answer.is_error
    groups: list[dict[str, Any]] = json.loads(answer.payload)["groups"]
    assert [each["handler"] for each in groups[0]["handlers"]] == ["go", "land", "tick"]
    [tick] = [runner for runner in core_of(node).runners if runner.spec.handler == "tick"]
    assert tick.group is core_of(node).groups.by_name["motion"]

    await ask(graph, node, wanted(group="fresh"))
    assert tick.group is core_of(node).groups.by_name["fresh"]
    await ask(graph, node, wanted(group="none"))
    assert tick.group is None


async def test_a_group_with_another_limit(graph: Graph) -> None:
    """It holds at once, and the answer has the lines that keep it."""
    node = await start(graph)
    told = json.loads((await ask(graph, node, limited(3))).payload)

    assert core_of(node).groups.by_name["motion"].limit == 3
    assert told["groups"][0]["limit"] == 3
    assert told["yaml"] == ["  /arm: {concurrency: {motion: {limit: 3}}}"]
    assert not (await ask(graph, node, limited(None))).is_error
    assert core_of(node).groups.by_name["motion"].limit is None


@pytest.mark.parametrize(
    ("payload", "kind", "words"),
    [
        (wanted(node="/leg"), "InvalidName", "there is no node /leg in this process"),
        (wanted(handler="tock"), "InvalidName", "/arm has no handler 'tock'; did you mean 'tick'?"),
        (wanted(handler="unheard_of"), "InvalidName", "/arm has no handler 'unheard_of'; there is go, land, tick"),
        (wanted(group="two words"), "DeclarationError", "'two words' is not a group name"),
        (b"nonsense", "JSONDecodeError", ""),
        (b"[]", "TypeError", ""),
        (b'{"node": "/arm"}', "KeyError", "group"),
        (b'{"node": "/arm", "group": "motion"}', "KeyError", "handler"),
        (limited(0), "InvalidName", "the limit '0' is not a number from 1 to 1,000,000, and not none"),
        (limited(1_000_001), "InvalidName", "the limit '1000001' is not a number"),
        (limited(True), "InvalidName", "the limit 'True' is not a number"),
        (limited("2" * 100), "InvalidName", "the limit '2222222222222222222222222222222222222222' is not a number"),
        (limited(2, group="motoin"), "InvalidName", "/arm has no group 'motoin'; did you mean 'motion'?"),
        (b"\xff", "UnicodeDecodeError", ""),
        pytest.param(b"[" * 5_000, "RecursionError|JSONDecodeError", "", id="too deep"),  # the latter since 3.13
        pytest.param(b"[" * 100_000, "InvalidName", "a request of 100000 bytes names no handler", id="too long"),
    ],
)
async def test_what_cannot_be_done(graph: Graph, payload: bytes, kind: str, words: str) -> None:
    """The error is answered, and nothing has been moved."""
    node = await start(graph)
    before = groups_of(core_of(node))
    answer = await ask(graph, node, payload)

    assert answer.is_error
    error = RemoteError.from_payload(answer.payload, "")
    assert error.type in kind.split("|")
    assert words in str(error)
    assert groups_of(core_of(node)) == before


async def test_a_limit_where_no_group_is(graph: Graph) -> None:
    """The verb that makes one is told."""
    node = Node("leg")
    await graph.start(node)
    answer = await ask(graph, node, json.dumps({"node": "/leg", "group": "motion", "limit": 2}).encode())
    told = "/leg has no group 'motion'; it has none, and graphflow groups move /leg HANDLER GROUP makes one"
    assert RemoteError.from_payload(answer.payload, "").message == told


async def test_groups_are_not_made_without_limit(graph: Graph) -> None:
    """Of those that nobody has declared."""
    node = await start(graph)
    has = len(core_of(node).groups.by_name)
    for i in range(GROUPS_BOUND - has):
        assert not (await ask(graph, node, wanted(group=f"g{i}"))).is_error
    answer = await ask(graph, node, wanted(group="one_more"))
    assert f"this node has {GROUPS_BOUND} groups" in str(RemoteError.from_payload(answer.payload, ""))
    assert not (await ask(graph, node, wanted(group="g1"))).is_error


async def test_who_asks_too_often_gets_the_last_answer(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """And no deadlock is looked for."""
    node = await start(graph)
    inspection = core_of(node).context._inspection
    looked: list[None] = []
    monkeypatch.setattr(inspection._search, "look_now", lambda: looked.append(None))
    for _ in range(500):
        assert json.loads(inspection._waits())["process"]
        assert json.loads(inspection._numbers())["process"]
        inspection._look()
    assert inspection._waits_allowed.refused > 200
    assert inspection._numbers_allowed.refused > 200
    assert LOOKS <= len(looked) < 200


async def test_who_moves_handlers_all_the_time_is_not_answered(graph: Graph) -> None:
    """What is too much ends without an answer; later requests are answered again."""
    node = await start(graph)
    answers: list[Answer | None] = []
    session = graph.network.session(asyncio.get_running_loop())
    caller = session.open_caller(answer_key(0, GROUPS, node.context.session.zid), lambda: None)
    for _ in range(MOVES + 300):
        caller.call(wanted(), b"", answers.append)
    await settle()
    assert MOVES <= sum(answer is not None for answer in answers) < MOVES + 100
    assert sum(answer is None for answer in answers) == MOVES + 300
    await graph.clock.advance(1.0)
    assert not (await ask(graph, node, wanted())).is_error


async def test_closing_it(graph: Graph) -> None:
    """Nobody answers any more."""
    node = await start(graph)
    node.context._inspection.close()

    assert graph.network.reports == {}
    assert not any(graph.network.servers.get(answer_key(0, GROUPS, node.context.session.zid), []))


async def test_a_request_that_is_too_long(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is refused unread."""
    monkeypatch.setattr(inspection, "MOVE_BOUND", 20)
    node = await start(graph)
    answer = await ask(graph, node, wanted())
    assert answer.is_error
    assert b"names no handler" in answer.payload
