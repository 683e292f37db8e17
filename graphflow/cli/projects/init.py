"""`graphflow init NAME`: write a starter project."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import click

from graphflow.cli import output
from graphflow.cli.projects.new_names import hidden_module, is_of_python, near_name
from graphflow.errors import UsageFault

_NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
_FILES = {
    "pyproject.toml": """\
[project]
name = "@name"
version = "0.1.0"
requires-python = ">=3.11"
dependencies = ["graphflow-zenoh"]

[project.optional-dependencies]
dev = ["pytest"]

[project.entry-points."graphflow.nodes"] # nodes that `graphflow run NAME` starts, here and once installed
greeter = "@name.greeter:Greeter"

[build-system]
requires = ["hatchling>=1.26"]
build-backend = "hatchling.build"

[tool.hatch.build.targets.wheel]
packages = ["@name"]

[tool.hatch.build.targets.wheel.force-include]
graphs = "@name/graphs"
interfaces = "@name/interfaces"

[tool.pytest.ini_options]
testpaths = ["tests"]
pythonpath = ["."]

[tool.mypy]
mypy_path = "typings" # where `graphflow interface stubs` writes stubs for editors
""",
    "README.md": """\
# @name

    pip install @requirement -e '.[dev]'

installs what it needs, once. Then:

    graphflow up graphs/@name.yaml       run it, until Ctrl-C
    graphflow run greeter                run the one node
    graphflow topic echo /greeting       in a second terminal: show its messages
    graphflow param set /greeter rate 5  change it while it runs
    python -m pytest                     test it, with no network and no waiting

`@name/` has the nodes, `graphs/` defines which of them run together, `interfaces/` has your own message and service
types: save a file there and import it. A node that `pyproject.toml` lists in `graphflow.nodes` can be run by name, also
after installing this project's wheel: `graphflow run greeter`, `graphflow up @name`.
""",
    "interfaces/@name_interfaces/msg/Greeting.msg": """\
string text
uint32 count
""",
    "@name/__init__.py": "",
    "@name/greeter.py": '''\
"""A node: its parameters, its publisher and its timer."""

import graphflow
from graphflow import Node, Param, Publisher, timer
from graphflow.msgs.@name_interfaces.msg import Greeting


class Greeter(Node):
    """Publishes a greeting at regular intervals."""

    rate = Param(1.0, unit="Hz", gt=0.0, doc="Greetings per second.")
    text = Param("hello", doc="Text of the greeting.")
    greeting = Publisher(Greeting, "greeting")
    count = 0

    @timer(hz=rate)
    async def greet(self) -> None:
        self.count += 1
        self.greeting.publish(Greeting(text=self.text, count=self.count))
        self.log.info("%s, time %d", self.text, self.count)


if __name__ == "__main__":
    graphflow.run(Greeter)
''',
    "graphs/@name.yaml": """\
# yaml-language-server: $schema=graph.schema.json
args:
  text: {default: hello, doc: Text of the greeting.}

nodes:
  greeter:
    class: @name.greeter:Greeter
    params: {text: $(var text), rate: 2.0}
""",
    "tests/test_greeter.py": """\
from graphflow.msgs.@name_interfaces.msg import Greeting
from graphflow.testing import Graph

from @name.greeter import Greeter


async def test_it_greets_twice_a_second(graph: Graph) -> None:
    await graph.start(Greeter(rate=2.0, text="hi"))
    heard = graph.tap(Greeting, "/greeting")

    await graph.clock.advance(1.0)

    assert [(m.text, m.count) for m in heard] == [("hi", 1), ("hi", 2)]
""",
    ".gitignore": "__pycache__/\n.venv/\n.pytest_cache/\n",
}
"""The files of a new project; `@name` stands for its name."""


@click.command()
@click.argument("name")
def init(name: str) -> None:
    """Write a starter project: the folder NAME with a node, a graph, a message type and a passing test.

    `.` is the current folder, if it is empty.
    """
    folder = Path(name)
    check_new(folder)
    for file in write_project(folder):
        output.data(f"  {file}")
    go_there = "" if folder == Path() else f"  cd {folder}\n"
    output.talk(f"next:\n{go_there}  graphflow up graphs/{folder.resolve().name}.yaml")


def check_new(folder: Path) -> None:
    """Check that a project can be created in a folder.

    Raises:
        UsageFault: The name is not one of a project, or the folder exists and is not empty.
    """
    word = folder.resolve().name
    is_full = folder.exists() and (not folder.is_dir() or any(folder.iterdir()))
    if is_full and folder == Path():
        raise UsageFault("this folder is not empty; graphflow init NAME creates a new one")
    if not _NAME.fullmatch(word):
        rule = "a project's name has only lower-case letters, digits and single _, and begins with a letter"
        raise UsageFault(f"{word!r}: {rule}; did you mean {near_name(word)!r}?")
    if is_full:
        raise UsageFault(f"{folder} already exists; choose another name or remove it")
    if owner := hidden_module(word):
        meant = near_name(word) if is_of_python(word) else f"my_{word}"
        raise UsageFault(f"{word!r} is {owner}, which yours would hide; did you mean {meant!r}?")


def write_project(folder: Path) -> Iterator[Path]:
    """Write a project and yield each of its files."""
    from graphflow.graph.schema import schema_text
    from graphflow.introspect.installation import requirement

    word = folder.resolve().name
    for path, text in _FILES.items():
        file = folder / path.replace("@name", word)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text.replace("@name", word).replace("@requirement", requirement()), encoding="utf-8")
        yield file
    schema = folder / "graphs" / "graph.schema.json"
    schema.write_text(schema_text(), encoding="utf-8")
    yield schema
