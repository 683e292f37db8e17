"""Declarations of attributes are checked when the class is created."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import pytest

from graphflow import (
    ActionClient,
    Client,
    DeclarationError,
    Group,
    Node,
    Param,
    ParameterError,
    Publisher,
    Subscription,
)
from graphflow.interface import Interface
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import String
from graphflow.qos import Durability, Qos
from graphflow.testing import Graph
from tests.runtime.cast import Everything, anything, refusal_of


def of_two(self: Any, one: Any) -> None: ...
async def of_two_later(self: Any, one: Any) -> None: ...
def of_three(self: Any, one: Any, two: Any) -> None: ...


# One mistake a line: the error is to name that line.
# fmt: off
MISTAKES: list[tuple[Callable[[], object], str]] = [
    (lambda: Publisher(anything("chatter"), anything(String)), "Publisher needs a message class, not 'chatter'"),
    (lambda: Publisher(anything(AddTwoInts), "x"), "Publisher needs a message class, not <class"),
    (lambda: Publisher(String, anything(10)), "Publisher: the type comes first, then the name; 10 is not a name"),
    (lambda: Publisher(String, "a b"), "Publisher: 'a b' is not a topic or service name: 'a b' may have only letters"),
    (lambda: Publisher(String, ""), "Publisher: '' is not a topic or service name: it is empty"),
    (lambda: Publisher(String, "x", depth=-1), "a queue depth cannot be -1"),
    (lambda: Publisher(String, "x", anything("deep")), "give a Qos or a queue depth such as 10, not 'deep'"),
    (lambda: Subscription(anything(int), "x"), "Subscription needs a message class, not <class 'int'>"),
    (lambda: Subscription(String, "/a//b"), "Subscription: '/a//b' is not a topic or service name: it has // in it"),
    (lambda: Client(anything(String), "x"), "Client needs a service class, not <class"),
    (lambda: Client(anything(AddTwoInts.Request), "x"), "give the service's class, as in AddTwoInts, not its Request"),
    (lambda: Client(AddTwoInts, "1x"), "Client: '1x' is not a topic or service name"),
    (lambda: Param(anything(float)), "cannot be a parameter: its default decides the type: write 0.0"),
    (lambda: anything(Param)(float, 1.5), "Param takes no type; the default decides it: write Param(1.5, ...)"),
    (lambda: Param(anything(None)), "None cannot be a parameter: use a bool, int, float, str, bytes, or a list of one"),
    (
        lambda: anything(Publisher)(String, "words", reliability="best_effort"),
        "Publisher has no reliability=, which belongs to qos=Qos(depth=10, reliability=...)",
    ),
    (lambda: Param(anything([])), "an empty list has no type"),
    (lambda: Param(anything([1, "a"])), "[1, 'a'] cannot be a parameter"),
    (lambda: Param(5, le=4), "the default = 5 is out of range: at most 4"),
    (lambda: Param(5, le=4, name="speed"), "parameter 'speed' = 5 is out of range: at most 4"),
    (lambda: Param("fast", gt=0), "limits are for numbers, and 'fast' is not a number"),
    (lambda: Group(0), "a group's limit must be 1 or more, or None for no limit, not 0"),
    (lambda: Group(anything("io")), "a group's limit must be 1 or more, or None for no limit, not 'io'"),
    (lambda: Publisher(String, "x", on_event=anything(3)), "Publisher: on_event= takes a method defined above it"),
    (lambda: Group(None, "drop_old"), "a group without a limit is never full; when_full='drop_old' needs one"),
    (lambda: Group(1, anything("drop")),
     "when_full must be one of wait, drop_new, drop_old, cancel_running, not 'drop'"),
    (lambda: Publisher(String, "x", Qos(), depth=5), "give a Qos or a depth, not both: Qos(depth=5"),
    (lambda: Subscription(String, "x", Qos(depth=5), depth=5), "give a Qos or a depth, not both"),
    (lambda: ActionClient(anything(AddTwoInts), "x"), "ActionClient needs an action class, not <class"),
    (lambda: Client(AddTwoInts, "x", group=anything(1)), "Client: group= takes a Group, not 1"),
    (lambda: anything(Param)("speed", 1.0), "leave out 'speed', the parameter has the name of its attribute"),
    (lambda: Param(5, step=-1), "a step cannot be -1"),
    (lambda: Param(5, step=0.5), "a step cannot be 0.5"),
    (lambda: Param(1.0).check(anything(of_two_later)), "of_two_later: a check must decide at once; make it a `def`"),
    (lambda: Param(1.0).check(anything(of_three)), "of_three must take (self, value)"),
    (lambda: Param(1.0).on_change(anything(of_two)), "of_two must take (self, old, new)"),
    (lambda: Param(1.0).on_change(anything(String)), ".on_change goes on a method, not on <class"),
]
# fmt: on


@pytest.mark.parametrize(("make", "text"), MISTAKES, ids=[text[:50] for _, text in MISTAKES])
def test_a_wrong_declaration_names_its_place(make: Callable[[], object], text: str) -> None:
    """The error has file, line and the correct form."""
    assert text in refusal_of(make)


async def test_declarations_become_what_they_declare(graph: Graph) -> None:
    """On the class they are themselves, on a node the result of `create_*` or the parameter's value."""
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


def test_reprs() -> None:
    """A group's has its name and limit."""
    assert repr(Everything.io) == "Group(io, limit=None)"
    assert repr(Group(2)) == "Group(unnamed, limit=2)"


def test_choices_of_a_parameter() -> None:
    """Each value is one of them, of a list each element; so they go through JSON."""
    for default, choices, wrong in (
        ("fast", ["fast", "slow"], "fats"),
        (1, (1, 2, 4), 3),
        (0.5, [0.5, 1], 0.7),
        (b"a", [b"a", b"b"], b"c"),
        (["x"], ["x", "y"], ["x", "z"]),
    ):
        parameter = Param(default, choices=choices, name="mode").parameter  # type: ignore[type-var]
        assert parameter.fit(default) == default
        with pytest.raises(ParameterError, match=r"parameter 'mode' = .* is not one of "):
            parameter.fit(wrong)
        interface = Interface("m:C", "c", parameter.place, params=(parameter,))
        assert Interface.from_json(json.loads(json.dumps(interface.to_json()))).params == (parameter,)


@pytest.mark.parametrize(
    ("default", "choices", "told"),
    [
        ("other", ["fast", "slow"], "the default = 'other' is not one of 'fast', 'slow'"),
        ("a", ["a", 3], "the default is of type string, 3 is not"),
        ("ab", [], r"choices=\[\] would allow no value: write choices=\['ab', ...\]"),
        ("ab", "ab", "choices= takes a list of values, not 'ab'"),
    ],
)
def test_choices_that_cannot_be(default: str, choices: Any, told: str) -> None:
    """The error has their place."""
    with pytest.raises(DeclarationError, match=rf"test_declare.py:\d+: {told}"):
        Param(default, choices=choices)


def test_a_declaration_in_a_class_that_is_no_node() -> None:
    """Its use is an error that shows where it belongs; a mixin is a part of the node."""

    class Motor:
        cmd_vel = Publisher(String, "cmd_vel")

    class Car(Motor, Node): ...

    told = (
        "Motor is not a node, so that nothing opens its Publisher 'cmd_vel'; declare it in the node's class, and pass"
    )
    with pytest.raises(DeclarationError, match=rf"test_declare.py:\d+: {told} it on: Motor\(self.cmd_vel\)$"):
        Motor().cmd_vel  # type: ignore[call-overload]  # noqa: B018
    assert Car("car").cmd_vel.name == "/cmd_vel"
