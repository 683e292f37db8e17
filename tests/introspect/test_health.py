"""Faults that `doctor` finds besides waits."""

from __future__ import annotations

import itertools
import json
from typing import Any, cast

import pytest

from graphflow.introspect import health
from graphflow.introspect.graph_view import View
from graphflow.introspect.health import Look, examine, needs_second, read
from graphflow.machines.cache import GraphCache
from graphflow.qos import Qos
from graphflow.system import host_name
from graphflow.wire.liveliness import Entity, Kind
from graphflow.wire.process import ProcessToken
from tests.cases import slow


class Seen:
    """A view with the parts that `examine` uses."""

    def __init__(self, *tokens: str) -> None:
        self.cache = GraphCache(tokens)

        self.tokens: dict[str, ProcessToken] = {}

    def owner(self, name: str) -> str:
        return "process 7"

    def processes(self) -> dict[str, ProcessToken]:
        return self.tokens


_numbers = itertools.count(1)


def entity_token(
    node: str, *, zid: str = "a1", kind: Kind = Kind.NODE, name: str = "", type_: str = "std_msgs/msg/String"
) -> str:
    number, about = next(_numbers), () if kind is Kind.NODE else (name, type_, "RIHS01_" + "0" * 64)
    return Entity(0, zid, len(node), number, kind, "/", node[1:], *about).token


def look(**nodes: dict[str, dict[str, float]]) -> list[bytes]:
    return [json.dumps({"nodes": {f"/{name}": parts for name, parts in nodes.items()}}).encode()]


def found(seen: Any, before: list[bytes], now: list[bytes]) -> health.Health:
    return examine(seen, Look(before, 0, 0, 5.0), Look(now, 2 * 10**9, 2 * 10**9, 7.0))


PUB, SUB, CLIENT, SERVICE = Kind.PUBLISHER, Kind.SUBSCRIPTION, Kind.CLIENT, Kind.SERVICE


def test_two_nodes_of_one_name() -> None:
    """Tools and parameters reach one of them, by chance."""
    seen = Seen(entity_token("/a", zid="1"), entity_token("/a", zid="2"), entity_token("/b", zid="3"))
    assert found(seen, [], []).faults == ["2 nodes are called /a (process 7, among others): rename all but one"]


def test_two_nodes_that_offer_a_service() -> None:
    """Two servers of a service are a fault; for the services of every node, the shared name is reported."""
    seen = Seen(*(entity_token(node, kind=SERVICE, name=name) for node in ("/b", "/a") for name in ("/spawn", "/_in")))
    assert found(seen, [], []).faults == [
        "/spawn is offered by /a and /b: each call reaches all of them; remap one: --ros-args -r spawn:=NAME, or -r "
        "__ns:=/NAMESPACE"
    ]


@pytest.mark.parametrize(("rate", "is_told"), [(100, True), (2, False), (1, False)])
def test_a_node_that_hears_itself(rate: int, is_told: bool) -> None:
    """A node's own messages are reported if they really arrive; topics of every node do not count."""
    seen = Seen(*(entity_token("/a", kind=kind, name=name) for kind in (PUB, SUB) for name in ("/loop", "/tf")))
    counted = (("publisher", "published"), ("subscription", "received"))
    parts = {f"{kind} {name}": key for kind, key in counted for name in ("/loop", "/tf")}
    before, now = (look(a={part: {key: n} for part, key in parts.items()}) for n in (10, 10 + rate))
    told = [fault.partition(":")[0] for fault in found(seen, before, now).faults]
    assert told == (["/a receives its own messages on /loop, 50 per second"] if is_told else [])


@pytest.mark.parametrize(("dropped", "is_told"), [(990, True), (400, False)])
def test_lost_messages(dropped: int, is_told: bool) -> None:
    """Most of them, that is."""
    now = look(a={"subscription /scan": {"received": 1000, "dropped": dropped}})
    told = found(Seen(), [], now).faults
    assert bool(told) is is_told
    if told:
        assert told[0].startswith("subscription /scan of /a has lost 99 % of 1000 messages")


@pytest.mark.parametrize(("depth", "is_told"), [(1, False), (10, True)])
def test_lost_messages_of_a_queue_of_one(depth: int, is_told: bool) -> None:
    """It keeps the newest message on purpose."""
    entity = Entity(0, "a", 1, 2, SUB, "/", "a", "/scan", "std_msgs/msg/String", "RIHS01_0", Qos(depth=depth))
    now = look(a={"subscription /scan": {"received": 1000, "dropped": 990}})
    assert any("has lost" in fault for fault in found(Seen(entity.token), [], now).faults) is is_told


def test_a_few_lost_messages_are_nothing() -> None:
    """However large a part they are."""
    assert found(Seen(), [], look(a={"subscription /scan": {"received": 10, "dropped": 9}})).faults == []


@pytest.mark.parametrize(("expired", "is_told"), [(8, True), (4, False)])
def test_expired_messages(expired: int, is_told: bool) -> None:
    """Most of them, that is."""
    told = found(Seen(), [], look(a={"subscription /scan": {"received": 8, "expired": expired}})).faults
    text = "subscription /scan of /a drops 100 % of its messages, which are older than their lifespan when they arrive"
    assert told == ([f"{text}: give it a longer lifespan"] if is_told else [])


@pytest.mark.parametrize(("count", "is_told"), [(3, True), (2, False)])
def test_promises_that_are_not_kept(count: int, is_told: bool) -> None:
    """A deadline, and the liveliness of a publisher that has to assert it."""
    counters = {"publisher /a": {"deadline_missed": count}, "publisher /b": {"liveliness_lost": count}}
    told = found(Seen(), [], look(a=counters)).faults  # type: ignore[arg-type]
    deadline = f"publisher /a of /a has missed its deadline {count} times: have more sent, or allow more time"
    lease = f"publisher /b of /a has lost its liveliness {count} times: publish or assert_liveliness() within its lease"
    assert told == ([deadline, lease] if is_told else [])


def test_nodes_on_the_systems_time() -> None:
    """Beside a simulated one; those that set it or follow it are fine."""
    clock = "rosgraph_msgs/msg/Clock"
    tokens = [entity_token(node, zid=node[1:2]) for node in ("/sim", "/a", "/b", "/_tool")]
    tokens.append(entity_token("/b", zid="b", kind=SUB, name="/clock", type_=clock))
    assert found(Seen(*tokens), [], []).hints == []
    tokens.append(entity_token("/sim", zid="s", kind=PUB, name="/clock", type_=clock))
    text = "/a on the system's time, though /sim publishes /clock; to follow that: -p use_sim_time:=true"
    assert found(Seen(*tokens), [], []).hints == [text]
    many = [entity_token(f"/n{number}", zid=f"n{number}") for number in range(10)]
    assert " and 1 more on the system's time" in found(Seen(*tokens, *many), [], []).hints[0]


@pytest.mark.parametrize(
    ("part", "runs", "errors", "is_told"),
    [
        ("timer tick", 10, 1, True),
        ("timer tick", 11, 1, False),
        ("timer tick", 0, 0, False),
        ("service /ask", 10, 4, False),
        ("service /ask", 10, 5, True),
    ],
)
def test_handlers_that_raise(part: str, runs: int, errors: int, is_told: bool) -> None:
    """A tenth of the runs is enough; a service may refuse a request by raising."""
    told = found(Seen(), [], look(a={part: {"runs": runs, "errors": errors}})).faults
    text = f"{part} of /a has raised in {errors} of {runs} runs: its log has the error and the line"
    assert told == ([text] if is_told else [])


def test_a_flood_in_a_log() -> None:
    """Lines that were gathered count, too."""
    before, now = look(a={"log": {"lines": 5, "gathered": 0}}), look(a={"log": {"lines": 25, "gathered": 300}})
    assert found(Seen(), before, now).faults == [
        "/a logs 160 lines per second: limit them with throttle=1.0, in rclpy throttle_duration_sec=1.0"
    ]
    assert found(Seen(), now, now).faults == []


def test_a_flood_that_is_told() -> None:
    """If nodes report their logging rate, one sample is enough."""
    one = look(a={"log": {"lines": 25, "gathered": 300, "rate": 160.0}}, b={"log": {"lines": 9000, "rate": 2.0}})
    only = Look(one, 0, 0, 5.0)
    assert not needs_second(cast(View, Seen()), only)
    assert examine(cast(View, Seen()), only, only).faults == [
        "/a logs 160 lines per second: limit them with throttle=1.0, in rclpy throttle_duration_sec=1.0"
    ]


def test_when_a_second_look_is_needed() -> None:
    """A second sample is needed without a logging rate, or if a node subscribes to its own topic."""
    told, untold = look(a={"log": {"lines": 5, "rate": 1.0}}), look(a={"log": {"lines": 5, "gathered": 0}})
    loop = Seen(entity_token("/a", kind=PUB, name="/loop"), entity_token("/a", kind=SUB, name="/loop"))
    apart = Seen(entity_token("/a", kind=PUB, name="/loop"), entity_token("/b", kind=SUB, name="/loop"))
    clock = Seen(entity_token("/a", kind=PUB, name="/rosout"), entity_token("/a", kind=SUB, name="/rosout"))
    for seen, replies, is_needed in (
        (loop, told, True),
        (apart, told, False),
        (clock, told, False),
        (apart, untold, True),
    ):
        assert needs_second(cast(View, seen), Look(replies, 0, 0, 5.0)) is is_needed


def test_announcements_that_were_refused() -> None:
    """Refused announcements are counted."""
    [fault] = found(Seen("@ros2_lv/0/nonsense"), [], []).faults
    assert fault.startswith("1 announcements of nodes or endpoints are malformed")


def test_where_nobody_speaks() -> None:
    """Probable misspellings are faults; other topics without publishers, such as commands, are hints."""
    seen = Seen(
        entity_token("/goto", kind=SUB, name="/turtle1/posee"),
        entity_token("/sim", kind=PUB, name="/turtle1/pose"),
        entity_token("/sim", kind=SUB, name="/turtle1/cmd_vel"),
        entity_token("/two", kind=SUB, name="/scan2"),
        entity_token("/too", kind=SUB, name="/scan2"),
        entity_token("/sim", kind=PUB, name="/scan1"),
        entity_token("/goto", kind=CLIENT, name="/spwan"),
        entity_token("/sim", kind=SERVICE, name="/spawn"),
        entity_token("/sim", kind=SUB, name="/sim/set"),
        entity_token("/goto", kind=CLIENT, name="/rotat/_action/send_goal"),
        entity_token("/sim", kind=SERVICE, name="/rotate/_action/send_goal"),
        entity_token("/goto", kind=CLIENT, name="/cook/_action/send_goal"),
        entity_token("/goto", kind=SUB, name="/quiet"),
        entity_token("/mux", kind=SUB, name="/nav", type_="geometry_msgs/msg/Twist"),
        entity_token("/mux", kind=PUB, name="/out", type_="geometry_msgs/msg/Twist"),
        entity_token("/key", kind=PUB, name="/stick", type_="geometry_msgs/msg/Twist"),
    )
    told = found(seen, [], [])
    assert told.faults == [
        "/goto subscribes to /turtle1/posee, which no node publishes; did you mean /turtle1/pose?",
        "/goto calls /spwan, which no node offers; did you mean /spawn?",
        "/goto sends goals to /rotat, which no node offers; did you mean /rotate?",
    ]
    assert told.hints == [
        "/mux subscribes to /nav, which no node publishes; available with that type: /stick",
        "/goto subscribes to /quiet, which no node publishes",
        "/too and /two subscribe to /scan2, which no node publishes; available with that type: /scan1",
        "/sim subscribes to /turtle1/cmd_vel, which no node publishes",
        "/goto sends goals to /cook, which no node offers",
    ]


@pytest.mark.parametrize(
    "reply",
    [
        b"",
        b"{",
        b"[]",
        b'{"nodes": 3}',
        b'{"nodes": {"/a": {"log": 5}}}',
        b'{"nodes": {"/a": {"log": {"lines": 1' + b"0" * 400 + b"}}}}",
        b"[" * 100_000,
    ],
)
def test_what_is_no_answer_is_left_out(reply: bytes) -> None:
    """Others of the domain are read all the same."""
    good = look(a={"log": {"lines": 5}})
    assert read([reply, *good])[("/a", "log")] == {"lines": 5}


def test_an_answer_that_is_too_long_is_not_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """An answer that is too long is not parsed, which could take any time."""
    monkeypatch.setattr(health, "REPLY_BOUND", 10)
    assert read(look(a={"log": {"lines": 5}})) == {}


@slow
def test_what_nodes_know_to_be_wrong() -> None:
    """Complaints of nodes are reported, bounded and whatever they contain."""
    reply = json.dumps({"nodes": {}, "complaints": {"/a": ["the remap x:=y matches no name of this node"]}}).encode()
    assert found(Seen(), [], [reply]).faults == ["/a: the remap x:=y matches no name of this node"]
    wrong: Any
    for wrong in ([], {"/a": "x"}, {"/a": {}}, 5, None):
        assert found(Seen(), [], [json.dumps({"nodes": {}, "complaints": wrong}).encode()]).faults == []
    many = {f"/{n}": [str(i) for i in range(1000)] for n in range(1000)}
    assert len(found(Seen(), [], [json.dumps({"complaints": many}).encode()]).faults) <= 100


@pytest.mark.parametrize(
    ("told_ns", "where"),
    [
        (2.0, ""),
        (2.05, ""),
        (1.95, ""),
        (5.5, "3.5 s ahead of"),
        (0.5, "1.5 s behind"),
        (-8.0, ""),
        ("now", ""),
        (10**400, ""),
        (-(10**400), ""),
        (True, ""),
    ],
)
def test_clocks_that_differ(told_ns: float | str, where: str) -> None:
    """Of other machines, by more than the time of an answer explains."""
    seen = Seen()
    seen.tokens = {"a1": ProcessToken("a1", "0", 5, "robot"), "b2": ProcessToken("b2", "0", 5, host_name())}
    at = round(told_ns * 1e9) if isinstance(told_ns, float) else told_ns
    replies = [json.dumps({"process": zid, "time_ns": at, "nodes": {}}).encode() for zid in ("a1", "b2", "c3")]
    faults = found(seen, [], replies).faults
    assert len(faults) == bool(where)
    assert not where or f"the clock of robot is {where} this machine's" in faults[0]


def test_strangers() -> None:
    """Nodes of other machines are named: they may be a neighbour's."""
    seen = Seen(entity_token("/here", zid="b2"), *(entity_token(f"/n{i:02}", zid="a1") for i in range(12)))
    seen.tokens = {"a1": ProcessToken("a1", "0", 5, "robot"), "b2": ProcessToken("b2", "0", 5, host_name())}
    [hint] = found(seen, [], []).hints
    assert hint.startswith("/n00, /n01,")
    assert hint.endswith("/n09 and 2 more on another machine, robot")


def test_two_drivers_of_one_robot() -> None:
    """Two nodes that publish velocities on one topic are told; two talkers are not."""
    twist = "geometry_msgs/msg/Twist"
    seen = Seen(*(entity_token(node, kind=PUB, name="/cmd_vel", type_=twist) for node in ("/right", "/left")))
    assert found(seen, [], []).faults == [
        "/left and /right all publish /cmd_vel, and the robot obeys the latest: stop all but one, or remap"
    ]
    assert found(Seen(*(entity_token(node, kind=PUB, name="/chatter") for node in ("/a", "/b"))), [], []).faults == []


def test_two_clocks() -> None:
    """Two simulators would let the time jump."""
    clock = "rosgraph_msgs/msg/Clock"
    seen = Seen(*(entity_token(node, kind=PUB, name="/clock", type_=clock) for node in ("/one", "/two")))
    [fault] = found(seen, [], []).faults
    assert fault.startswith("/one and /two all publish /clock, and the time jumps between theirs: stop all but one")
