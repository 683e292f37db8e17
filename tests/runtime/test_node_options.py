"""Options from outside apply whatever a node's `__init__` takes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pytest

from graphflow import Node
from graphflow.errors import DeclarationError
from graphflow.interface import GroupChange
from graphflow.machines.regrouping import Regrouping
from graphflow.msgs.std_msgs.msg import String
from graphflow.names import Remap, Resolver
from graphflow.runtime.node_core import core_of
from graphflow.runtime.node_options import NodeOptions, make_within, unused_remaps, why_not
from graphflow.testing import Graph


class Talker(Node):
    """As slides teach it."""

    def __init__(self) -> None:
        super().__init__("talker", remap=["chatter:=own"])
        self.rate = self.declare_parameter("rate", 1.0)
        self.chatter = self.create_publisher(String, "chatter", 10)
        self.timer = self.create_timer(1.0 / self.rate, self.greet)

    def greet(self) -> None:
        self.chatter.publish(String(data=self.full_name))


class Named(Node):
    """Insists on a name."""

    def __init__(self, name: str) -> None:
        super().__init__(name)


class Needy(Node):
    """Insists on more."""

    def __init__(self, port: str, *, baud: int) -> None:
        super().__init__()


class Forgot(Node):
    """Has no parent."""

    def __init__(self) -> None:
        self.x = 1


class WithHelper(Node):
    """Makes another node before itself."""

    def __init__(self) -> None:
        self.helper = Node("helper")
        super().__init__("main")


def test_what_is_said_outside_wins() -> None:
    """Over the literal name, over the class's own rules and values."""
    rules = [Remap.parse("chatter:=news")]
    given = NodeOptions(
        "speaker", "/robot1", rules, {"rate": (5.0, "x.yaml:3")}, Regrouping({"io": GroupChange(("greet",))})
    )
    node = make_within(Talker, given, "talker")
    assert node.full_name == "/robot1/speaker"
    assert node.chatter.name == "/robot1/news"
    assert node.rate == 5.0
    assert node.parameters.source("rate") == "x.yaml:3"
    assert "io" in core_of(node).groups.by_name


def test_without_a_word_the_class_decides() -> None:
    """The literal name, its own remap."""
    node = make_within(Talker, NodeOptions(), "talker")
    assert (node.full_name, node.chatter.name) == ("/talker", "/own")
    assert Talker().full_name == "/talker"


async def test_it_runs(graph: Graph) -> None:
    """Under the name it was given."""
    heard = graph.tap(String, "/own")
    await graph.start(make_within(Talker, NodeOptions("speaker"), "talker"))
    await graph.clock.advance(1.0)
    assert [m.data for m in heard] == ["/speaker"]


def test_a_name_that_is_insisted_on() -> None:
    """Comes from the surroundings, or else is the usual one."""
    assert make_within(Named, NodeOptions("a"), "named").name == "a"
    assert make_within(Named, NodeOptions(), "named").name == "named"


@pytest.mark.parametrize(
    ("rules", "told"),
    [
        ("chatter:=news", ""),
        ("chater:=news", "matches no name of this node; did you mean 'chatter'?"),
        (
            "/out:=chatter",
            "matches no name of this node; it is the other way round, from the node's name: chatter:=/out",
        ),
        ("ns:=/robot1", "matches no name of this node; did you mean __ns:=/robot1?"),
        ("/talker:=/hi", "matches no name of this node; to rename the node write __node:=hi"),
        ("talker:=hi", "matches no name of this node; to rename the node write __node:=hi"),
        ("rate:=fast", "matches no name of this node; to set the parameter write -p rate:=fast"),
        (
            "chatter:=news chatter:=talk",
            "comes too late: chatter:=news has renamed chatter already; remove one of the two",
        ),
    ],
)
def test_rules_that_nothing_uses(rules: str, told: str) -> None:
    """Each is told with what was meant, or with the rule that came before."""
    names = Resolver("talker", "/", [Remap.parse(rule) for rule in rules.split()])
    names.resolve("chatter")
    found = list(unused_remaps(names, (), dynamic=False, parameters={"rate"}))
    assert found == ([f"the remap {rules.split()[-1]} {told}"] if told else [])


def test_only_the_node_that_was_meant() -> None:
    """Another node made by the constructor gets none, even of the same class."""
    node = make_within(WithHelper, NodeOptions("given"), "main")
    assert (node.name, node.helper.name) == ("given", "helper")
    given = NodeOptions("given")

    class Twin(Node):
        def __init__(self, *, first: bool = True) -> None:
            super().__init__("twin")
            self.other = Twin(first=False) if first else None

    twin: Any = make_within(Twin, given, "twin")
    assert (twin.name, twin.other.name) == ("given", "twin")


@dataclass
class Data(Node):
    """A node whose `__init__` is made by Python."""

    word: str = "hello"


def test_what_nobody_gives() -> None:
    """The error names the missing argument and the correction; the next node is unaffected."""
    wanted = (
        "Needy.__init__ needs port and baud, and nodes are made without arguments: give them defaults, or declare a "
        "parameter in the class: port = Param(...)"
    )
    assert why_not(Needy) == wanted
    line = Forgot.__init__.__code__.co_firstlineno
    assert why_not(Forgot) == f"Forgot.__init__ (test_node_options.py:{line}) must call super().__init__()"
    assert why_not(Data) == "leave out @dataclass above Data, whose __init__ it replaces; write word = Param(...)"
    assert why_not(Named) == why_not(Talker) == why_not(Node) == ""
    with pytest.raises(DeclarationError, match="needs port and baud"):
        make_within(Needy, NodeOptions("x"), "needy")
    assert Talker().name == "talker"
