"""Next steps for errors about names."""

from __future__ import annotations

import os
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
import std_msgs

import rclpy
from graphflow.msgs import registry
from graphflow.rclpy.messages import finder
from rclpy.node import Node
from tests.cases import slow
from tests.rclpy.hinted import hint_of


@slow
@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("from std_msgs.msg import Twist", "Twist is in geometry_msgs.msg: from geometry_msgs.msg import Twist"),
        ("from example_interfaces.msg import AddTwoInts", "AddTwoInts is in example_interfaces.srv: from example_in"),
        ("from std_msgs.msg import Strin", "did you mean 'String'?"),
        ("from std_msgs.msg import Xylophone", ""),
        ("from rclpy import Node", "Node is in rclpy.node: from rclpy.node import Node"),
        ("from rclpy import ActionServer", "ActionServer is in rclpy.action: from rclpy.action import ActionServer"),
        ("from os import Node", ""),
        ("from rclpy.node import node", "did you mean 'Node'?"),
        (
            "from rclpy.qos import BEST_EFFORT",
            "BEST_EFFORT is a value of ReliabilityPolicy: import that, and write ReliabilityPolicy.BEST_EFFORT",
        ),
    ],
)
def test_imports(node: Node, line: str, sentence: str) -> None:
    """The module is named that has it."""
    found = hint_of(lambda: exec(line, {}))
    assert found.startswith(sentence) if sentence else found == ""


HEAD = """\
from rclpy.node import Node

class Lamp(Node):
    def __init__(self):
        super().__init__("lamp")
        self.count, self.pose = 0, None

    def hear(self, message):
        self.pose = message

"""
LAMPS = [
    ("def tick(self):\n    count += 1", "write self.count"),
    ("def tick(self):\n    create_timer(1.0, self.hear)", "write self.create_timer"),
    ("def tick(self):\n    colour", ""),
    (
        "def tick(self):\n    print(self.pose.x)",
        "self.pose is None until hear (lamp.py:8) sets it: write if self.pose is None: return",
    ),
    ("def tick(self):\n    print(None.x)", ""),
    (
        "def tick(self):\n    print(self.later)\ndef on_later(self):\n    self.later = 1",
        "self.later is not there until on_later (lamp.py:13) sets it: write self.later = None in __init__, and here if "
        "self.later is None: return",
    ),
    (
        "def tick(self):\n    def blink(self):\n        pass\n    self.blink",
        "blink (lamp.py:12) is inside tick: indent it like tick itself",
    ),
    (
        "def tick(self):\n    self.set()\n    self.pub.publish(1)\ndef set(self):\n    pub = 1",
        "pub is a local variable of set (lamp.py:14): write self.pub there",
    ),
    (
        "def tick(self):\n    self.pub = self.create_rate(1.0),\n    self.pub.publish(1)",
        "self.pub is a tuple because of the comma after its value: remove the comma",
    ),
    (
        "def tick(self):\n    from rclpy.wait_for_message import wait_for_message\n"
        "    from std_msgs.msg import Int32\n"
        "    pose = wait_for_message(Int32, self, '/count', time_to_wait=0.01)\n    pose.x",
        "wait_for_message returns whether a message came, too: write ok, pose = ...",
    ),
    ("def tick(self):\n    r = self.hear\n    r.sum", "r is a function: call it, as in r().sum"),
    (
        "def tick(self):\n    self.t = self.create_timer(9.0, self.hear)\n    self.hear.cancel()",
        "self.hear is a callback, which has no cancel: write self.t.cancel()",
    ),
    (
        "def tick(self):\n    self.hear.reset()",
        "self.hear is a callback, which has no reset: keep the result of create_timer(...), and call its reset()",
    ),
    ("def tick(self):\n    'Hello ' + self.count", "format it: f'... {value}', or str(value)"),
    (
        "def tick(self):\n    import rclpy\n    class Light(rclpy.node):\n        pass",
        "rclpy.node is a module, and no class: from rclpy.node import Node, and write Node in place of rclpy.node",
    ),
    ("def tick(self):\n    import os\n    class Light(os):\n        pass", "os is a module, and no class"),
    ("def tick(self):\n    TransformListener(None, self)", "write from tf2_ros import TransformListener"),
    ("def tick(self):\n    tf_transformations.quaternion_from_euler(0, 0, 1)", "write import tf_transformations"),
    (
        "def tick(self):\n    quaternion_from_euler(0, 0, 1)",
        "write from tf_transformations import quaternion_from_euler",
    ),
    (
        "def tick(self):\n    span = self.get_clock().now() - self.get_clock().now()\n    1.0 / span",
        "span is a Duration: write (span.nanoseconds / 1e9), its seconds",
    ),
    ("def tick(self):\n    n = [1, 2]\n    n[2]", "n has 2 values, [0] to [1]"),
    (
        "def tick(self):\n    from array import array\n    near = array('f', [1.0]) < 2.0",
        "that is a whole array: compare an element, as in ranges[0], or min(ranges)",
    ),
    (
        "def tick(self):\n    from rcl_interfaces.msg import ParameterDescriptor\n"
        "    self.declare_parameter('rate', None, ParameterDescriptor(dynamic_typing=True))\n"
        "    rate = self.get_parameter('rate').value\n    1.0 / rate",
        "the parameter 'rate' has no value: declare it with one, declare_parameter('rate', 1.0)",
    ),
    ("def tick(self):\n    rate = None\n    1.0 / rate", ""),
    ("print(Lamp)", "this line is inside class Lamp: indent it less"),
]


@pytest.mark.parametrize(("body", "sentence"), LAMPS)
def test_names_in_a_class(node: Node, tmp_path: Path, body: str, sentence: str) -> None:
    """What is meant is found in the class, and in what the node has."""
    file, space = tmp_path / "lamp.py", {"__name__": "lamp"}
    source = HEAD + "".join(f"    {line}\n" for line in body.splitlines())
    file.write_text(source)

    def run() -> None:
        exec(compile(source, str(file), "exec"), space)
        made: Any = space["Lamp"]
        made().tick()

    assert hint_of(run) == sentence


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("rclpy.init_node('name')", "write rclpy.init(), and node = rclpy.create_node('name')"),
        ("rclpy.nonsense", ""),
        ("std_msgs.String", "String is in std_msgs.msg: from std_msgs.msg import String"),
        ("std_msgs.Strung", ""),
        ("os.nonsense", ""),
        ("geometry_msgs.msg.Twist", "write import geometry_msgs.msg"),
        ("geometry_msgs.message", ""),
    ],
)
def test_attributes_of_modules(node: Node, line: str, sentence: str) -> None:
    """Names of ROS 1's, and of interfaces, are found."""
    known = {"rclpy": rclpy, "std_msgs": std_msgs, "os": os, "geometry_msgs": ModuleType("geometry_msgs")}
    assert hint_of(lambda: eval(line, known)) == sentence


def test_an_init_that_is_none(node: Node, tmp_path: Path) -> None:
    """With one underscore, or as `__int__`."""
    for name in ("_init_", "__int__"):
        file = tmp_path / "lamp.py"
        head = "from rclpy.node import Node\n\nclass Lamp(Node):\n"
        source = f"{head}    def {name}(self):\n        super().__init__('lamp')\n\nLamp()\n"
        file.write_text(source)
        assert hint_of(lambda s=source, f=file: exec(compile(s, str(f), "exec"), {"__name__": "lamp"})) == (  # type: ignore[misc]
            f"Lamp has {name} (lamp.py:4): write __init__"
        )


def test_a_definition_that_must_be_called_otherwise(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Comes before those of other packages that have the name."""
    (tmp_path / "srv").mkdir()
    for name in ("add_two_ints", "Other"):
        (tmp_path / "srv" / f"{name}.srv").write_text("---\n")
    monkeypatch.setattr(registry, "_packages", {"hint_snake": tmp_path})
    monkeypatch.setitem(finder.KNOWN, "hint_snake", str(tmp_path))

    def run() -> None:
        exec("from hint_snake.srv import AddTwoInts", {})

    right = f"{tmp_path}/srv/AddTwoInts.srv: names of interfaces are in camel case"
    assert hint_of(run) == f"{tmp_path}/srv/add_two_ints.srv must be {right}"
