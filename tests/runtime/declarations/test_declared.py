"""Declarations of a class and its parents: merged, checked and converted to data."""

from __future__ import annotations

import inspect
import json
import sys
from typing import Any

import pytest

from graphflow import DeclarationError, Group, Node, Param, Publisher, QosEvent, action, service, subscription, timer
from graphflow.errors import Place
from graphflow.interface import GroupInfo, Interface
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.msgs.std_srvs.srv import Empty, SetBool
from graphflow.runtime.declarations.declared import default_name, handlers, hooks, param_hooks, snake_case
from tests.runtime import cast
from tests.runtime.cast import Child, Everything, Parent, names_of


def line_of(marker: str) -> int:
    """The line of this file that ends with the marker."""
    lines = inspect.getsource(sys.modules[__name__]).splitlines()
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
    """An attribute cannot accidentally hide a node's own; an override that calls `super` can."""
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

    with pytest.raises(DeclarationError, match=r"every node has 'name'; .* write node_name = 'talker'"):
        type("Hiding", (Node,), {"name": "talker"})
    hidden: list[Any] = [[], staticmethod(of_self_copy())]
    for hiding in hidden:
        with pytest.raises(DeclarationError, match="every node has 'log'; choose another name"):
            type("Hiding", (Node,), {"log": hiding})

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

    with pytest.raises(DeclarationError, match=r"rate = 2.0 replaces the Param of .*; write rate = Param\(2.0\)"):

        class Child(Parent):
            rate = 2.0


def test_the_interface_says_everything() -> None:
    """Names, types, kinds, limits and places are known without making a node."""
    interface = Everything.interface()

    assert interface.class_path == f"{Everything.__module__}:Everything"
    assert interface.node_name == "all"
    assert interface.doc == "Declares one of each.\n\nAnd says so."
    assert interface.place == Place(cast.__file__, line_of_class("Everything"))
    assert interface.dynamic_names == ("*/pose",)
    assert names_of(interface) == ("heard", "tick", "sum", "run")
    assert interface.groups == {"io": GroupInfo(None), "one": GroupInfo(1)}
    assert [(e.kind, e.name, e.type, e.attribute) for e in interface.endpoints] == [
        ("publisher", "~/out", "std_msgs/msg/String", "out"),
        ("subscription", "/in", "std_msgs/msg/Int32", "incoming"),
        ("client", "add", "example_interfaces/srv/AddTwoInts", "adder"),
        ("subscription", "chatter", "std_msgs/msg/String", "heard"),
        ("service", "sum", "example_interfaces/srv/AddTwoInts", "sum"),
    ]
    assert all(e.place.file == cast.__file__ and e.place.line > interface.place.line for e in interface.endpoints)
    rate, frozen = interface.params
    assert (rate.name, rate.type, rate.default, rate.unit, rate.doc) == ("rate", "float", 2.0, "Hz", "How often.")
    assert (rate.gt, rate.le, rate.ge, rate.lt, rate.read_only) == (0.0, 10.0, None, None, False)
    assert (frozen.name, frozen.type, frozen.default, frozen.read_only) == ("frozen.list", "list[int]", [1, 2], True)
    assert interface.param("rate") is rate
    assert interface.param("nothing") is None


def line_of_class(name: str) -> int:
    """The line of the cast in which a class begins."""
    lines = inspect.getsource(cast).splitlines()
    return next(n for n, line in enumerate(lines, 1) if line.startswith(f"class {name}("))


def test_the_interface_survives_json() -> None:
    """A checker in another process reads the class's declarations unchanged."""
    interface = Everything.interface()

    assert Interface.from_json(json.loads(json.dumps(interface.to_json()))) == interface


class Bare(Node):
    pass


def test_the_interface_of_a_bare_node() -> None:
    """It has no declarations, and is named after its class; a parent's docstring is not its own."""
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


def test_a_child_has_its_parents_declarations() -> None:
    """Its own stand in their place; the order is that of the parent, then the child's."""
    interface = Child.interface()

    assert [p.name for p in interface.params] == ["rate", "gain"]
    assert [p.default for p in interface.params] == [10.0, 5.0]
    assert [e.name for e in interface.endpoints] == ["out", "extra", "in"]
    assert names_of(interface) == ("tick", "heard", "tock")
    assert interface.node_name == "child"
    assert [p.default for p in Parent.interface().params] == [1.0, 5.0]


def test_a_redefined_declaration_replaces_the_parents() -> None:
    """The last definition of an attribute counts; None removes a handler or publisher."""

    class Other(Parent):
        out = Publisher(Int32, "other")  # type: ignore[assignment]
        gain = None  # type: ignore[assignment]
        heard = None  # type: ignore[assignment]

    interface = Other.interface()

    assert [(e.name, e.type) for e in interface.endpoints] == [("other", "std_msgs/msg/Int32")]
    assert [p.name for p in interface.params] == ["rate"]
    assert names_of(interface) == ("tick",)


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


class Robot(Node):
    """Has functions that are called from everywhere."""

    rate = Param(1.0)

    @rate.check
    def not_too_fast(self, rate: float) -> None: ...

    @rate.on_change
    def note(self, old: float, new: float) -> None: ...

    def wanted(self, goal: Fibonacci.Goal) -> bool:
        return True

    def noticed(self, event: QosEvent) -> None: ...
    def heard_of(self, event: QosEvent) -> None: ...

    out = Publisher(String, "out", on_event=noticed)

    @subscription(String, "in", on_event=heard_of)
    async def heard(self, message: String) -> None: ...

    @action(Fibonacci, "go", accept=wanted, cancellable=False)
    async def go(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        return Fibonacci.Result()


def test_hooks_are_called_outside_of_handlers() -> None:
    """Checks, event callbacks and goal decisions; an `on_change` method is a handler of its own."""
    assert hooks(Robot) == {"not_too_fast", "wanted", "noticed", "heard_of"}
    assert list(handlers(Robot)) == ["heard", "go"]
    assert {name: hook.kind for name, hook in param_hooks(Robot).items()} == {
        "not_too_fast": "check",
        "note": "on_change",
    }


def test_the_name_of_a_node_that_is_given_none() -> None:
    """From `node_name`, or from the class name."""
    assert default_name(Robot) == "robot"
    named: Any = type("Robot", (Node,), {"node_name": "bob"})
    assert default_name(named) == "bob"


def test_two_services_of_one_name() -> None:
    """A client would reach only one of them; the same holds for actions. Duplicate subscriptions are legal."""
    with pytest.raises(DeclarationError, match=r"two offers the service 'x', which one \(.*:\d+\) already offers"):

        class Twice(Node):
            @service(Empty, "x")
            async def one(self, request: Empty.Request) -> Empty.Response: ...  # type: ignore[empty-body]

            @service(Empty, "x")
            async def two(self, request: Empty.Request) -> Empty.Response: ...  # type: ignore[empty-body]


def test_the_annotated_results_of_handlers() -> None:
    """They must match the returned type, or be missing."""

    async def text(self: Any, request: Empty.Request) -> str: ...  # type: ignore[empty-body]

    async def other(self: Any, request: Empty.Request) -> SetBool.Response: ...  # type: ignore[empty-body]

    async def own(self: Any, request: Empty.Request) -> Empty.Response | None: ...

    for fn, told in ((text, "str"), (other, "SetBool.Response")):
        with pytest.raises(DeclarationError, match=f"returns Empty.Response, but is annotated to return {told}$"):
            service(Empty, "x")(fn)
    service(Empty, "x")(own)
