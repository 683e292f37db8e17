"""ROS arguments that have changed nothing."""

from __future__ import annotations

from pathlib import Path

import pytest
from std_msgs.msg import String
from std_srvs.srv import Trigger

import rclpy
from rclpy.exceptions import InvalidParameterTypeException
from rclpy.impl.mistakes import unused
from rclpy.impl.mistakes.unused import Unused
from rclpy.node import Node

Caplog = pytest.LogCaptureFixture


class Lamp(Node):
    """Has names and a parameter."""

    def __init__(self, name: str = "lamp") -> None:
        super().__init__(name)
        self.declare_parameter("level", 1)
        self.create_publisher(String, "light", 10)
        self.create_publisher(String, "arm/pose", 10)
        self.create_client(Trigger, "switch")


def told(caplog: Caplog) -> list[str]:
    return [r.getMessage() for r in caplog.records if r.name == "graphflow" and r.levelname == "WARNING"]


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("-r lihgt:=sun", "the remap lihgt:=sun matches no name of /lamp; did you mean 'light'?"),
        ("-r arm:=leg", "the remap arm:=leg matches no name of /lamp; a rule has whole names: arm/pose:=leg/pose"),
        ("-r lamp:=sun", "the remap lamp:=sun matches no name of /lamp; to rename the node: -r __node:=sun"),
        ("-r level:=3", "the remap level:=3 matches no name of /lamp; to set the parameter: -p level:=3"),
        ("-r lamp:lihgt:=sun", "the remap lamp:lihgt:=sun matches no name of /lamp; did you mean 'light'?"),
        ("-p levle:=3", "-p levle:=3 sets nothing: /lamp declares no such parameter; did you mean 'level'?"),
        ("-p lmap:level:=3", "-p lmap:level matches no node; did you mean 'lamp'?"),
        ("--params-file {file}", "{file}:1:1: there is no node /lmap; did you mean '/lamp'?"),
        ("-r light:=sun -r switch:=knob -p level:=3 -p lamp:level:=2 -r __ns:=/attic", ""),
    ],
)
def test_what_no_node_has_used(caplog: Caplog, tmp_path: Path, line: str, text: str) -> None:
    """It is told when the node leaves, with what is near."""
    file = tmp_path / "lamp.yaml"
    file.write_text("lmap:\n  ros__parameters: {level: 2}\n")
    rclpy.init(args=["--ros-args", *line.format(file=file).split()])
    Lamp().destroy_node()
    assert told(caplog) == ([text.format(file=file)] if text else [])


@pytest.mark.parametrize(
    ("section", "text"),
    [
        ("lamp", "levle sets nothing: /lamp declares no such parameter; did you mean 'level'?"),
        ("/**", "levle sets nothing: /lamp declares no such parameter; did you mean 'level'?"),
        ("lamp", "colour sets nothing: /lamp declares no such parameter; there is level"),
        ("/**", "colour"),
        ("lamp", "level"),
        ("lamp", "qos_overrides./light.publisher.depth"),
    ],
)
def test_a_parameter_of_a_file(caplog: Caplog, tmp_path: Path, section: str, text: str) -> None:
    """It is told with its line, if its node declares no such one; a section for many nodes may have others'."""
    file = tmp_path / "lamp.yaml"
    file.write_text(f"{section}:\n  ros__parameters:\n    {text.split()[0]}: 2\n")
    rclpy.init(args=["--ros-args", "--params-file", str(file)])
    Lamp().destroy_node()
    assert told(caplog) == ([f"{file}:3:{'12' if 'levle' in text else '13'}: {text}"] if "sets" in text else [])


def test_it_is_told_while_nodes_run(caplog: Caplog, monkeypatch: pytest.MonkeyPatch) -> None:
    """Once, of all nodes together, when they have had time from the first spin on to make their names."""
    monkeypatch.setattr(unused, "WARN_AFTER", 0.0)
    rclpy.init(args=["--ros-args", "-r", "one:light:=sun", "-r", "lihgt:=sun"])
    one, other = Lamp("one"), Lamp("other")
    life = one.context.life
    assert life is not None
    found = Unused(life)
    found.check()
    assert told(caplog) == []
    rclpy.spin_once(other, timeout_sec=0)
    found.check()
    found.check()
    assert told(caplog).count("the remap lihgt:=sun matches no name of /one or /other; did you mean 'light'?") >= 1
    assert not [text for text in told(caplog) if "one:light" in text]


def test_what_is_free(caplog: Caplog) -> None:
    """A node that takes undeclared parameters has all."""
    rclpy.init(args=["--ros-args", "-p", "colour:=3"])
    Node("free", allow_undeclared_parameters=True).destroy_node()
    assert told(caplog) == []


def test_a_declaration_that_is_refused(caplog: Caplog) -> None:
    """It is no missing one; nor is one that was taken back."""
    rclpy.init(args=["--ros-args", "-p", "level:=high", "-p", "colour:=red"])
    with pytest.raises(InvalidParameterTypeException):
        Lamp()
    node = Node("other")
    node.declare_parameter("colour", "blue")
    node.undeclare_parameter("colour")
    node.destroy_node()
    assert told(caplog) == []


def test_a_program_that_ends_in_an_error(caplog: Caplog) -> None:
    """Has not made all that its arguments are for."""
    rclpy.init(args=["--ros-args", "-p", "colour:=red", "-r", "lihgt:=sun"])
    node = Lamp()
    with pytest.raises(ZeroDivisionError):
        try:
            1 / 0  # noqa: B018
        finally:
            node.destroy_node()
    assert told(caplog) == []
