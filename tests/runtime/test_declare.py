"""What a node class says of itself: checked when it is made, merged with its parents', known as data."""

from __future__ import annotations

import asyncio
import inspect
import json
from collections.abc import AsyncIterator, Callable, Iterator
from typing import Any

import pytest

from graphflow import (
    Client,
    DeclarationError,
    Group,
    Node,
    Param,
    Publisher,
    Subscription,
    TimerInfo,
    service,
    subscription,
    task,
    timer,
)
from graphflow.interface import GroupInfo, Interface
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.qos import Durability, Qos
from graphflow.runtime.core import core_of
from graphflow.runtime.declared import snake_case
from graphflow.testing import Graph

X: Any = None
"""Stands where the type checker would see the mistake that is to be made."""


async def of_self(self: Any) -> None: ...
async def of_two(self: Any, one: Any) -> None: ...
async def of_three(self: Any, one: Any, two: Any) -> None: ...
async def of_none() -> None: ...
def plain(self: Any) -> None: ...
def plain_of_two(self: Any, one: Any) -> None: ...


def of_four(self: Any, one: Any, two: Any, three: Any) -> None:
    """Take three arguments too many."""


def generates(self: Any, one: Any) -> Iterator[int]:
    yield 1


async def generates_later(self: Any, one: Any) -> AsyncIterator[int]:
    yield 1


def _names(interface: Interface) -> tuple[str, ...]:
    return tuple(handler.name for handler in interface.handlers)


def anything(value: Any) -> Any:
    """Hide a value's type."""
    return value


# One mistake a line: the error is to name that line.
# fmt: off
MISTAKES: list[tuple[Callable[[], object], str]] = [
    (lambda: Publisher(anything("chatter"), anything(String)), "Publisher needs a message class, not 'chatter'"),
    (lambda: Publisher(anything(AddTwoInts), "x"), "Publisher needs a message class, not <class"),
    (lambda: Publisher(String, anything(10)), "Publisher: the type comes first, then the name; 10 is no name"),
    (lambda: Publisher(String, "a b"), "Publisher: 'a b' is no topic or service name: 'a b' may have only letters"),
    (lambda: Publisher(String, ""), "Publisher: '' is no topic or service name: it is empty"),
    (lambda: Publisher(String, "x", depth=-1), "a queue depth cannot be -1"),
    (lambda: Publisher(String, "x", anything("deep")), "give a Qos or a queue depth such as 10, not 'deep'"),
    (lambda: Subscription(anything(int), "x"), "Subscription needs a message class, not <class 'int'>"),
    (lambda: Subscription(String, "/a//b"), "Subscription: '/a//b' is no topic or service name: it has // in it"),
    (lambda: Client(anything(String), "x"), "Client needs a service class, not <class"),
    (lambda: Client(anything(AddTwoInts.Request), "x"), "give the service's class, as in AddTwoInts, not its Request"),
    (lambda: Client(AddTwoInts, "1x"), "Client: '1x' is no topic or service name"),
    (lambda: Param(anything(None)), "None cannot be a parameter: use a bool, int, float, str, bytes, or a list of one"),
    (lambda: Param(anything([])), "[] cannot be a parameter"),
    (lambda: Param(anything([1, "a"])), "[1, 'a'] cannot be a parameter"),
    (lambda: Param(5, le=4), "the default = 5 is out of range: at most 4"),
    (lambda: Param(5, le=4, name="speed"), "parameter 'speed' = 5 is out of range: at most 4"),
    (lambda: Param("fast", gt=0), "limits are for numbers, and 'fast' is none"),
    (lambda: Group(0), "a group's limit is 1 or more, or None for no limit, not 0"),
    (lambda: Group(anything("io")), "a group's limit is 1 or more, or None for no limit, not 'io'"),
    (lambda: subscription(anything("chatter"), anything(String)), "@subscription needs a message class, not 'chatter'"),
    (lambda: subscription(String, "a-b"), "@subscription: 'a-b' is no topic or service name"),
    (lambda: subscription(String, "x", depth=-2), "a queue depth cannot be -2"),
    (lambda: subscription(String, "x", group=anything("io")), "group= takes a Group, not 'io'"),
    (lambda: subscription(String, "x", group=anything(Group)), "group= takes a Group, not <class"),
    (lambda: timer(0.1, group=anything(1)), "group= takes a Group, not 1"),
    (lambda: service(AddTwoInts, "x", group=anything(1)), "group= takes a Group, not 1"),
    (lambda: timer(), "@timer: give a period in seconds or hz=, one of them"),
    (lambda: timer(0.1, hz=10), "@timer: give a period in seconds or hz=, one of them"),
    (lambda: timer(0.0), "@timer: a period must be a positive number, not 0.0"),
    (lambda: timer(hz=-1), "@timer: hz must be a positive number, not -1"),
    (lambda: timer(anything("fast")), "@timer: could not convert string to float: 'fast'"),
    (lambda: timer(hz=Param(0.0)), "@timer: hz must be a positive number, not 0.0"),
    (lambda: timer(hz=Param("often")), "@timer: could not convert string to float: 'often'"),
    (lambda: timer(anything(of_self)), "write @timer(0.5) or @timer(hz=2.0), with a period"),
    (lambda: service(anything(String), "x"), "@service needs a service class, not <class"),
    (lambda: service(anything(AddTwoInts.Response), "x"), "give the service's class, as in AddTwoInts"),
    (lambda: service(AddTwoInts, "x y"), "@service: 'x y' is no topic or service name"),
    (lambda: task(anything(plain)), "@task goes on an `async def` method, without parentheses"),
    (lambda: task(of_two), "of_two must take self, not (self, one)"),
    (lambda: subscription(String, "x")(of_self), "of_self must take self and one argument or self and two arguments"),
    (lambda: subscription(String, "x")(of_four), "of_four must take self and one argument or self and two"),
    (lambda: service(AddTwoInts, "x")(of_three), "of_three must take self and one argument, not (self, one"),
    (lambda: subscription(String, "x", on_event=anything("heard")), "@subscription: on_event= takes a method def"),
    (lambda: Publisher(String, "x", on_event=anything(3)), "Publisher: on_event= takes a method defined above it"),
    (lambda: subscription(String, "x", thread=True)(of_two), "of_two: thread=True is for `def`, an `async def` runs"),
    (lambda: subscription(String, "x")(anything(staticmethod(of_self))), "@subscription goes on a method, not on <s"),
    (lambda: subscription(String, "x")(anything(String)), "@subscription goes on a method, not on <class"),
    (lambda: subscription(String, "x")(generates), "generates has a yield in it, so that its body would never run"),
    (lambda: subscription(String, "x")(generates_later), "generates_later has a yield in it"),
    (lambda: timer(0.1)(of_none), "of_none must take self or self and one argument, not ()"),
    (lambda: timer(0.1)(of_three), "of_three must take self or self and one argument, not (self, one, two)"),
    (lambda: service(AddTwoInts, "x")(plain), "plain must take self and one argument, not (self); it gets the request"),
    (lambda: timer(0.2)(timer(0.1)(lambda self: None)), "<lambda> is declared twice, as @timer"),
]
# fmt: on


@pytest.mark.parametrize(("make", "text"), MISTAKES, ids=[text[:50] for _, text in MISTAKES])
def test_a_wrong_declaration_names_its_place(make: Callable[[], object], text: str) -> None:
    """It fails where it is written, with file, line and what would be right."""
    with pytest.raises(DeclarationError) as caught:
        make()

    place = f"{__file__}:{make.__code__.co_firstlineno}: "
    assert str(caught.value).startswith(place)
    assert text in str(caught.value)


def line_of(marker: str) -> int:
    """The line of this file that ends with the marker."""
    lines = inspect.getsource(inspect.getmodule(line_of) or X).splitlines()
    [number] = [n for n, line in enumerate(lines, 1) if line.endswith(f"# {marker}")]
    return number


def test_two_parameters_of_one_name() -> None:
    """The class is refused when it is made."""
    with pytest.raises(DeclarationError) as caught:

        class Twice(Node):
            rate = Param(1.0)
            other = Param(2.0, name="rate")  # declared twice

    assert str(caught.value) == f"{__file__}:{line_of('declared twice')}: Twice declares the parameter 'rate' twice"


def test_names_that_a_node_needs_itself() -> None:
    """Nothing can take the place of something of the node's own by accident; an override that calls on it can."""
    with pytest.raises(DeclarationError) as caught:

        class Named(Node):
            name = Param("bob")  # hides the name

    assert str(caught.value).startswith(f"{__file__}:{line_of('hides the name')}: ")
    assert "every node has 'name'; choose another name" in str(caught.value)
    for attribute in ("log", "clock", "shutdown", *vars(Node("x"))):
        with pytest.raises(DeclarationError, match=f"every node has '{attribute}'"):
            type("Hiding", (Node,), {attribute: Param(1.0)})
    with pytest.raises(DeclarationError, match="every node has 'shutdown'; choose another name"):
        type("Hiding", (Node,), {"shutdown": timer(1.0)(of_self_copy())})

    with pytest.raises(DeclarationError) as caught:

        class Robot(Node):
            def spawn(self) -> None:  # type: ignore[override]  # hides what starts tasks
                """Stand still."""

    assert str(caught.value).startswith(f"{__file__}:{line_of('hides what starts tasks')}: every node has 'spawn'")

    class Busy(Node):
        def __init__(self) -> None:
            super().__init__()
            self.log = ["wash up"]  # type: ignore[assignment]

    with pytest.raises(DeclarationError, match=r"Busy: every node has self\.log; choose another name"):
        core_of(Busy()).ensure_made()

    class Careful(Node):
        default_group = Group(1)

        def shutdown(self) -> None:
            super().shutdown()

    assert Careful.interface().groups == {"default_group": GroupInfo(1)}


def of_self_copy() -> Any:
    async def stop(self: Any) -> None: ...

    return stop


def test_a_timer_whose_parameter_is_gone() -> None:
    """A child that replaces the parameter of its parent's timer with something else is refused."""

    class Parent(Node):
        rate = Param(1.0)

        @timer(hz=rate)
        async def tick(self) -> None: ...

    with pytest.raises(DeclarationError, match="tick reads its period from the parameter 'rate', which Child does not"):

        class Child(Parent):
            rate = 2.0


def test_decorators_return_the_function() -> None:
    """A handler can be called as if it were not one."""

    async def handler(self: Any, message: Any) -> None: ...

    assert subscription(String, "x")(handler) is handler
    assert inspect.iscoroutinefunction(handler)


def test_optional_arguments_do_not_count() -> None:
    """A handler may have more arguments that need not be given."""

    class Lenient(Node):
        @subscription(String, "x")
        async def heard(self, message: String, loudly: bool = False) -> None: ...

        @timer(1.0)
        async def tick(self, extra: int = 0) -> None: ...

    assert _names(Lenient.interface()) == ("heard", "tick")


# interface


class Everything(Node):
    """Declares one of each.

    And says so.
    """

    node_name = "all"
    dynamic_names = ("*/pose",)

    rate = Param(2.0, unit="Hz", doc="How often.", gt=0.0, le=10.0)
    frozen = Param([1, 2], name="frozen.list", read_only=True)
    out = Publisher(String, "~/out", 5)
    incoming = Subscription(Int32, "/in", Qos(durability=Durability.TRANSIENT_LOCAL))
    adder = Client(AddTwoInts, "add")
    io = Group(None)
    one = Group()

    @subscription(String, "chatter", depth=3, group=io)
    async def heard(self, message: String) -> None: ...

    @timer(hz=rate, group=one)
    async def tick(self) -> None: ...

    @service(AddTwoInts, "sum", thread=True)
    def sum(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response()

    @task
    async def run(self) -> None: ...


def test_the_interface_says_everything() -> None:
    """Names, types, kinds, limits and places are known without making a node."""
    interface = Everything.interface()

    assert interface.class_path == f"{__name__}:Everything"
    assert interface.node_name == "all"
    assert interface.doc == "Declares one of each.\n\nAnd says so."
    assert interface.place.file == __file__
    assert interface.place.line == line_of_class("Everything")
    assert interface.dynamic_names == ("*/pose",)
    assert _names(interface) == ("heard", "tick", "sum", "run")
    assert interface.groups == {"io": GroupInfo(None), "one": GroupInfo(1)}
    assert [(e.kind, e.name, e.type, e.attribute) for e in interface.endpoints] == [
        ("publisher", "~/out", "std_msgs/msg/String", "out"),
        ("subscription", "/in", "std_msgs/msg/Int32", "incoming"),
        ("client", "add", "example_interfaces/srv/AddTwoInts", "adder"),
        ("subscription", "chatter", "std_msgs/msg/String", "heard"),
        ("service", "sum", "example_interfaces/srv/AddTwoInts", "sum"),
    ]
    assert all(e.place.file == __file__ and e.place.line > interface.place.line for e in interface.endpoints)
    rate, frozen = interface.params
    assert (rate.name, rate.type, rate.default, rate.unit, rate.doc) == ("rate", "float", 2.0, "Hz", "How often.")
    assert (rate.gt, rate.le, rate.ge, rate.lt, rate.read_only) == (0.0, 10.0, None, None, False)
    assert (frozen.name, frozen.type, frozen.default, frozen.read_only) == ("frozen.list", "list[int]", [1, 2], True)
    assert interface.param("rate") is rate
    assert interface.param("nothing") is None


def line_of_class(name: str) -> int:
    lines = inspect.getsource(inspect.getmodule(line_of) or X).splitlines()
    return next(n for n, line in enumerate(lines, 1) if line.startswith(f"class {name}("))


def test_the_interface_survives_json() -> None:
    """What a checker in another process reads is what the class declares."""
    interface = Everything.interface()

    assert Interface.from_json(json.loads(json.dumps(interface.to_json()))) == interface


class Bare(Node):
    pass


def test_the_interface_of_a_bare_node() -> None:
    """It declares nothing, and is named after its class; a parent's text is not its own."""
    interface = Bare.interface()

    assert interface.node_name == "bare"
    assert (interface.endpoints, interface.params, interface.handlers) == ((), (), ())
    assert interface.doc == ""
    assert Interface.from_json(json.loads(json.dumps(interface.to_json()))) == interface


def test_a_class_made_at_run_time_has_its_own_place() -> None:
    """Not its parent's."""
    made: Any = type("Made", (Everything,), {})

    assert made.interface().place.line != Everything.interface().place.line


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("Talker", "talker"),
        ("TurtleSim", "turtle_sim"),
        ("IMUDriver", "imu_driver"),
        ("Camera2", "camera2"),
        ("A", "a"),
        ("already_snake", "already_snake"),
    ],
)
def test_a_node_is_named_after_its_class(name: str, expected: str) -> None:
    """In snake case, abbreviations in one piece."""
    assert snake_case(name) == expected


# parents and children


class Parent(Node):
    """A base class with one of each."""

    rate = Param(1.0, gt=0.0)
    gain = Param(5.0)
    out = Publisher(String, "out")
    said: list[str]

    def __init__(self, name: str | None = None) -> None:
        super().__init__(name)
        self.said = []

    @timer(hz=rate)
    async def tick(self) -> None:
        self.said.append("parent ticks")

    @subscription(String, "in")
    async def heard(self, message: String) -> None:
        self.said.append(f"parent hears {message.data}")


class Child(Parent):
    """Overrides a default and a body, and adds a handler."""

    rate = Param(10.0, gt=0.0)
    extra = Publisher(Int32, "extra")

    async def heard(self, message: String) -> None:
        await super().heard(message)
        self.said.append(f"child hears {message.data}")

    @timer(0.25)
    async def tock(self) -> None:
        self.said.append("child tocks")


def test_a_child_has_its_parents_declarations() -> None:
    """Its own stand in their place; the order is that of the parent, then the child's."""
    interface = Child.interface()

    assert [p.name for p in interface.params] == ["rate", "gain"]
    assert [p.default for p in interface.params] == [10.0, 5.0]
    assert [e.name for e in interface.endpoints] == ["out", "extra", "in"]
    assert _names(interface) == ("tick", "heard", "tock")
    assert interface.node_name == "child"
    assert [p.default for p in Parent.interface().params] == [1.0, 5.0]


async def test_an_overridden_default_sets_the_parents_timer(graph: Graph) -> None:
    """The parent's `@timer(hz=rate)` reads the child's parameter."""
    child, parent = Child(), Parent()
    await graph.start(child, parent)

    await graph.clock.advance(1.0)

    assert child.said.count("parent ticks") == 10
    assert parent.said.count("parent ticks") == 1
    child.rate = 20.0
    await graph.clock.advance(1.0)
    assert child.said.count("parent ticks") == 30


async def test_an_overridden_body_keeps_its_declaration(graph: Graph) -> None:
    """The child's undecorated method is called, once, and may call the parent's."""
    child = Child()
    await graph.start(child)
    graph.publisher(String, "/in").publish(String(data="x"))
    await graph.settle()

    assert child.said == ["parent hears x", "child hears x"]


async def test_a_redeclared_handler_replaces_the_parents(graph: Graph) -> None:
    """Decorated anew, the method listens to what the child says, and no longer to what the parent said."""

    class Redeclared(Parent):
        @subscription(String, "elsewhere")
        async def heard(self, message: String) -> None:
            self.said.append(f"elsewhere {message.data}")

    node = Redeclared()
    await graph.start(node)
    graph.publisher(String, "/in").publish(String(data="old"))
    graph.publisher(String, "/elsewhere").publish(String(data="new"))
    await graph.settle()

    assert node.said == ["elsewhere new"]
    assert [e.name for e in Redeclared.interface().endpoints] == ["out", "elsewhere"]
    assert [e.name for e in Parent.interface().endpoints] == ["out", "in"]


def test_a_redefined_declaration_replaces_the_parents() -> None:
    """Whatever stands under the attribute last is what holds; None takes a handler or publisher away."""

    class Other(Parent):
        out = Publisher(Int32, "other")  # type: ignore[assignment]
        gain = None  # type: ignore[assignment]
        heard = None  # type: ignore[assignment]

    interface = Other.interface()

    assert [(e.name, e.type) for e in interface.endpoints] == [("other", "std_msgs/msg/Int32")]
    assert [p.name for p in interface.params] == ["rate"]
    assert _names(interface) == ("tick",)


def test_two_parents() -> None:
    """Declarations merge in the order in which Python resolves attributes."""

    class Left(Node):
        a = Param(1)
        b = Param(1)

    class Right(Node):
        b = Param(2)
        c = Param(2)

    class Both(Left, Right):
        pass

    assert {p.name: p.default for p in Both.interface().params} == {"a": 1, "b": 1, "c": 2}
    assert (Both().a, Both().b, Both().c) == (1, 1, 2)


async def test_a_mixin_need_not_be_a_node(graph: Graph) -> None:
    """Declarations of a plain class are found too."""

    class Ticking:
        ticks = 0

        @timer(0.5)
        async def tick(self) -> None:
            self.ticks += 1

    class Mixed(Ticking, Node):
        pass

    node = Mixed()
    await graph.start(node)
    await graph.clock.advance(1.0)

    assert node.ticks == 2


# on a node


async def test_declarations_become_what_they_declare(graph: Graph) -> None:
    """On the class they are themselves, on a node what `create_*` returns or the parameter's value."""
    node = Everything(rate=4)

    assert isinstance(Everything.out, Publisher)
    assert isinstance(Everything.incoming, Subscription)
    assert isinstance(Everything.adder, Client)
    assert isinstance(Everything.rate, Param)
    assert node.out.name == "/all/out"
    assert node.out.qos == Qos(depth=5)
    assert node.incoming.name == "/in"
    assert node.incoming.qos.durability is Durability.TRANSIENT_LOCAL
    assert node.adder.name == "/add"
    assert node.rate == 4.0
    assert node.frozen == [1, 2]


async def test_nodes_of_a_class_share_nothing(graph: Graph) -> None:
    """Each has its own endpoints and values."""
    one, two = Everything("one"), Everything("two")
    one.rate = 5.0

    assert two.rate == 2.0
    assert one.out is not two.out
    assert one.frozen is not two.frozen


async def test_a_timer_may_take_info_or_not(graph: Graph) -> None:
    """What it takes is told by its arguments."""
    seen: list[Any] = []
    done = asyncio.Event()
    loop = asyncio.get_running_loop()

    class Timers(Node):
        @timer(1.0)
        async def without(self) -> None:
            seen.append(None)

        @timer(1.0)
        def with_info(self, info: TimerInfo) -> None:
            seen.append(info)

        @timer(1.0, thread=True)
        def in_thread(self, info: TimerInfo) -> None:
            seen.append(info)
            loop.call_soon_threadsafe(done.set)

    await graph.start(Timers())
    await graph.clock.advance(1.0)
    await done.wait()

    info = TimerInfo(1_000_000_000, 1_000_000_000, 0)
    assert sorted(map(str, seen)) == sorted(map(str, [None, info, info]))


def test_reprs() -> None:
    """A group says its name and limit."""
    assert repr(Everything.io) == "Group(io, limit=None)"
    assert repr(Group(2)) == "Group(unnamed, limit=2)"
