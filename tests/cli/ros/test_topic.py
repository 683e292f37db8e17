"""`graphflow topic list`, `info`, `type` and `find`, and the arguments of `echo` and `pub`."""

from __future__ import annotations

import json
import re

import pytest

from graphflow.cli.ros.topic import _incompatibilities
from graphflow.machines.cache import GraphCache
from graphflow.qos import Durability, Qos
from graphflow.wire.liveliness import Entity, Kind
from tests.cases import slow
from tests.conftest import Machine

pytestmark = pytest.mark.real

STRING = "std_msgs/msg/String"
VISIBLE = ["/chatter", "/office/minutes", "/parameter_events", "/rosout"]
HIDDEN = ["/fibonacci/_action/feedback", "/fibonacci/_action/status", "/office/_drawer"]


def test_list(standing: Machine) -> None:
    """`list` prints names, sorted; with types; their number; with hidden ones; as JSON."""
    assert standing.look("topic", "list").split() == VISIBLE
    assert standing.look("topic", "list", "-t").splitlines()[:2] == [f"{name} [{STRING}]" for name in VISIBLE[:2]]
    assert standing.look("topic", "list", "-c") == "4\n"
    hidden = [*HIDDEN, "/standing/_supervisor/states"]
    assert standing.look("topic", "list", "--include-hidden-topics").split() == sorted([*VISIBLE, *hidden])
    assert json.loads(standing.look("topic", "list", "--json"))["/chatter"] == [STRING]


def test_list_with_counts(standing: Machine) -> None:
    """`-v` lists published and subscribed topics with the numbers of endpoints."""
    published, subscribed = standing.look("topic", "list", "-v").split("\n\n")[:2]
    assert published.startswith(f"Published topics:\n * /chatter [{STRING}] 1 publisher\n")
    assert " * /rosout [rcl_interfaces/msg/Log] 5 publishers" in published
    assert subscribed == (
        f"Subscribed topics:\n * /chatter [{STRING}] 1 subscriber\n * /office/minutes [{STRING}] 1 subscriber"
    )


def test_a_publisher_that_keeps_nothing() -> None:
    """Is the end to change, for a subscription that asks for kept messages."""
    ends = [
        Entity(7, "z", 1, n, kind, "/", node, "/map", STRING, "RIHS01_1", Qos(durability=durability))
        for n, (kind, node, durability) in enumerate(
            [(Kind.PUBLISHER, "server", Durability.VOLATILE), (Kind.SUBSCRIPTION, "nav", Durability.TRANSIENT_LOCAL)]
        )
    ]
    cache = GraphCache(end.token for end in ends)
    way = "durability; give the publisher TRANSIENT_LOCAL, which keeps messages"
    assert _incompatibilities(ends[0], cache) == [f"INCOMPATIBLE with /nav: {way}"]
    assert _incompatibilities(ends[1], cache) == [f"INCOMPATIBLE with /server: {way}"]


def test_info(standing: Machine) -> None:
    """Type and counts, as ROS 2 prints them; a name needs no leading slash."""
    expected = f"Type: {STRING}\nPublisher count: 1\nSubscription count: 1\n"
    assert standing.look("topic", "info", "/chatter") == expected
    assert standing.look("topic", "info", "chatter") == expected


def test_info_of_endpoints(standing: Machine) -> None:
    """`-v` describes each endpoint and its incompatibilities."""
    _, publisher, subscription = standing.look("topic", "info", "-v", "/office/minutes").split("Node name: ")
    assert publisher.startswith("clerk\nNode namespace: /office\n")
    assert "Endpoint type: PUBLISHER\n" in publisher
    assert "  Reliability: BEST_EFFORT\n  History (Depth): KEEP_LAST (7)\n  Durability: VOLATILE\n" in publisher
    assert "  Lifespan: Infinite\n" in publisher
    assert "INCOMPATIBLE with /office/auditor: reliability\n" in publisher
    assert "INCOMPATIBLE with /office/clerk: reliability\n" in subscription
    assert re.search(r"\nGID: ([0-9a-f]{2}\.){15}[0-9a-f]{2}\n", publisher)
    assert "INCOMPATIBLE" not in standing.look("topic", "info", "-v", "/chatter")


def test_info_for_programs(standing: Machine) -> None:
    """The same as JSON."""
    found = json.loads(standing.look("topic", "info", "--json", "/office/minutes"))
    assert (found["name"], found["types"]) == ("/office/minutes", [STRING])
    [publisher] = found["publishers"]
    assert (publisher["node"], publisher["qos"]["depth"]) == ("/office/clerk", 7)
    assert publisher["incompatible"] == ["INCOMPATIBLE with /office/auditor: reliability"]


def test_echo_once(standing: Machine) -> None:
    """The type is the graph's, and the first message ends it."""
    assert re.fullmatch(r"data: 'Hello World: \d+'\n---\n", standing.look("topic", "echo", "/chatter", "--once"))
    assert re.fullmatch(
        r"Hello World: \d+\n", standing.look("topic", "echo", "chatter", "--once", "--field", "data", "--csv")
    )


def test_echo_that_nobody_answers(standing: Machine) -> None:
    """Of a topic that is not there it waits for messages of the type that is given, for so long."""
    text = standing.look("topic", "echo", "/silence", STRING, "--timeout", "0.05", code=4)
    assert text.startswith("WARNING: topic [/silence] does not appear to be published yet\n")


@slow
def test_echo_of_a_topic_that_has_only_subscribers(machine: Machine) -> None:
    """The warning names them: they may be why one looks there."""
    machine.start("run", "listener")
    machine.until(lambda: "/chatter" in machine.look("topic", "list", code=None), "it listens")
    text = machine.run("topic", "echo", "/chatter", "--timeout", "0.05", code=4)
    published = "topic [/chatter] does not appear to be published yet"
    assert f"WARNING: {published}; /listener subscribes to it, and nothing publishes it" in text
    machine.start("run", "talker", "-r", "__ns:=/lab").wait_for("Publishing")
    text = machine.run("topic", "echo", "/chatter", "--timeout", "0.05", code=4)
    assert "nothing publishes it; did you mean '/lab/chatter', which /lab/talker publishes?" in text


@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        ("topic info /chater", 1, "error: Unknown topic '/chater'; did you mean '/chatter'?"),
        (
            "topic info /office/clerk/add",
            1,
            "error: Unknown topic '/office/clerk/add'; it is a service, of type example_int",
        ),
        (
            "service call /chatter std_srvs/srv/Empty",
            4,
            "error: no node offers the service /chatter; it is a topic, of",
        ),
        ("topic echo /chatter data", 2, "error: to show a field: graphflow topic echo /chatter --field data"),
        (
            "topic echo /chatter/data",
            2,
            "error: there is no topic /chatter/data; to show a field: graphflow topic echo /chatter --field data",
        ),
        ("topic echo /chatter.data", 2, "error: to show a field: graphflow topic echo /chatter --field data"),
        ("topic echo /talker", 1, "Unknown topic '/talker'; it is a node"),
        ("topic echo /chater", 1, "topic /chater does not appear to be published yet; did you mean '/chatter'?"),
        ("topic echo /chater", 1, "To wait for it, give its type: graphflow topic echo /chater TYPE"),
        (
            "topic echo /chatter std_msgs/msg/Int32",
            2,
            "error: /chatter is of type std_msgs/msg/String, not std_msgs/msg/",
        ),
        (
            "topic pub /chatter std_msgs/msg/Int32 data: 1",
            2,
            "/chatter is of type std_msgs/msg/String, not std_msgs/msg/I",
        ),
        (
            "topic pub /chatter",
            2,
            "topic pub /chatter std_msgs/msg/String ...; it carries std_msgs/msg/String",
        ),
        ("topic pub /new {data: x}", 2, "the topic's type comes before the values: graphflow topic pub /new TYPE ..."),
        (
            "topic echo /chatter /rosout",
            2,
            "'/rosout' was read as the type of /chatter; /rosout needs a command of its",
        ),
        ("topic echo chatter rosout", 2, "error: 'rosout' was read as the type of /chatter; /rosout needs a command"),
        (
            "topic echo /chatter Strin",
            2,
            "error: 'Strin' was read as the type of /chatter; its type is std_msgs/msg/String",
        ),
        (
            "topic pub /chatter hello",
            2,
            "error: 'hello' was read as the type of /chatter; its type is std_msgs/msg/String",
        ),
        ("topic pub /chatter std_msgs/msg/String dta: x", 2, "did you mean 'data'?"),
        ("topic pub /chatter std_msgs/msg/Strin data: x", 2, "its type is std_msgs/msg/String"),
    ],
)
def test_words_that_do_not_fit_the_graph(standing: Machine, words: str, code: int, told: str) -> None:
    """The error suggests existing names."""
    assert told in standing.look(*words.split(), code=code)


def test_type_and_find(standing: Machine) -> None:
    """The one from the other; a type may be short."""
    assert standing.look("topic", "type", "chatter") == f"{STRING}\n"
    assert "Unknown topic '/chater'; did you mean '/chatter'?" in standing.look("topic", "type", "/chater", code=1)
    for verb in ("type", "info"):
        told = standing.look("--domain", "77", "topic", verb, "/chatter", code=1)
        assert "Unknown topic '/chatter'; this domain, 77, has no other nodes; domain " in told
    assert standing.look("topic", "find", STRING).split() == ["/chatter", "/office/minutes"]
    assert standing.look("topic", "find", "std_msgs/String", "-c") == "2\n"
    assert "/office/_drawer" in standing.look("topic", "find", STRING, "--include-hidden-topics")
    told = "nothing is of type std_msgs/msg/Strin; did you mean 'std_msgs/msg/String'?\n"
    assert standing.look("topic", "find", "std_msgs/msg/Strin") == told


def test_echo_of_what_fits(standing: Machine) -> None:
    """A condition on the message; its bytes."""
    words = ("topic", "echo", "/chatter", "--once", "--filter")
    assert "Hello World" in standing.look(*words, "'World' in m.data")
    assert "is not an expression" in standing.look(*words, "m.data >", code=2)
    assert "AttributeError: " in standing.look(*words, "m.nothing", code=2)
    for condition in ([], ["--filter", "'World' in m.data"]):
        text = standing.look("topic", "echo", "/chatter", "--once", "--raw", *condition)
        assert text.startswith("b'\\x00\\x01\\x00\\x00")
        assert text.endswith("\\x00'\n---\n")


def test_pub_once(standing: Machine) -> None:
    """The published message is printed, and arrives."""
    text = standing.look("topic", "pub", "--once", "/office/minutes", STRING, "data: on the record")
    assert text.endswith("publisher: beginning loop\npublishing #1: std_msgs.msg.String(data='on the record')\n\n")
    standing.until(lambda: "on the record" in standing.look("logs", "office"), "it is heard")


def test_pub_once_and_a_number(machine: Machine) -> None:
    """The option takes none."""
    told = machine.look("topic", "pub", "--once", "10", "/office/minutes", STRING, "data: a", code=2)
    assert "--once takes no number; to publish several messages: --times N" in told


def test_without_a_graph(machine: Machine) -> None:
    """Without a graph, inspecting verbs exit with 3."""
    assert "error: nothing is running: nothing answers at tcp/" in machine.look("topic", "list", code=3)
    assert "error: nothing is running" in machine.look("topic", "echo", "/chatter", code=3)
