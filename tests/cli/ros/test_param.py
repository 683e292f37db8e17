"""`graphflow param`: values as people type them, and the verbs on a node that runs."""

from __future__ import annotations

import json
import shlex
import signal
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from graphflow.cli.main import cli
from graphflow.errors import UsageFault
from graphflow.interface import TYPE_IDS
from graphflow.introspect.parameters import read_value
from tests.cases import slow
from tests.conftest import PROGRAMS, Machine, Program

ROBOT = str(PROGRAMS / "verbs" / "robot.py")
DUMP = """\
/robot:
  ros__parameters:
    count: 3
    extra: 1
    fixed: stays
    flag: 'on'
    gain: 2.0
    limits:
      speed: 1.0
    raw: [1, 255]
    start_type_description_service: true
    title: '5'
    use_sim_time: false
    words: [a, '1']
"""


@pytest.mark.parametrize(
    ("text", "type_", "value"),
    [
        ("200", "int", 200),
        ("-1", "int", -1),
        ("1.5", "int", 1.5),
        ("2", "float", 2.0),
        ("-2", "float", -2.0),
        ("2.5", "float", 2.5),
        ("1e3", "float", 1000.0),
        ("true", "float", True),
        ("fast", "float", "fast"),
        ("true", "bool", True),
        ("False", "bool", False),
        ("on", "bool", True),
        ("Off", "bool", False),
        ("yes", "bool", True),
        ("NO", "bool", False),
        ("1", "bool", 1),
        ("hello", "str", "hello"),
        ("hello world", "str", "hello world"),
        ("'quoted'", "str", "quoted"),
        ('"on"', "str", "on"),
        ("on", "str", "on"),
        ("200", "str", "200"),
        ("true", "str", "true"),
        ("{no: yaml", "str", "{no: yaml"),
        ("a: b", "str", "a: b"),
        ("", "str", ""),
        ("[1, 2]", "list[int]", [1, 2]),
        ("[1, 2.5]", "list[float]", [1.0, 2.5]),
        ("[a, b]", "list[str]", ["a", "b"]),
        ("[true, false]", "list[bool]", [True, False]),
        ("[]", "list[float]", []),
        ("[0, 255]", "bytes", b"\x00\xff"),
        ("[0, 256]", "bytes", [0, 256]),
        ("[true]", "bytes", [True]),
    ],
)
def test_a_value_is_read_as_the_declared_type_wants_it(text: str, type_: Any, value: Any) -> None:
    """Texts need no quotes, whole numbers widen to doubles, bools have their usual words; the node judges the rest."""
    found = read_value(text, TYPE_IDS[type_])
    assert (found, type(found)) == (value, type(value))
    if isinstance(found, list):
        assert [type(item) for item in found] == [type(item) for item in value]


@pytest.mark.parametrize("text", ["{a: 1", "[1, 2", "*a", "'x"])
def test_what_is_no_yaml_is_wrong_usage(text: str) -> None:
    """Invalid YAML is an error before any call."""
    with pytest.raises(UsageFault, match="character"):
        read_value(text, TYPE_IDS["list[int]"])


def start(machine: Machine, folder: Path, *words: str) -> Program:
    return machine.start_python(ROBOT, "--ros-args", *words, cwd=folder)


def ready(program: Program) -> Program:
    program.wait_for("ready")
    return program


@slow
@pytest.mark.real
def test_dump_and_load_restore_everything(machine: Machine, tmp_path: Path) -> None:
    """Values and types come back, numbers in quotes included; what is read-only is no failure when it is the same."""
    ready(start(machine, tmp_path))
    dumped = machine.run("param", "dump", "/robot")
    found = json.loads(machine.look("param", "dump", "/robot", "--json"))
    assert found["node"] == "/robot"
    assert found["parameters"]
    assert dumped == DUMP
    (tmp_path / "p.yaml").write_text(dumped)
    for name, value in (("title", "other"), ("gain", "7.5"), ("words", "[x]"), ("limits.speed", "4"), ("raw", "[7]")):
        assert "successful" in machine.look("param", "set", "/robot", name, value)
    assert machine.look("param", "dump", "/robot") != DUMP

    text = machine.look("param", "load", "/robot", str(tmp_path / "p.yaml"))
    assert "Set parameter title successful" in text
    assert "Parameter fixed is read-only and already has this value" in text
    assert machine.look("param", "dump", "/robot") == DUMP


@slow
@pytest.mark.real
def test_a_wrong_value_in_a_file_fails_alone(machine: Machine, tmp_path: Path) -> None:
    """The other values are set; the reason is printed, and the exit code is 1."""
    ready(start(machine, tmp_path))
    file = tmp_path / "p.yaml"
    file.write_text("robot: {ros__parameters: {gain: 2.3, count: 4, title: 5, nothing: 1}}\n")
    text = machine.look("param", "load", "/robot", str(file), code=1)
    assert "Set parameter gain failed: parameter 'gain' = 2.3 is not a valid step" in text
    assert "Set parameter count successful" in text
    assert "Set parameter title failed: parameter 'title' is of type string, 5 is not" in text
    assert f"{file}:1:" in text
    assert ": node /robot has no parameter 'nothing'" in text

    file.write_text("other: {ros__parameters: {gain: 2.0}}\n")
    text = machine.look("param", "load", "/robot", str(file), code=2)
    assert "p.yaml has nothing for /robot; there is /other" in text
    file.write_text("robt: {ros__parameters: {gain: 2.0}}\n")
    text = machine.look("param", "load", "/robot", str(file), code=2)
    assert f"p.yaml has nothing for /robot; did you mean /robot in place of /robt at {file}:1" in text
    file.write_text("robot: [\n")
    assert "p.yaml:1:9: not valid YAML" in machine.look("param", "load", "/robot", str(file), code=2)
    assert "cannot be read: No such file" in machine.look("param", "load", "/robot", str(tmp_path / "no"), code=2)


@pytest.mark.real
def test_describe_and_delete(machine: Machine, tmp_path: Path) -> None:
    """Descriptions are printed as in ROS 2; only dynamically typed parameters can be deleted."""
    ready(start(machine, tmp_path))
    assert machine.look("param", "describe", "/robot", "gain", "count", "fixed") == (
        "Parameter name: gain\n  Type: double\n  Description: How much. [m]\n  Constraints:\n"
        "    Min value: 0.0\n    Max value: 10.0\n    Step: 0.5\n"
        "Parameter name: count\n  Type: integer\n  Constraints:\n    Additional constraints: more than 0\n"
        "Parameter name: fixed\n  Type: string\n  Constraints:\n    Read only: true\n"
    )
    assert "no parameter 'gian'; did you mean 'gain'?" in machine.look("param", "describe", "/robot", "gian", code=1)
    assert machine.look("param", "delete", "/robot", "extra") == "Deleted parameter successfully\n"
    assert "no parameter 'extra'" in machine.look("param", "get", "/robot", "extra", code=1)
    text = machine.look("param", "delete", "/robot", "title", code=1)
    assert "Deleting parameter failed: parameter 'title' belongs to the node" in text


@slow
@pytest.mark.real
def test_a_node_starts_with_a_params_file(machine: Machine, tmp_path: Path) -> None:
    """The command line overrides the file; a wildcard's unknown parameter is skipped with a note."""
    (tmp_path / "p.yaml").write_text(
        "'/**': {ros__parameters: {unknown: 1}}\n/left/arm: {ros__parameters: {gain: 3.5, count: 9}}\n"
    )
    words = ("--params-file", "p.yaml", "-p", "count:=8", "-r", "__node:=arm", "-r", "__ns:=/left")
    text = ready(start(machine, tmp_path, *words)).text
    assert "p.yaml:1:36: /left/arm has no parameter 'unknown'; it is ignored" in text
    assert machine.look("param", "get", "/left/arm", "gain") == "Double value is: 3.5\n"
    assert machine.look("param", "get", "/left/arm", "count") == "Integer value is: 8\n"


@slow
@pytest.mark.real
@pytest.mark.parametrize(
    ("text", "problem"),
    [
        (
            "robot: {ros__parameters: {gian: 1.0}}",
            "no parameter 'gian' (from p.yaml:1:33); did you mean 'gain'",
        ),
        ("rboot: {ros__parameters: {gain: 1.0}}", "p.yaml:1:1: there is no node /rboot; did you mean '/robot'?"),
        ("robot: {ros__parameters: {gain: 1.1}}", "parameter 'gain' = 1.1 is not a valid step"),
    ],
)
def test_a_wrong_params_file_is_refused(machine: Machine, tmp_path: Path, text: str, problem: str) -> None:
    """A wrong file is an error with place and suggestion, before the node is on the network."""
    (tmp_path / "p.yaml").write_text(text)
    program = start(machine, tmp_path, "--params-file", "p.yaml")
    assert program.wait() == 2
    assert problem in program.text


def test_some_of_a_list(standing: Machine) -> None:
    """`list` is filtered by a pattern or by prefixes."""
    assert standing.look("param", "list", "/office/clerk", "--filter", "sim_time$") == "  use_sim_time\n"
    assert standing.look("param", "list", "/office/clerk", "--param-prefixes", "use_sim") == (
        "no parameter matches; without --filter and --param-prefixes, all are listed\n"
    )
    assert standing.look("param", "list", "/office/clerk", "--param-prefixes", "use_sim_time") == "  use_sim_time\n"
    assert "'(' is not a regular expression" in standing.look("param", "list", "--filter", "(", code=2)


@pytest.mark.parametrize(
    ("words", "node"), [("t.yaml /talker", "/talker"), ("t.yaml", "NODE"), ("t.yml talker --timeout=3", "talker")]
)
def test_a_file_before_the_node(words: str, node: str) -> None:
    """The error has the right command, even if the file does not exist."""
    done = CliRunner().invoke(cli, ["param", "load", *words.split()])
    assert f"the node comes first: graphflow param load {node} {words.split()[0]}" in done.output


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("set rate 20", "write param set NODE PARAMETER VALUE: graphflow param set /talker rate 20"),
        ("set talker rate", "write param set NODE PARAMETER VALUE: graphflow param set talker rate VALUE"),
        ("set talker rate=2.0", "write param set NODE PARAMETER VALUE: graphflow param set talker rate 2.0"),
        ("set /talker rate:=2", "write param set NODE PARAMETER VALUE: graphflow param set /talker rate 2"),
        ("set talker 'rate: [2, 3]'", "graphflow param set talker rate '[2, 3]'"),
        ("set talker '{a.rate: 2}'", "write param set NODE PARAMETER VALUE: graphflow param set talker a.rate 2"),
        ("set talker", "write param set NODE PARAMETER VALUE: graphflow param set talker PARAMETER VALUE"),
        ("set rate", "write param set NODE PARAMETER VALUE: graphflow param set /talker rate VALUE"),
        ("get rate", "write param get NODE PARAMETER: graphflow param get /talker rate"),
        ("delete talker", "write param delete NODE PARAMETER: graphflow param delete talker PARAMETER"),
        ("describe rate", "write param describe NODE PARAMETER: graphflow param describe /talker rate"),
        ("get /talker.rate", "write param get NODE PARAMETER: graphflow param get /talker rate"),
        ("set /talker/rate 2", "write param set NODE PARAMETER VALUE: graphflow param set /talker rate 2"),
        ("get /rate", "write param get NODE PARAMETER: graphflow param get /talker rate"),
        ("set /rate 20", "write param set NODE PARAMETER VALUE: graphflow param set /talker rate 20"),
        ("get rtae", "there is no node 'rtae', nor a parameter of that name; did you mean 'rate'?"),
        ("get use_sim_time", "write param get NODE PARAMETER; 'use_sim_time' is a parameter of /"),
    ],
)
def test_a_word_too_few(standing: Machine, words: str, told: str) -> None:
    """The error has the whole command, with the node that has the parameter."""
    assert told in standing.look("param", *shlex.split(words), code=2)


def test_a_mapping(standing: Machine) -> None:
    """A mapping is not a value: the error has the name of its first parameter."""
    told = standing.look("param", "set", "/talker", "rate", "{x: 2}", code=1)
    assert "{'x': 2} cannot be a parameter: it is a mapping, whose keys are parameters of their own, as in " in told


RCLPY = """\
import rclpy
from rclpy.node import Node

rclpy.init()
node = Node("clocked")
node.declare_parameter("period", 1)
rclpy.spin(node)
"""


@slow
def test_a_double_for_an_integer_of_rclpy(machine: Machine, tmp_path: Path) -> None:
    """ROS's words are followed by the two ways out."""
    (tmp_path / "clocked.py").write_text(RCLPY)
    program = machine.start("run", "clocked.py", cwd=tmp_path)
    machine.until(lambda: "/clocked" in machine.look("node", "list", code=None), "it runs")
    told = machine.look("param", "set", "/clocked", "period", "0.5", code=1)
    assert "Wrong parameter type, expected 'Type.INTEGER' got 'Type.DOUBLE'; write an integer, or have the node" in told
    assert "write an integer" not in machine.look("param", "set", "/clocked", "period", "true", code=1)
    assert program.end(signal.SIGINT) in (0, 130, -2)


SPEEDY = """
import rclpy
from rclpy.node import Node


class Speedy(Node):
    def __init__(self):
        super().__init__("speedy")
        self.declare_parameter("speed", 1.0)
        self.speed = self.get_parameter("speed").value
        self.create_timer(0.1, lambda: self.get_logger().info(f"{self.speed}"))


def main():
    rclpy.init()
    rclpy.spin(Speedy())


main()
"""


@slow
def test_what_the_node_logs_when_it_is_set(machine: Machine, tmp_path: Path) -> None:
    """As that it has no effect."""
    (tmp_path / "speedy.py").write_text(SPEEDY)
    node = machine.start("run", "speedy.py", cwd=tmp_path)
    node.wait_for("1.0")
    told = machine.look("param", "set", "/speedy", "speed", "3.0")
    assert told.startswith("Set parameter successful\n")
    assert "meanwhile /speedy logged a warning: speedy.py:10: 'speed' is set without effect" in told
    node.end(signal.SIGINT)
