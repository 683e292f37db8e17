"""Attributes that are not there: the text of the error once it is reported."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from graphflow import LifecycleNode, Node, Param
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.sensor_msgs.msg import Image
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.mistakes.errors.attribute_errors import explain
from graphflow.tf import Transform

NODE: Any = Node("n")


@pytest.mark.parametrize(
    ("use", "here"),
    [
        (lambda: NODE.get_logger(), 'self.log.info("...")'),
        (lambda: NODE.get_clock(), "self.clock.now()"),
        (lambda: NODE.get_parameter("x"), 'self.parameters.get("rate")'),
        (lambda: NODE.get_name(), "node.name"),
        (lambda: NODE.create_rate(10), "self.clock.every(hz=10.0)"),
        (lambda: NODE.destroy_node(), "self.shutdown() ends the node from within"),
        (lambda: NODE.create_client(AddTwoInts, "x").call_async(), "await client.call(request, timeout=2.0)"),
        (lambda: NODE.create_client(AddTwoInts, "x").wait_for_service(), "await client.wait_ready(1.0)"),
        (lambda: NODE.create_publisher(String, "x").topic_name, "in graphflow it is .name"),
    ],
)
def test_what_it_is_called_here(use: Any, here: str) -> None:
    """Once, however often it is explained."""
    with pytest.raises(AttributeError) as caught:
        use()
    explain(caught.value)
    assert here in str(caught.value)
    assert "`" not in str(caught.value)
    text = str(caught.value)
    explain(caught.value)
    assert str(caught.value) == text


def test_other_attributes() -> None:
    """Python's own words; and hasattr works."""
    with pytest.raises(AttributeError) as caught:
        NODE.foo()
    explain(caught.value)
    assert str(caught.value) == "'Node' object has no attribute 'foo'"
    assert not hasattr(NODE, "get_logger")
    assert getattr(NODE, "x", 1) == 1


def test_a_node_that_was_not_made() -> None:
    """Its class has forgotten to call ours."""

    class Forgot(Node):
        def __init__(self) -> None:
            self.create_publisher(String, "x", 10)

    with pytest.raises(AttributeError) as caught:
        Forgot()
    explain(caught.value)
    line = Forgot.__init__.__code__.co_firstlineno
    text = f"Forgot.__init__ (test_attribute_errors.py:{line}) must call super().__init__() first"
    assert str(caught.value) == text


@pytest.mark.parametrize("message", [String(), Image()])
def test_fields(message: Any) -> None:
    """The suggestions are existing fields; the text survives pickling and another `raise`."""
    with pytest.raises(AttributeError) as caught:
        _ = message.dat
    assert str(caught.value) == f"'{type(message).__name__}' object has no attribute 'dat'"
    explain(caught.value)
    assert str(caught.value) == f"{type(message).__name__} has no field 'dat'; did you mean 'data'?"


def test_errors_that_led_to_others() -> None:
    """Causes, contexts and groups, each once; an error that leads to itself has an end."""
    causes: list[AttributeError] = []
    for _ in range(3):
        with pytest.raises(AttributeError) as caught:
            _ = cast(Any, String()).dat
        causes.append(caught.value)
    group = ExceptionGroup("two", [ValueError("x"), causes[0]])
    group.__cause__, group.__context__ = causes[1], causes[2]
    causes[2].__context__ = group
    explain(group)
    assert {str(e) for e in causes} == {"String has no field 'dat'; did you mean 'data'?"}


class Broken(AttributeError):
    """Has no text."""

    def __str__(self) -> str:
        raise ValueError("no text")


def test_the_texts_of_other_classes_are_not_asked_for() -> None:
    """Their code may raise, while an error is being reported."""
    explain(Broken(name="dat", obj=String()))


def test_errors_of_others() -> None:
    """Errors of Python's own objects, and those with other texts, stay unchanged."""
    for error in (
        AttributeError("other words", name="get_logger", obj=NODE),
        AttributeError("'str' object has no attribute 'dat'", name="dat", obj="x"),
        AttributeError("'String' object has no attribute 'dat'"),
    ):
        before = str(error)
        explain(error)
        assert str(error) == before


@pytest.mark.parametrize(
    ("use", "told"),
    [
        (lambda: [].apend(1), "'list' object has no attribute 'apend'; did you mean 'append'?"),  # type: ignore[attr-defined]
        (lambda: NODE.log.inof("x"), "'NodeLogger' object has no attribute 'inof'; did you mean 'info'?"),
        (lambda: NODE.log.publish("x"), "it is a logger, with info(...), warning(...) and error(...); self.log is "),
    ],
)
def test_misspelt_methods_of_others(use: Any, told: str) -> None:
    """The nearest one is suggested, as Python does where it prints an error itself."""
    with pytest.raises(AttributeError) as caught:
        use()
    explain(caught.value)
    assert told in str(caught.value)


class Robot(Node):
    """Has a parameter."""

    goal_x = Param(1.0)
    _heading = 0.0


def test_a_misspelt_attribute() -> None:
    """The nearest one is suggested, unless it is private; a name unlike any other keeps Python's text."""
    robot: Any = Robot()
    for name, text in (
        ("goalx", "has no attribute 'goalx'; did you mean 'goal_x'?"),
        ("heading", "attribute 'heading'"),
        ("colour", "attribute 'colour'"),
    ):
        with pytest.raises(AttributeError) as caught:
            getattr(robot, name)
        explain(caught.value)
        assert str(caught.value).endswith(text)


class Counter(Node):
    """Counts with an attribute that nothing sets."""

    laps: int

    def count(self) -> None:
        self.laps += 1


def test_an_attribute_that_counts_from_nothing() -> None:
    """It needs a first value, in the class."""
    with pytest.raises(AttributeError) as caught:
        Counter().count()
    explain(caught.value)
    assert str(caught.value).endswith("has no attribute 'laps'; give it a first value in the class: laps = 0")


def test_fields_that_are_set() -> None:
    """The line must name the message; other objects get no hint."""
    response: Any = AddTwoInts.Response()
    holder = SimpleNamespace(image=Image())

    def sets_its_own() -> None:
        response.summ = 3

    def sets_an_inner_one() -> None:
        holder.image.header.stmp = None

    def sets_another() -> None:
        [response][0].summ = 3

    texts = []
    for fn in (sets_its_own, sets_an_inner_one, sets_another):
        with pytest.raises(AttributeError) as caught:
            fn()
        caught.value.name = None  # as in Python 3.11
        explain(caught.value)
        texts.append(str(caught.value))
    assert texts == [
        "AddTwoInts.Response has no field 'summ'; did you mean 'sum'?",
        "Header has no field 'stmp'; did you mean 'stamp'?",
        texts[2],  # Python's own words
    ]
    assert texts[2].startswith("'AddTwoInts_Response' object has no attribute 'summ'")


class Follower(Node):
    """Sets an attribute in a handler, and another when it is made."""

    def __init__(self) -> None:
        super().__init__("follower")
        if self.name == "other":
            self.unmade = 1

    def moved(self, pose: str) -> None:
        self.pose = pose


def test_attributes_that_a_method_sets_later() -> None:
    """The method is named, unless it has run long ago."""
    node = Follower()
    later = "; moved (test_attribute_errors.py:{}) sets it, and has not run: have it called before, "
    for name, text in (("pose", later), ("unmade", "")):
        with pytest.raises(AttributeError) as caught:
            getattr(node, name)
        explain(caught.value)
        begin = f"'Follower' object has no attribute '{name}'" + text.format(Follower.moved.__code__.co_firstlineno)
        assert str(caught.value).startswith(begin)
        assert text or str(caught.value) == begin


class Camera(LifecycleNode):
    """Sets an attribute in a method whose name is almost a hook's."""

    async def on_configured(self) -> None:
        self.device = "video0"


def test_an_attribute_that_no_hook_sets() -> None:
    """The hook is named, and not a first value, which would hide the mistake."""
    camera: Any = Camera()
    with pytest.raises(AttributeError) as caught:
        _ = camera.device
    explain(caught.value)
    assert str(caught.value).endswith(" sets it, and nothing calls that; did you mean on_configure?")


class Rover(Follower):
    """Has setters that do not run."""

    def moved(self, pose: str) -> None:
        """Do without the pose."""

    def _init_(self) -> None:
        self.laps = 0

    def measured(self) -> None:
        self.distance: float = self.distance + 1.0


@pytest.mark.parametrize(
    ("use", "way"),
    [
        (lambda rover: rover.pose, "sets it, and Rover replaces that: call super().moved() there"),
        (lambda rover: rover.laps, "sets it, and nothing calls that: write __init__"),
        (lambda rover: rover.measured(), "has no attribute 'distance'"),
    ],
)
def test_setters_that_do_not_run(use: Any, way: str) -> None:
    """A method that is replaced, or misspelt, is no later one; nor is the one that fails."""
    with pytest.raises(AttributeError) as caught:
        use(Rover())
    explain(caught.value)
    assert str(caught.value).endswith(way)


@pytest.mark.parametrize(
    ("use", "way"),
    [
        (lambda found: found.x, "its numbers are a tuple: x, y, z = found.translation"),
        (lambda found: found.translation.y, "it is a tuple: write found.translation[1]"),
        (lambda found: found.rotation.w, "it is a tuple: write found.rotation[3]"),
        (lambda found: (found,).x, ""),  # type: ignore[attr-defined]
        (lambda found: NODE.tf.send(found), "self.tf, with tf = Transforms() in the class, from graphflow.tf"),
    ],
)
def test_numbers_of_a_transform(use: Any, way: str) -> None:
    """They are no fields, as a message's are."""
    with pytest.raises(AttributeError) as caught:
        use(Transform.of("a", "b"))
    explain(caught.value)
    assert str(caught.value).endswith(way)
    assert ("; " in str(caught.value)) is bool(way)
