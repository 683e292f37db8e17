"""Deadlocks that the source tells of before anything runs."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import Any

import pytest

from graphflow.analysis.deadlock_check import _module, findings
from graphflow.graph.resolve import load
from graphflow.supervisor.launching.classes import add_root, import_class
from tests.conftest import PROJECT

FOLDER = PROJECT / "graphs" / "deadlock"


def found(file: Path) -> list[str]:
    plan = load(file)
    add_root(plan.root)
    interfaces = {node.class_path: import_class(node.class_path).interface() for node in plan.nodes}
    return [str(finding) for finding in findings(plan, interfaces)]


@pytest.mark.parametrize(
    ("name", "grades"),
    [
        ("self_call_broken", ["CERTAIN"]),
        ("self_call_fixed", []),
        ("classic_broken", ["CERTAIN"]),
        ("classic_fixed", []),
        ("crossing_broken", ["POSSIBLE"]),
        ("crossing_fixed", []),
        ("recursion_broken", ["IF THIS BRANCH RUNS"]),
        ("arrival_race_broken", []),
        ("arrival_broken", ["IF THIS BRANCH RUNS", "IF THIS BRANCH RUNS"]),
        ("arrival_fixed", []),
    ],
)
def test_the_deadlock_graphs(name: str, grades: list[str]) -> None:
    """What is broken by calls is found in the source with its grade, and what is fixed is not."""
    told = found(FOLDER / f"{name}.yaml")

    assert [next(g for g in ("CERTAIN", "IF THIS BRANCH RUNS", "POSSIBLE") if f": {g}: " in t) for t in told] == grades


def test_what_is_told_says_where_and_what_to_do() -> None:
    """The line of the await, the chain of calls, and the line of a graph file that ends it."""
    [certain] = found(FOLDER / "self_call_broken.yaml")
    assert "nodes/deadlock/self_call.py:18: CERTAIN: timer tick of /narcissus awaits /narcissus/add" in certain
    assert certain.endswith("self_call_broken.yaml:6 /narcissus: {concurrency: {add_group: [add]}}")
    [possible] = found(FOLDER / "crossing_broken.yaml")
    assert "timer greet of /left holds group 'default_group' of /left and awaits /right/how_are_you" in possible
    [recursion] = found(FOLDER / "recursion_broken.yaml")
    assert recursion.endswith("/factorial: {concurrency: {answers: {limit: 2}}}")


NODES = """
from graphflow import Client, Group, Node, service, timer
from graphflow.msgs.std_srvs.srv import Trigger


class Base(Node):
    all = Group(1)
    mine = Client(Trigger, "mine")

    async def ask(self):
        await self.mine.call(Trigger.Request())


class One(Base):
    @timer(1.0, group=Base.all)
    async def tick(self):
        await self.deeper()

    async def deeper(self):
        if self.name == "x":
            return
        await self.ask()

    @service(Trigger, "mine", group=Base.all)
    async def answer(self, request):
        return Trigger.Response()


class Beside(Base):
    @timer(1.0, group=Base.all)
    async def tick(self):
        self.spawn(self.ask)

    @service(Trigger, "mine", group=Base.all)
    async def answer(self, request):
        return Trigger.Response()


class Computed(Node):
    def __init__(self, name=None, **options):
        super().__init__(name, **options)
        self.late = self.create_client(Trigger, self.name + "/x")

    @timer(1.0)
    async def tick(self):
        await self.late.call(Trigger.Request())


class Alone(Base):
    @timer(1.0)
    async def tick(self):
        await self.ask()


class Dynamic(Alone):
    dynamic_names = ("/mine",)


class LetsGo(Base):
    @timer(1.0, group=Base.all)
    async def tick(self):
        async with self.all.released():
            await self.ask()

    @service(Trigger, "mine", group=Base.all)
    async def answer(self, request):
        return Trigger.Response()


class PushesOut(Node):
    latest = Group(1, "cancel_running")
    mine = Client(Trigger, "mine")

    @timer(1.0, group=latest)
    async def tick(self):
        await self.mine.call(Trigger.Request())

    @service(Trigger, "mine", group=latest)
    async def answer(self, request):
        return Trigger.Response()
"""


@pytest.mark.parametrize(
    ("cls", "told"),
    [
        ("One", "static_cases.py:11: IF THIS BRANCH RUNS: timer tick of /n awaits /mine"),
        ("Beside", None),
        ("LetsGo", None),
        ("PushesOut", None),
        ("Dynamic", None),
        ("Computed", "static_cases.py:46: unresolved: timer tick of /n calls self.late, which is made at run time"),
        ("Alone", "static_cases.py:11: unresolved: timer tick of /n calls /mine, which no node of this graph declares"),
    ],
)
def test_what_can_be_followed(tmp_path: Path, cls: str, told: str | None) -> None:
    """Helpers, parents and early returns are; what is begun and not awaited is no wait; the rest is listed."""
    (tmp_path / "static_cases.py").write_text(NODES)
    (tmp_path / "g.yaml").write_text(f"nodes: {{/n: {{class: static_cases:{cls}}}}}")

    texts = found(tmp_path / "g.yaml")

    if told is None:
        assert texts == []
    else:
        assert any(told in text for text in texts)


def test_a_service_with_two_servers(tmp_path: Path) -> None:
    """The other one may answer."""
    (tmp_path / "static_cases.py").write_text(NODES)
    (tmp_path / "g.yaml").write_text("nodes: {/other: {class: static_cases:Beside}, /n: {class: static_cases:One}}")

    assert not any("IF THIS BRANCH RUNS" in text for text in found(tmp_path / "g.yaml"))


OUT_OF_SIGHT = """
import asyncio
from graphflow import Client, Group, Node, service, timer
from graphflow.msgs.std_srvs.srv import Trigger


async def ask(client):
    return await client.call(Trigger.Request())


class Asker(Node):
    work = Group(1)
    other = Client(Trigger, "answer")

    @service(Trigger, "answer", group=work)
    async def answer(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response()

    @timer(1.0, group=work)
    async def tick(self) -> None:
        await self.help()
        await asyncio.create_task(self.other.call(Trigger.Request()))

    async def help(self) -> None:
        if await self.other.wait_ready(1.0):
            await ask(self.other)
"""


def test_what_gets_out_of_sight_is_said(tmp_path: Path) -> None:
    """A client that is handed on, also by a method that is called, or used in a task."""
    (tmp_path / "nodes").mkdir()
    (tmp_path / "nodes" / "out_of_sight.py").write_text(OUT_OF_SIGHT)
    (tmp_path / "graph.yaml").write_text("nodes:\n  /asker: {class: nodes.out_of_sight:Asker}\n")
    told = [text.partition(": unresolved: ")[2] for text in found(tmp_path / "graph.yaml")]
    assert sorted(filter(None, told)) == [
        "timer tick of /asker hands self.other on, and its calls there are not followed",
        "timer tick of /asker uses self.other in a task, whose end is not followed",
    ]


def test_a_source_that_is_parsed_while_another_thread_parses(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """CPython until 3.11.7 may then raise SystemError: it is parsed again."""
    file, parse = tmp_path / "talker.py", ast.parse
    file.write_text("count = 0\n")
    errors = [SystemError("AST constructor recursion depth mismatch (before=42, after=99)")]

    def disturbed(text: str) -> Any:
        if errors:
            raise errors.pop()
        return parse(text)

    monkeypatch.setattr(ast, "parse", disturbed)
    assert len(_module(str(file)).body) == 1


ENDLESS = """
from graphflow import Client, Group, Node, service, timer
from graphflow.msgs.std_srvs.srv import Trigger


class Asker(Node):
    many = Group(None)
    again = Client(Trigger, "again")

    @timer(1.0)
    async def tick(self):
        await self.again.call(Trigger.Request())

    @service(Trigger, "again", group=many)
    async def answer(self, request):
        return await self.again.call(Trigger.Request())
"""


def test_a_service_that_calls_itself_in_a_group_without_limit(tmp_path: Path) -> None:
    """No group is ever full, and the chain of calls is followed only so far."""
    (tmp_path / "endless_cases.py").write_text(ENDLESS)
    (tmp_path / "g.yaml").write_text("nodes: {/n: {class: endless_cases:Asker}}")

    assert found(tmp_path / "g.yaml") == []
