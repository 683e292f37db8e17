"""Definitions that other nodes give of their types."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.errors import InterfaceError, UnknownInterface
from graphflow.introspect.messages.definitions import learn, request_for, service_of, sources_in
from graphflow.machines.cache import GraphCache
from graphflow.msgs import registry
from graphflow.msgs.std_msgs.msg import String
from graphflow.qos import DEFAULT
from graphflow.wire.described import DESCRIBING, verified
from graphflow.wire.liveliness import Entity, Kind
from graphflow.wire.schema import Message
from graphflow.wire.typehash import type_hash
from tests.cases import slow

THING = "definitions_msgs/msg/Thing"
SOURCES = {THING: "uint8 X=3\nPart part\n", "definitions_msgs/msg/Part": "int32[2] y [1, 2]\n"}
MESSAGES = {m.name: m for m in verified(THING, "", SOURCES).values() if isinstance(m, Message)}
HASH = type_hash(MESSAGES[THING], MESSAGES.__getitem__)


def entity(kind: Kind = Kind.PUBLISHER, node: str = "speaker", type_: str = THING, digest: str = HASH) -> Entity:
    name, number = ("/things", 1) if kind is Kind.PUBLISHER else (f"/{node}/get_type_description", 2)
    type_name, digest = (type_, digest) if kind is Kind.PUBLISHER else (DESCRIBING, "RIHS01_00")
    return Entity(0, "ab", 0, number, kind, "/", node, name, type_name, digest, DEFAULT)


def response(*, files: bool = True, described: bool = True) -> Any:
    found: Any = registry.interface_class(f"{DESCRIBING}_Response")(successful=True)
    source: Any = registry.interface_class("type_description_interfaces/msg/TypeSource")
    one: Any = registry.interface_class("type_description_interfaces/msg/IndividualTypeDescription")
    field: Any = registry.interface_class("type_description_interfaces/msg/Field")
    if files:
        rows = SOURCES.items()
        found.type_sources = [source(type_name=n, encoding="msg", raw_file_contents=text) for n, text in rows]
    if described:
        part = field(name="part")
        part.type.type_id, part.type.nested_type_name = 1, "definitions_msgs/msg/Part"
        y = field(name="y")
        y.type.type_id, y.type.capacity = 6 + 48, 2
        found.type_description.type_description = one(type_name=THING, fields=[part])
        others = [one(type_name="definitions_msgs/msg/Part", fields=[y])]
        found.type_description.referenced_type_descriptions = others
    return found


def test_files_come_first() -> None:
    """Files are preferred, since they have constants, defaults and comments."""
    assert sources_in(response(), entity()) == SOURCES


@pytest.mark.parametrize("files", [False, True])
def test_a_description_will_do(files: bool) -> None:
    """The description is used if a node has no files, or only in another format."""
    answer = response(files=files)
    for source in answer.type_sources:
        source.encoding = "idl"
    texts = sources_in(answer, entity())
    assert texts == {THING: "definitions_msgs/msg/Part part\n", "definitions_msgs/msg/Part": "int32[2] y\n"}


def test_a_refusal() -> None:
    """A refusal is an error with the node's reason."""
    answer: Any = registry.interface_class(f"{DESCRIBING}_Response")(successful=False, failure_reason="no such type")
    with pytest.raises(InterfaceError, match="/speaker: no such type"):
        sources_in(answer, entity())


def test_another_type_than_was_announced() -> None:
    """A definition without the announced hash is rejected."""
    with pytest.raises(InterfaceError, match=r"its definition has the hash RIHS01_.*, not RIHS01_77"):
        sources_in(response(), entity(digest="RIHS01_77"))


class View:
    """Stands for a look at a graph."""

    def __init__(self, *answers: Any) -> None:
        nodes = [f"speaker{n}" for n in range(len(answers))]
        self.cache = GraphCache([e.token for n in nodes for e in (entity(node=n), entity(Kind.SERVICE, n))])
        self.answers = dict(zip([f"/{n}/get_type_description" for n in nodes], answers, strict=True))
        self.asked: list[str] = []

    def call(self, name: str, type_name: str, request: Any, timeout: float) -> Any:
        assert (type_name, request.type_name, request.type_hash) == (DESCRIBING, THING, HASH)
        assert timeout > 0
        self.asked.append(name)
        if isinstance(self.answers[name], Exception):
            raise self.answers[name]
        return self.answers[name]


@slow
def test_learning(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first usable definition is taken; a known type is not fetched."""
    monkeypatch.setattr(registry, "_foreign", {})
    view: Any = View(InterfaceError("broken"), response(), response())
    learn(view, "/things", "std_msgs/msg/String")
    assert view.asked == []
    learn(view, "/things", THING)
    assert len(view.asked) == 2
    assert registry.interface_class(THING)().part.y.tolist() == [1, 2]
    assert registry.definition(THING) == SOURCES[THING]
    assert registry.full_name("definitions_msgs/Thing") == THING
    learn(view, "/things", THING)
    assert len(view.asked) == 2
    assert String is registry.interface_class("std_msgs/msg/String")


def test_learning_in_vain(monkeypatch: pytest.MonkeyPatch) -> None:
    """The error has every node's reason."""
    monkeypatch.setattr(registry, "_foreign", {})
    view: Any = View(InterfaceError("broken"))
    with pytest.raises(UnknownInterface, match=r"no interface package 'definitions_msgs'.*; broken"):
        learn(view, "/things", THING)
    with pytest.raises(UnknownInterface, match="no node that uses it provides its definition"):
        learn(view, "/other", THING)


def test_what_is_asked() -> None:
    """The service that every node of ROS 2 has, since Iron."""
    assert service_of(entity()) == "/speaker/get_type_description"
    assert request_for(entity()).include_type_sources


def test_how_many_are_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    """A few; and none who use another type of that name."""
    monkeypatch.setattr(registry, "_foreign", {})
    view: Any = View(*(InterfaceError("broken") for _ in range(6)))
    with pytest.raises(UnknownInterface):
        learn(view, "/things", THING)
    assert len(view.asked) == 3
    other = "definitions_msgs/msg/Other"
    with pytest.raises(UnknownInterface, match="no node that uses it provides its definition"):
        learn(view, "/things", other)
    assert len(view.asked) == 3


def test_a_reason_that_is_long_or_strange() -> None:
    """A node's reason is cut and cleared of control characters."""
    reason = "\x1b[2J" + "x" * 5000
    answer: Any = registry.interface_class(f"{DESCRIBING}_Response")(successful=False, failure_reason=reason)
    with pytest.raises(InterfaceError) as caught:
        sources_in(answer, entity())
    assert len(str(caught.value)) < 400
    assert "\x1b" not in str(caught.value)


def test_an_action_that_nobody_installed() -> None:
    """An action's definition is not fetched; the error says where its file belongs."""
    no_view: Any = None
    with pytest.raises(UnknownInterface, match=r"put its file into interfaces/lab_msgs/action/Walk\.action"):
        learn(no_view, "/walk", "lab_msgs/action/Walk_FeedbackMessage")
