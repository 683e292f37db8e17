"""What methods make by `self.create_...`, as far as their source shows it."""

from __future__ import annotations

import inspect
from dataclasses import replace
from typing import Any

from graphflow import Group, Node, Param, service
from graphflow.interface import Interface
from graphflow.msgs import std_msgs
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import String

TOPIC = "chatter"


class Slide(Node):
    """Everything, as slides write it."""

    SUM = "sum"
    io = Group(1)

    def __init__(self) -> None:
        super().__init__("talker")
        self.declare_parameter("rate", 2.0)
        self.declare_parameter("where", inspect.stack)
        self.out = self.create_publisher(String, TOPIC, 10)
        self.create_publisher(std_msgs.msg.String, name="words")
        self.create_subscription(String, "in", self.heard, 10, group=self.io)
        self.create_service(AddTwoInts, self.SUM, self.add)
        self.client = self.create_client(AddTwoInts, "sum")
        self.create_action_server(Fibonacci, "fibonacci", callback=self.compute, thread=True)
        self.fibonacci: Any = self.create_action_client(Fibonacci, "fibonacci")
        self.create_timer(1.0, self.tick)
        self.create_timer(1.0, lambda: None)
        for name in ("a", "b"):
            self.create_publisher(String, name)

    def heard(self, message: String) -> None: ...

    def add(self, request: Any, response: Any) -> Any: ...

    def compute(self, goal: Any) -> Any: ...

    async def tick(self) -> None: ...


class Wheels(Node):
    """Makes the names of its parameters."""

    TAIL = ".[m]"

    def __init__(self) -> None:
        super().__init__("wheels")
        for wheel in ("left", "right"):
            self.declare_parameter(f"{wheel}.radius", 0.1)
            self.declare_parameter("gain." + wheel, 0.1)
            self.declare_parameter(wheel + self.TAIL, 0.1)
        self.make("width")

    def make(self, name: str) -> None:
        self.declare_parameter(name, 0.1)


class Parent(Node):
    """Makes something in a method of its own."""

    rate = Param(1.0)

    def __init__(self) -> None:
        Node.__init__(self, "parent")
        self.prepare()

    def prepare(self) -> None:
        self.create_publisher(String, "old")

    @service(AddTwoInts, "add")
    def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response()


class Child(Parent):
    """Replaces it."""

    def prepare(self) -> None:
        self.create_publisher(String, "new")
        self.create_service(AddTwoInts, "add_too", self.add)
        self.declare_parameter("rate", 3.0)


def names(interface: Interface) -> list[tuple[str, str, str, str]]:
    return [(e.kind, e.name, e.type, e.attribute) for e in interface.endpoints]


def test_endpoints() -> None:
    """Literal names and constants; the type, and the method or attribute that each belongs to."""
    add, fibonacci = "example_interfaces/srv/AddTwoInts", "example_interfaces/action/Fibonacci"
    assert names(Slide.interface()) == [
        ("publisher", "chatter", "std_msgs/msg/String", "out"),
        ("publisher", "words", "std_msgs/msg/String", ""),
        ("subscription", "in", "std_msgs/msg/String", "heard"),
        ("service", "sum", add, "add"),
        ("client", "sum", add, "client"),
        ("action", "fibonacci", fibonacci, "compute"),
        ("action client", "fibonacci", fibonacci, "fibonacci"),
    ]
    line = inspect.getsourcelines(Slide.__init__)[1]
    assert Slide.interface().endpoints[0].place == (__file__, line + 4, 0)


def test_the_name_that_a_class_gives_itself() -> None:
    """By `super().__init__` or by the parent's name; a child goes by its parent's."""
    assert Slide.interface().node_name == "talker"
    assert Child.interface().node_name == "parent"


def test_handlers() -> None:
    """With their groups; those without a name are left out."""
    found = [(h.name, h.kind, h.group, h.is_async, h.thread) for h in Slide.interface().handlers]
    assert found == [
        ("heard", "subscription", "io", False, False),
        ("add", "service", "", False, False),
        ("compute", "action", "", False, True),
        ("tick", "timer", "", True, False),
    ]


def test_parameters() -> None:
    """With the type of a literal default; any type where it is not literal."""
    rate, where = Slide.interface().params
    assert (rate.name, rate.type, rate.default) == ("rate", "float", 2.0)
    assert (where.name, where.dynamic) == ("where", True)


def test_what_cannot_be_read() -> None:
    """Its place is kept, and survives the way through JSON."""
    interface = Slide.interface()
    source = inspect.getsource(Slide.__init__).split("\n")
    line = inspect.getsourcelines(Slide.__init__)[1] + next(i for i, s in enumerate(source) if "String, name)" in s)
    assert interface.unread == ((__file__, line, 0),)
    assert Interface.from_json(interface.to_json()) == interface


def test_parameters_whose_names_are_made() -> None:
    """A pattern has what is known of each; a node may have what matches one."""
    interface = Wheels.interface()
    assert interface.made_params == ("*.radius", "gain.*", "*.[[]m]", "*")
    assert (interface.params, interface.unread) == ((), ())
    assert Interface.from_json(interface.to_json()) == interface
    some = replace(interface, made_params=interface.made_params[:3])
    assert [name for name in ("left.radius", "left.radios", "gain.a", "a.[m]", "a.m") if some.may_have(name)] == [
        "left.radius",
        "gain.a",
        "a.[m]",
    ]


def test_what_a_child_replaces() -> None:
    """Is not made; what is declared stands once."""
    assert [e.name for e in Parent.interface().endpoints] == ["add", "old"]
    assert [e.name for e in Child.interface().endpoints] == ["add", "new", "add_too"]
    assert [h.name for h in Child.interface().handlers] == ["add"]
    assert [(p.name, p.default) for p in Child.interface().params] == [("rate", 1.0)]


def test_without_a_source() -> None:
    """Only what is declared is known."""
    space: dict[str, Any] = {"Node": Node, "String": String}
    exec("class N(Node):\n    def __init__(self):\n        self.create_publisher(String, 'x')", space)
    assert space["N"].interface().endpoints == ()
