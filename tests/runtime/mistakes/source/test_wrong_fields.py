"""Fields of messages that their type does not have."""

from __future__ import annotations

import importlib.util
import itertools
import sys
from pathlib import Path

import pytest

from graphflow import Node
from graphflow.runtime.mistakes.source.slips import slips

HEAD = """\
from graphflow import Node, action, service, subscription
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.geometry_msgs.msg import PoseStamped, Twist
from graphflow.msgs.sensor_msgs.msg import PointCloud2
from graphflow.msgs.std_msgs.msg import Bool, String


class Robot(Node):
"""
_numbers = itertools.count()


def _told(folder: Path, body: str) -> list[str]:
    name = f"fields_{next(_numbers)}"
    file = folder / f"{name}.py"
    file.write_text(HEAD + "".join(f"    {line}\n" for line in body.splitlines()))
    spec = importlib.util.spec_from_file_location(name, file)
    assert spec is not None
    assert spec.loader is not None
    sys.modules[name] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    cls: type[Node] = module.Robot
    return [text.partition(".py:")[2] for text in slips(cls)]  # type: ignore[arg-type]


POSE = '@subscription(PoseStamped, "p")\ndef heard(self, m):\n    '
ADD = '@service(AddTwoInts, "add")\ndef add(self, request, response):\n    '


@pytest.mark.parametrize(
    ("body", "told"),
    [
        (POSE + "print(m.pos.position)", "12: PoseStamped has no field 'pos'; did you mean 'pose'?"),
        (POSE + "print(m.pose.positon.x)", "12: Pose has no field 'positon'; did you mean 'position'?"),
        (POSE + "m.pos = 1", "12: PoseStamped has no field 'pos'; did you mean 'pose'?"),
        (POSE + "m.pose.position.x = 'fast'", "12: Point.x: expected float64, got 'fast'"),
        (
            POSE + "try:\n        if m.pos.x > 1:\n            print(1)\n    except Exception:\n        print(2)",
            "13: PoseStamped has no field 'pos'; did you mean 'pose'?",
        ),
        (ADD + "return AddTwoInts.Response(sum=request.c)", "12: AddTwoInts.Request has no field 'c'"),
        (ADD + "response.result = 1\n    return response", "12: AddTwoInts.Response has no field 'result'"),
        (
            "def go(self, t: Twist):\n    print(t.liner.x)\nasync def on_start(self):\n    self.go(Twist())",
            "11: Twist has no field 'liner'; did you mean 'linear'?",
        ),
    ],
)
def test_a_field_that_is_not_there(tmp_path: Path, body: str, told: str) -> None:
    """Is told with its line: it is set or read, in an argument that the decorator or an annotation types."""
    (text,) = _told(tmp_path, body)
    assert text.startswith(told)


@pytest.mark.parametrize(
    "body",
    [
        POSE + "print(m.pose.position.x, m.header.stamp, m.to_bytes(), m.SCHEMA, m.__class__)",
        POSE + "try:\n        print(m.pos)\n    except AttributeError:\n        pass",
        POSE + "try:\n        x = m.pos\n    except Exception:\n        x = None",
        POSE + "try:\n        if m.pos:\n            print(1)\n    except:\n        print(m.pose)",
        POSE + "print(m.pos if hasattr(m, 'pos') else m.pose)",
        ADD + "response.sum = request.a + request.b\n    return response",
    ],
)
def test_other_attributes(tmp_path: Path, body: str) -> None:
    """Are not told: fields, attributes that every message has, and those that may be missing."""
    assert _told(tmp_path, body) == []


@pytest.mark.parametrize(
    "body",
    [
        POSE + "m = m.pose\n    print(m.position)",
        POSE + "for m in [m.pose]:\n        print(m.position)",
        POSE + "print(list(map(lambda m: m.real, [1])))",
        POSE + "if isinstance(m, Twist):\n        print(m.linear)",
        '@subscription(PoseStamped, "p")\ndef heard(self, m: object):\n    print(m.pos)',
        '@action(Fibonacci, "f")\nasync def count(self, goal):\n    return Fibonacci.Result(sequence=[goal.request.x])',
    ],
)
def test_attributes_of_other_objects(tmp_path: Path, body: str) -> None:
    """Are not told where a name may stand for something else."""
    assert _told(tmp_path, body) == []


KEPT = "def __init__(self):\n    super().__init__('robot')\n    self.command = Twist()\nasync def on_start(self):\n    "


@pytest.mark.parametrize(
    ("body", "told"),
    [
        (KEPT + "self.command.linear.x = 'fast'", ["14: Vector3.x: expected float64, got 'fast'"]),
        (KEPT + "print(self.command.liner)", ["14: Twist has no field 'liner'; did you mean 'linear'?"]),
        (KEPT + "self.command = None\n    self.command.linaer = 1", ["15: Twist has no field 'linaer'"]),
        (KEPT + "self.command.linear.x = 1.0", []),
        (KEPT + "self.command = PoseStamped()\n    print(self.command.pose)", []),
        (KEPT + "for self.command in [PoseStamped()]:\n        print(self.command.pose)", []),
        (KEPT + "self.command = self.other\n    print(self.command.pose)", []),
        (KEPT + "other.command.pose = 1", []),
    ],
)
def test_a_message_of_an_attribute(tmp_path: Path, body: str, told: list[str]) -> None:
    """Its type is known if the attribute is set to no other."""
    texts = _told(tmp_path, body)
    assert len(texts) == len(told)
    assert all(text.startswith(start) for text, start in zip(texts, told, strict=True))


FLAG = """def __init__(self):
    super().__init__("robot")
    self.is_on = False
@subscription({}, "x")
def heard(self, m):
    {}.is_on = m"""


def test_a_message_in_place_of_its_field(tmp_path: Path) -> None:
    """It is told where the attribute is true or false at first."""
    [text] = _told(tmp_path, FLAG.format("Bool", "self"))
    assert text == "15: m is the whole message, which counts as true; write self.is_on = m.data"


@pytest.mark.parametrize(
    ("type_", "owner"), [("String", "self"), ("PointCloud2", "self"), ("Bool", "self.lamp"), ("Bool", "other")]
)
def test_messages_that_are_kept(tmp_path: Path, type_: str, owner: str) -> None:
    """A message without a bool, or with several, may be meant as a whole; others' attributes may be anything."""
    assert _told(tmp_path, FLAG.format(type_, owner)) == []


@pytest.mark.parametrize("names", ["response, request", "request, response"])
def test_a_service_handler_whose_arguments_are_swapped(tmp_path: Path, names: str) -> None:
    """It has one sentence, with the order; in the right order, none."""
    told = _told(tmp_path, f'@service(AddTwoInts, "add")\nasync def add(self, {names}):\n    response.sum = request.a')
    order = "11: a service handler receives the request first: write def add(self, request, response)"
    assert told == ([order] if names.startswith("response") else [])
