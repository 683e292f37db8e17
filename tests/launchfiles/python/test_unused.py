"""Actions that a launch file makes and uses nowhere."""

from __future__ import annotations

import ast
import textwrap

import pytest

from graphflow.launchfiles.python.unused import unused_actions


def told(body: str) -> list[tuple[int, str, str]]:
    text = "def generate_launch_description():\n" + textwrap.indent(textwrap.dedent(body), "    ")
    return list(unused_actions(ast.parse(text)))


def test_actions_that_nothing_reads() -> None:
    """Each is told with its line, and the argument that it declares."""
    [(line, text, argument)] = told(
        "rate = DeclareLaunchArgument('speed', default_value='1')\nreturn LaunchDescription()"
    )
    assert (line, argument) == (2, "speed")
    assert text == "rate is in no description: write LaunchDescription([..., rate])"
    [(line, _, argument)] = told("a = 1\nnode = launch_ros.actions.Node(package='a', executable='b')")
    assert (line, argument) == (3, "")


def test_actions_that_nothing_takes() -> None:
    """They are told as well; other calls may have an effect."""
    [(line, text, argument)] = told("Node(package='a', executable='b')\nld.add_action(Node())\nprint('a')")
    assert (line, argument) == (2, "")
    assert text == "this Node is in no description: put it into LaunchDescription([...])"
    [(_, text, _)] = unused_actions(ast.parse("def setup(context):\n    Node(package='a', executable='b')\n"))
    assert text == "this Node is in no description: write return [Node(...)]"


@pytest.mark.parametrize(
    "body",
    [
        "node = Node()\nif a:\n    ld.add_action(node)",
        "node = Node()\nreturn LaunchDescription([node])",
        "rate = LaunchConfiguration('rate')",
        "global node\nnode = Node()",
        "node = Node()\nreturn LaunchDescription(list(locals().values()))",
        "ld.node = Node()",
        "nodes = [Node()]",
    ],
)
def test_actions_that_something_reads(body: str) -> None:
    """They are left alone, as are substitutions, attributes and lists."""
    assert told(body) == []
