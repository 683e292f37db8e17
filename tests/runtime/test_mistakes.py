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
from graphflow.runtime.mistakes import unawaited
from graphflow.runtime.mistakes.errors.attribute_errors import explain
from graphflow.runtime.node_options import NodeOptions, make_within
from graphflow.supervisor.launching.classes import import_class
from graphflow.testing import Graph
from tests.cases import slow
from tests.conftest import PROJECT

PAGE = PROJECT / "docs" / "mistakes.md"
HEAD = """\
import asyncio
import time
from graphflow import ActionClient, Client, Durability, Group, Node, Param, Publisher, Qos, Subscription, Time, Timer
from graphflow import action, service, subscription, task, timer
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import Header, String
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
    held += "heard = Subscription(String, 'words')\n"
    served = "@service(AddTwoInts, 'add')\ndef add(self, request):\n    return True\n"
    return Mistake(f"{held}{served}@timer(0.1)\nasync def tick(self):\n    {line}", line)


def asked(line: str) -> Mistake:
    """A line of a service that a timer calls."""
    served = f"@service(AddTwoInts, 'add')\nasync def add(self, request):\n    {line}\n"
    asks = "@timer(0.1)\nasync def tick(self):\n    await self.adder.call(AddTwoInts.Request())"
    return Mistake(f"adder = Client(AddTwoInts, 'add')\n{served}{asks}", line)


def imported(line: str) -> Mistake:
    return Mistake(line, line)


MISTAKES = {
    "when the file is imported": [
        imported("import rclpy"),
        imported("from std_msgs.msg import String"),
        imported("from graphflow.msgs.std_msg.msg import String"),
        imported("from graphflow.msgs.std_msgs.msg import Strin"),
        imported("from graphflow import GoalResponse"),
        imported("from graphflow import node"),
        imported("from graphflow import subscriber"),
        imported("from graphflow import Rate"),
        imported("from graphflow.node import Node"),
        imported("from graphflow.msg.std_msgs.msg import String"),
        body("def on_start(self): ..."),
        body("rate = Param(1.0)\n@timer(hz=self.rate)\ndef tick(self): ...", "@timer(hz=self.rate)"),
        body("rate = Param(1.0)\n@rate.setter\ndef set_rate(self, value): ...", "@rate.setter"),
        body("rate = Param(1.0)\n@rate.on_change()\ndef changed(self, old, new): ...", "@rate.on_change()"),
        body('words = Publisher(String, "words", Qos(deadline=0.1))'),
        body(
            'def fits(self): ...\n@action(Fibonacci, "count", accept=fits)\nasync def count(self, goal): ...',
            "def fits(self): ..., then accept=fits",
        ),
        body("@timer\ndef tick(self): ...", "@timer"),
        body("@timer(0)\ndef tick(self): ...", "@timer(0)"),
        body(
            'rate = Param(10.0, unit="Hz")\n@timer(rate)\ndef tick(self): ...',
            'rate = Param(10.0, unit="Hz"), then @timer(rate)',
        ),
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
        body("rate = Param(ge=0.0)"),
        body("rate = Param(1.0, range=(0.0, 5.0))"),
        body("rate = Param(1.0, ge=5.0, le=2.0)"),
        body("rates = Param([])"),
        body("words = Publisher(String)"),
        body("words = Publisher(AddTwoInts, 'words')"),
        body("words = Subscription(String, 'words', lambda message: None)"),
        body(
            "@subscription(String, 'words', queue_size=10)\ndef heard(self, m): ...",
            "@subscription(..., queue_size=10)",
        ),
        body("@subscription(String, 'words', '10')\ndef heard(self, m): ...", "@subscription(String, 'words', '10')"),
        body(
            "@subscription(String, 'words', 'best_effort')\ndef heard(self, m): ...",
            "@subscription(..., 'best_effort')",
        ),
        body('words = Publisher(String, "words", Durability.TRANSIENT_LOCAL)'),
        body('words = Publisher(String, "words", Qos(lifespan_ns=500))'),
        body(
            'robot = Param("r1")\n@subscription(String, f"{robot}/in")\ndef heard(self, m): ...',
            'robot = Param("r1"), then @subscription(String, f"{robot}/in")',
        ),
        body("@Subscription(String, 'words')\ndef heard(self, m): ...", "@Subscription(String, 'words')"),
        body("@Timer(0.5)\ndef tick(self): ...", "@Timer(0.5)"),
        imported("from graphflow import Service"),
        body("@task()\nasync def work(self): ...", "@task()"),
        body("@service(AddTwoInts)\ndef add(self, request): ...", "@service(AddTwoInts)"),
        body("words = Publisher(String, 'my words')"),
        body("rate = Param(0.0, gt=0.0)"),
        body("clock = Param(1.0)"),
        body('name = "talker"'),
        body("log = []"),
        body("def offload(self): ..."),
        body('dynamic_names = ("output",)'),
        body("words = Publisher('std_msgs/msg/String', 'words')"),
        body(
            "rate = Param(1.0)\n@rate.check\ndef rate(self, value): ...\n@timer(hz=rate)\ndef tick(self): ...",
            "@rate.check def rate(self, value): ..., then @timer(hz=rate)",
        ),
        body('words = Publisher(String, "words"),'),
        body('words: Publisher(String, "words")'),
        body('outs = [Publisher(String, f"out{i}") for i in range(3)]'),
        body("@staticmethod\n@timer(1.0)\ndef tick(self): ...", "@staticmethod above @timer(1.0)"),
        body(
            "def noisy(fn): return lambda *args: fn(*args)\n@noisy\n@timer(1.0)\ndef tick(self): ...",
            "@noisy above @timer(1.0)",
        ),
        body('words = Publisher(String, "words", Qos(durability="transient_local"))'),
        body('words = Publisher(String, "words", Qos(deadline_ns=0.1))'),
        body('@service(AddTwoInts, "add")\ndef add(self, request) -> int: ...', "def add(self, request) -> int: ..."),
        body(
            '@service(AddTwoInts, "add")\ndef one(self, request): ...\n'
            '@service(AddTwoInts, "add")\ndef two(self, request): ...',
            '@service(AddTwoInts, "add"), twice',
        ),
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
        init('self.create_publisher(String, "//words", 10)'),
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
        body("async def on_strat(self): ...", "async def on_strat(self): ..."),
        body("async def on_configure(self): ..."),
        body(
            "def work(self):\n    self.done = True\n@timer(9.0)\ndef tick(self):\n"
            "    Thread(target=self.work()).start()",
            "Thread(target=self.work()).start()",
        ),
        body(
            "motion = Group(1)\n@timer(0.1)\nasync def tick(self):\n    with self.motion: ...", "with self.motion: ..."
        ),
        ticking("Header(stamp=1700000000.5).to_bytes()"),
        ticking("async with self.goals.send_goal(Fibonacci.Goal()): ..."),
        ticking("Time(1.5)"),
        body(
            'words = Publisher(String, "words")\nheard = Subscription(String, "words")\n@timer(0.01)\n'
            "async def tick(self):\n    for n in range(100): self.words.publish(String())",
            'heard = Subscription(String, "words"), which nothing reads',
        ),
        ticking("self.spawn(self.tick())"),
        ticking("self.spawn(self.tick, n=3)"),
        ticking("await self.offload(self.tick)"),
        ticking("self.words.publish(String)"),
        ticking("self.clock.now() + 5.0"),
        ticking("self.clock.now() - self.clock.now() > 0.1"),
        ticking("self.clock.now().to_msg()"),
        ticking("async with asyncio.timeout(0.0): await self.clock.sleep(1.0)"),
        ticking("async for n in self.clock.every: ..."),
        ticking("await self.goals.send_goal(Fibonacci.Goal(), feedback_callback=print)"),
        ticking("await self.offload(time.sleep(0.01))"),
        ticking('self.get_logger().info("hello")'),
        ticking("self.words.publish(String(data=5))"),
        ticking('self.publish("words", String())'),
        ticking("for n in self.clock.every(1.0): pass"),
        ticking('await self.clock.sleep("1")'),
        ticking("for message in self.heard: pass"),
        ticking("self.heard.data"),
        ticking("print(self.rate.value)"),
        ticking("self.log('hello')"),
        ticking("print(self.rate())"),
        ticking("print(self.rate ^ 2)"),
        ticking("rate = rate * 2"),
        ticking('self.parameters["rate"]'),
        ticking("self.parameters.rate"),
        ticking('self.parameters.set("rate", 2.0)'),
        ticking("await self.adder.call(a=1, b=2)"),
        ticking("(self.adder.call(AddTwoInts.Request())).sum"),
        ticking("asyncio.create_task(self.tick)"),
        ticking('self.words.publish("hello")'),
        ticking('self.rate = "fast"'),
        ticking("self.rate = -1.0"),
        body(
            "tags = Param(['a'])\n@timer(0.1)\nasync def tick(self):\n    self.tags.append('b')",
            "self.tags.append('b')",
        ),
        body(
            "rate = Param(1.0)\n@rate.on_change\ndef changed(self, old, new):\n    self.rate = new + 1.0\n"
            "async def on_start(self):\n    self.spawn(self.begin)\nasync def begin(self):\n    self.rate = 2.0",
            "@rate.on_change def changed(self, old, new): self.rate = new + 1.0",
        ),
        body("done = asyncio.Event()\n@timer(0.1)\nasync def tick(self):\n    self.done.set", "self.done.set"),
        body(
            "since = 0\n@timer(0.1)\nasync def tick(self):\n    if self.clock.monotonic_ns() - self.since > 0.5: pass",
            "if self.clock.monotonic_ns() - self.since > 0.5: ...",
        ),
        body(
            "on = Param(True)\n@timer(0.1)\nasync def tick(self):\n    if self.on == 'true': pass",
            "if self.on == 'true': ...",
        ),
        body(
            "def near(self):\n    return True\n@timer(0.1)\nasync def tick(self):\n    if self.near: pass",
            "def near(self): ..., then if self.near: ...",
        ),
        body(
            "@timer(0.1)\nasync def tick(self):\n    if self.node_name == 'a' or 'b': pass",
            "if self.node_name == 'a' or 'b': ...",
        ),
        body(
            "state = 'MOVE'\n@timer(0.1)\nasync def tick(self):\n    if self.state == 'TURNING': self.state = 'TURN'",
            "if self.state == 'TURNING': self.state = 'TURN'",
        ),
        body("n = 0\n@timer(0.1)\nasync def tick(self):\n    self.n =+ 1", "self.n =+ 1"),
        body(
            "state = 'MOVE'\n@timer(0.1)\nasync def tick(self):\n    print(self.state)\n    state = 'BACK'",
            "state = 'BACK', for self.state",
        ),
        body(
            "words = Publisher(String, 'words')\n@timer(0.1)\nasync def tick(self):\n    return String()",
            "@timer(0.1) def tick(self): return String()",
        ),
        body(
            "wait_ms = Param(100)\n@timer(0.1)\nasync def tick(self):\n    await self.clock.sleep(self.wait_ms)",
            "wait_ms = Param(100), then await self.clock.sleep(self.wait_ms)",
        ),
        body(
            "n = 0\n@timer(0.1)\nasync def up(self):\n    self.n += 1\n@timer(1.0)\nasync def twice(self):\n"
            "    n = self.n\n    await self.clock.sleep(0.5)\n    self.n = n + 2",
            "n = self.n; await self.clock.sleep(0.5); self.n = n + 2",
        ),
        body(
            '@service(AddTwoInts, "sum")\nasync def sum_up(self, response, request):\n    response.sum = request.a',
            "def sum_up(self, response, request): ...",
        ),
        ticking("await self.adder.call(AddTwoInts.Request(), timeout=-1)"),
        ticking("self.goals.send(Fibonacci.Goal())"),
        ticking("Fibonacci(order=3)"),
        ticking("Fibonacci.Goal(ordr=3)"),
        ticking("Fibonacci.Goal(3)"),
        ticking("Fibonacci.Goal().ordr"),
        ticking("goal = await self.goals.send(Fibonacci.Goal())"),
        ticking("goal = self.goals.send(Fibonacci.Goal()); goal.feedback"),
        ticking("goal = await self.goals.send_goal(Fibonacci.Goal())"),
        ticking('await self.create_client(AddTwoInts, "add").call(AddTwoInts.Request())'),
        asked("return self.adder.call(request)"),
        asked("return AddTwoInts.Response"),
    ],
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Where modules are imported from; what is imported is forgotten, and so are forgotten awaits that were told."""
    monkeypatch.syspath_prepend(str(tmp_path))
    former = warnings._warn_unawaited_coroutine  # type: ignore[attr-defined]
    unawaited._reported.clear()
    unawaited.watch()
    yield tmp_path
    warnings._warn_unawaited_coroutine = former  # type: ignore[attr-defined]
    sys.modules.pop("slide", None)


async def what_is_said(mistake: Mistake, file: Path, graph: Graph, caplog: pytest.LogCaptureFixture) -> str:
    """Return the first message of importing, making or running the node."""
    if mistake.code.startswith(("import", "from")):
        text = f"{HEAD}{mistake.code}\n\n\nclass Slide(Node): ...\n"
    else:
        text = f"{HEAD}\n\nclass Slide(Node):\n{textwrap.indent(mistake.code, '    ')}\n"
    file.write_text(text)
    module = file.stem
    try:
        cls = import_class(f"{module}:Slide")
        cls.interface()  # as every command does
        node = make_within(cls, NodeOptions(), "slide")
    except (GraphflowError, AttributeError) as error:
        explain(error)  # as whoever reports it does
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
    """Return the first line as a cell of a table, without machine-dependent parts."""
    text = text.replace(str(file), "slide.py").replace(file.stem, "slide").split("\n")[0]
    text = re.sub(r" at 0x[0-9a-f]+", "", text)
    text = re.sub(r"(argument '\w+')\. Did you mean '\w+'\?", r"\1", text)  # Python 3.13's own
    return re.sub(r"(there is )/\w+/\w+.*", r"\1...", text).replace("|", "\\|").replace("*", "\\*")


@slow
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
