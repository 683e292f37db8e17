"""What the pages say of names: where users import from, which errors there are, which commands are still missing."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterator
from typing import Any

import click
import pytest

import graphflow
import graphflow.description
import graphflow.maps
import graphflow.simulator
import graphflow.tui
from graphflow import errors
from graphflow.cli.main import cli
from tests.conftest import PROJECT
from tests.docs.test_docs import PAGES, blocks

PUBLIC_MODULES = (
    *("graphflow.msgs.", "graphflow.testing.", "graphflow.qos.", "graphflow.bag.", "graphflow.nodes.", "graphflow.tf."),
    *(f"graphflow.description.{name}." for name in graphflow.description.__all__),
    *(f"graphflow.maps.{name}." for name in graphflow.maps.__all__),
    *(f"graphflow.simulator.{name}." for name in graphflow.simulator.__all__),
    *(f"graphflow.tui.{name}." for name in graphflow.tui.__all__),
)
"""What users import beside `graphflow` itself; `graphflow.qos` has ROS 2's named profiles, `tui` the views."""
NODES = sorted((PROJECT / "nodes").rglob("*.py"))


def below_the_top(source: str) -> Iterator[str]:
    """What Python imports from graphflow that users are not meant to know."""
    for statement in ast.walk(ast.parse(source)):
        if isinstance(statement, ast.ImportFrom):
            names = [f"{statement.module}.{alias.name}" for alias in statement.names]
        elif isinstance(statement, ast.Import):
            names = [alias.name for alias in statement.names]
        else:
            continue
        for name in names:
            top, _, rest = name.partition(".")
            is_public = rest in ("", *graphflow.__all__) or f"{name}.".startswith(PUBLIC_MODULES)
            if top == "graphflow" and not is_public:
                yield name


def test_imports_from_below_the_top_are_seen() -> None:
    """In either form, also of a name that the top has."""
    source = "from graphflow.runtime.node import Node\nimport graphflow.errors\nfrom graphflow import machines"
    assert list(below_the_top(source)) == ["graphflow.runtime.node.Node", "graphflow.errors", "graphflow.machines"]
    assert not list(below_the_top("import graphflow\nfrom graphflow import Node\nfrom graphflow.qos import CLOCK"))


def test_users_import_from_the_top() -> None:
    """Pages and example nodes show no import that may move: only `graphflow` and its public modules."""
    for file in (*PAGES, *NODES):
        if file.suffix == ".py":
            sources = [file.read_text(encoding="utf-8")]
        else:
            sources = [block.text for block in blocks(file, "python")]
        assert [name for source in sources for name in below_the_top(source)] == [], file


def test_every_error_is_explained() -> None:
    """The table of errors has each of graphflow's errors, sorted, and no other; it says which are for commands only."""
    page = (PROJECT / "docs" / "errors.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `(\w+)` \| (Commands only: )?", page.partition("## Errors by name")[2], re.MULTILINE)
    every = {
        name
        for name, error in vars(errors).items()
        if inspect.isclass(error) and issubclass(error, errors.GraphflowError)
    }
    assert [name for name, _ in rows] == sorted(every)
    assert {name for name, is_for_commands in rows if not is_for_commands} == every & set(graphflow.__all__)


def has_command(words: str) -> bool:
    """Whether `graphflow WORDS` is a command."""
    command: Any = cli
    for word in words.split():
        command = command.get_command(None, word) if hasattr(command, "get_command") else None
    return command is not None


def missing_commands(page: str) -> Iterator[str]:
    """The commands that a dictionary's rows call missing: `ros2 topic hz`, `bw` are `topic hz` and `topic bw`."""
    for cell in re.findall(r"^\| (`ros2 [^|]*) \| not yet", page, re.MULTILINE):
        noun = ""
        for words in re.findall(r"`([^`]*)`", cell):
            if words.startswith("ros2 "):
                noun, _, words = words.removeprefix("ros2 ").removesuffix(" ...").partition(" ")
            yield f"{noun} {words}".strip()


def test_commands_that_are_missing_are_seen() -> None:
    """Of each row that says so, in whatever form."""
    page = "| `ros2 topic hz`, `bw` | not yet; or so |\n| `ros2 bag ...` | not yet |\n| `ros2 run` | `graphflow run` |"
    assert list(missing_commands(page)) == ["topic hz", "topic bw", "bag"]


def test_what_is_not_there_yet_is_not_there() -> None:
    """No command that the dictionary for people from ROS 2 calls missing is one of graphflow's."""
    missing = set(missing_commands((PROJECT / "docs" / "coming-from-ros2.md").read_text(encoding="utf-8")))
    assert [words for words in missing if has_command(words)] == []
    assert has_command("action send_goal")
    assert not has_command("action sing")


@pytest.mark.parametrize("file", ["README.md", "CHANGELOG.md"])
def test_every_command_is_listed(file: str) -> None:
    """The list of what there is names each of graphflow's commands."""
    text = (PROJECT / file).read_text(encoding="utf-8")
    assert [verb for verb in cli.list_commands(click.Context(cli)) if f"`{verb}`" not in text] == []
