"""What a newcomer gets wrong, and what is said: the table of `docs/mistakes.md`.

`GRAPHFLOW_SNAPSHOTS=write python -m pytest tests/runtime/test_mistakes.py` writes the table anew.
"""

from __future__ import annotations

import logging
import os
import re
import sys
import textwrap
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

from graphflow.errors import GraphflowError
from graphflow.runtime import unawaited
from graphflow.runtime.surroundings import Surroundings, make_within
from graphflow.supervisor.classes import import_class
from graphflow.testing import Graph
from tests.conftest import PROJECT

PAGE = PROJECT / "docs" / "mistakes.md"
HEAD = """\
from graphflow import ActionClient, Client, Node, Param, Publisher, action, service, subscription, timer
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import String
"""


class Mistake(NamedTuple):
    """Something that is written wrongly: the body of the class, or an import; and the line that the table shows."""

    code: str
    shown: str


def body(code: str, shown: str = "") -> Mistake:
    return Mistake(code, shown or code)


def init(line: str) -> Mistake:
    """A line of an `__init__`."""
    methods = "def tick(self):\n    pass\nasync def soon(self):\n    pass\n"
    return Mistake(f"{methods}def __init__(self):\n    super().__init__()\n    {line}", line)


def ticking(line: str) -> Mistake:
    """A line of a timer."""
    held = "goals = ActionClient(Fibonacci, 'fibonaci')\nadder = Client(AddTwoInts, 'ad')\n"
    held += "words = Publisher(String, 'words')\nrate = Param(1.0, gt=0.0)\n"
    served = "@service(AddTwoInts, 'add')\ndef add(self, request):\n    return True\n"
    return Mistake(f"{held}{served}@timer(0.1)\nasync def tick(self):\n    {line}", line)


def imported(line: str) -> Mistake:
    return Mistake(line, line)


MISTAKES = {
    "when the file is imported": [
        imported("import rclpy"),
        imported("from std_msgs.msg import String"),
        imported("from graphflow.msgs.std_msg.msg import String"),
        imported("from graphflow.msgs.std_msgs.msg import Strin"),
        imported("from graphflow import GoalResponse"),
        body("@timer\ndef tick(self): ...", "@timer"),
        body("@timer(0)\ndef tick(self): ...", "@timer(0)"),
        body("@timer(hz='fast')\ndef tick(self): ...", "@timer(hz='fast')"),
        body('@subscription("chatter", String)\ndef heard(self, message): ...', '@subscription("chatter", String)'),
        body('@subscription(String, "chatter")\ndef heard(self): ...', "def heard(self): ..."),
        body('@service(AddTwoInts.Request, "add")\ndef add(self, request): ...', '@service(AddTwoInts.Request, "add")'),
        body('@service(AddTwoInts, "add")\ndef add(self): ...', "def add(self): ..."),
        body(
            '@action(Fibonacci, "count", goal_callback=print)\ndef count(self, goal): ...',
            '@action(Fibonacci, "count", goal_callback=...)',
        ),
        body("goals = ActionClient('fibonacci', Fibonacci)"),
        body("rate = Param(1.0, min=0.0)"),
        body("@timer(1.0, thread=True)\nasync def tick(self): ...", "@timer(1.0, thread=True)"),
        body("@timer(1.0, group=2)\ndef tick(self): ...", "@timer(1.0, group=2)"),
        body("words = Publisher(String, 'my words')"),
        body("rate = Param(0.0, gt=0.0)"),
        body("clock = Param(1.0)"),
        body("def offload(self): ..."),
        body('dynamic_names = ("output",)'),
        body("enable = False\n@service(AddTwoInts, 'enable')\ndef enable(self, request): ...", "enable = False"),
    ],
    "when the node is made": [
        body("def __init__(self):\n    self.x = 1", "def __init__(self): self.x = 1"),
        body("def __init__(self, port):\n    super().__init__()", "def __init__(self, port):"),
        init("self.create_timer(self.tick, 1.0)"),
        init("self.create_timer(1.0, self.soon())"),
        init('self.create_publisher("chatter", String, 10)'),
        init('self.create_subscription(String, "chatter", self.tick, 10)'),
        init('self.create_publisher(String, "my words", 10)'),
        init('self.declare_parameter("rate", None)'),
        init('self.get_parameter("rate")'),
        init('self.declare_parameter("rate", 1.0); self.rate'),
        init('self.declare_parameter("rate", 1.0, "a descriptor")'),
        init('ActionClient(self, Fibonacci, "fibonacci")'),
        init('self.create_action_server(Fibonacci, "count", self.tick, goal_callback=print)'),
    ],
    "when it runs": [
        ticking("self.adder.call(AddTwoInts.Request())"),
        ticking("await self.adder.call(AddTwoInts.Request())"),
        ticking("await self.adder.call_async(AddTwoInts.Request())"),
        ticking("self.adder.wait_for_service(1.0)"),
        ticking('self.log.info("error", 0.5)'),
        ticking('self.get_logger().info("hello")'),
        ticking("self.words.publish(String(data=5))"),
        ticking('self.words.publish("hello")'),
        ticking('self.rate = "fast"'),
        ticking("self.rate = -1.0"),
        ticking("Fibonacci(order=3)"),
        ticking("Fibonacci.Goal(ordr=3)"),
        ticking("Fibonacci.Goal(3)"),
        ticking("Fibonacci.Goal().ordr"),
        ticking("goal = await self.goals.send(Fibonacci.Goal())"),
        ticking("goal = self.goals.send(Fibonacci.Goal()); goal.feedback"),
        ticking("goal = await self.goals.send_goal(Fibonacci.Goal())"),
        ticking('await self.create_client(AddTwoInts, "add").call(AddTwoInts.Request())'),
    ],
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Where modules are imported from; what is imported is forgotten, and so are forgotten awaits that were told."""
    monkeypatch.syspath_prepend(str(tmp_path))
    former = warnings._warn_unawaited_coroutine  # type: ignore[attr-defined]
    unawaited._told.clear()
    unawaited.watch()
    yield tmp_path
    warnings._warn_unawaited_coroutine = former  # type: ignore[attr-defined]
    sys.modules.pop("slide", None)


async def what_is_said(mistake: Mistake, file: Path, graph: Graph, caplog: pytest.LogCaptureFixture) -> str:
    """The first thing that importing, making or running the node says."""
    if mistake.code.startswith(("import", "from")):
        text = f"{HEAD}{mistake.code}\n\n\nclass Slide(Node): ...\n"
    else:
        text = f"{HEAD}\n\nclass Slide(Node):\n{textwrap.indent(mistake.code, '    ')}\n"
    file.write_text(text)
    module = file.stem
    try:
        cls = import_class(f"{module}:Slide")
        cls.interface()  # as every command does
        node = make_within(cls, Surroundings(), "slide")
    except (GraphflowError, AttributeError) as error:
        return str(error)
    caplog.clear()
    await graph.start(node)
    for _ in range(100):
        await graph.clock.advance(0.05)
        if caplog.messages:
            break
    said = caplog.messages[0]
    await graph.stop(node)
    return said


def cleaned(text: str, file: Path) -> str:
    """The first line, without what differs from machine to machine, as a cell of a table."""
    text = text.replace(str(file), "slide.py").replace(file.stem, "slide").split("\n")[0]
    text = re.sub(r" at 0x[0-9a-f]+", "", text)
    return re.sub(r"(there is )/\w+/\w+.*", r"\1...", text).replace("|", "\\|").replace("*", "\\*")


@pytest.mark.usefixtures("graphflow_runner")
async def test_the_table(folder: Path, graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Every mistake is answered as the page shows."""
    caplog.set_level(logging.INFO, "graphflow")
    parts, number = [], 0
    for when, mistakes in MISTAKES.items():
        rows = []
        for mistake in mistakes:
            file = folder / f"slide_number_{(number := number + 1)}.py"  # linecache and ast remember files by name
            said = cleaned(await what_is_said(mistake, file, graph, caplog), file)
            rows.append(f"| `{mistake.shown}` | {said} |")
        parts.append(f"## Told {when}\n\n| written | said |\n|---|---|\n" + "\n".join(rows) + "\n")
    table = "\n".join(parts)
    if os.environ.get("GRAPHFLOW_SNAPSHOTS") == "write":
        page = PAGE.read_text(encoding="utf-8")
        PAGE.write_text(page[: page.index("## Told ")] + table, encoding="utf-8")
    assert PAGE.read_text(encoding="utf-8").endswith(table)


def test_there_are_enough() -> None:
    """Each once."""
    shown = [mistake.shown for mistakes in MISTAKES.values() for mistake in mistakes]
    assert len(shown) == len(set(shown)) >= 30
