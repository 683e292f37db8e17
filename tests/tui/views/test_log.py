"""The log: levels, a live filter, following, muting, going to the source."""

from __future__ import annotations

import re
import time

import pytest

from graphflow.testing import Graph
from graphflow.tui.panes import Content
from graphflow.tui.views.log import place_in
from tests.tui.nodes import Talker
from tests.tui.stage import record, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")

RECORDS = [
    record("ready", "/talker", 1),
    record("low battery", "/arm/left", 2),
    record('File "nodes/arm.py", line 7', "/arm/left", 3),
    record("tick 5", "/talker", 0),
    record("tick 6", "/talker", 1),
]


async def test_all_nodes_one_node_a_namespace() -> None:
    """Names are shown where there are several."""
    async with stage(Content("log"), Content("log", "/talker"), Content("log", "/arm"), records=RECORDS) as s:
        await s.look()
        assert re.search(r"/talker +ready", s.text)
        assert re.search(r"/arm/left +WARN low battery", s.text)
        await s.prefix("1")
        await s.look()
        assert "ready" in s.text
        assert "battery" not in s.text
        await s.prefix("2")
        await s.look()
        assert "battery" in s.text
        assert "tick" not in s.text


async def test_levels_and_filter() -> None:
    """1 to 5 choose the level; / takes a regular expression while it is typed, and marks what fits."""
    async with stage(Content("log"), records=RECORDS) as s:
        await s.look()
        await s.press("3")
        await s.look()
        assert "low battery" in s.text
        assert "ready" not in s.text
        assert "warn+" in s.text
        await s.press("1", "slash")
        await s.type("tick [5-5]")
        assert "tick 5" in s.text
        assert "tick 6" not in s.text
        await s.type("(")
        await s.look()
        assert "not a regular expression" in s.text
        await s.press("escape")
        assert "tick 6" in s.text
        assert s.view.content.options == {"level": "debug"}


async def test_what_is_new_is_followed_until_one_scrolls() -> None:
    """And again at the end."""
    many = [record(f"old {i}") for i in range(100)]
    async with stage(Content("log"), records=many) as s:
        await s.look()
        assert "old 99" in s.text
        assert "follow ▼" in s.text
        await s.press("pageup")
        s.console.hub.logs.add([record("new one")])
        await s.look()
        assert "new one" not in s.text
        assert "f follows" in s.text
        await s.press("f")
        assert "new one" in s.text
        await s.press("home")
        assert "old 0" in s.text
        await s.press("end")
        assert "new one" in s.text


async def test_muting() -> None:
    """A muted node is left out of merged logs, and its own log still has it."""
    async with stage(Content("log"), Content("log", "/talker"), records=RECORDS) as s:
        await s.look()
        await s.press("up", "m")
        await s.look()
        assert "tick 6" not in s.text
        assert "1 muted" in s.text
        await s.prefix("1")
        await s.look()
        assert "tick 6" in s.text


async def test_going_to_the_next_warning_and_to_the_source() -> None:
    """n and N; enter opens the file that the line names."""
    async with stage(Content("log"), records=RECORDS) as s:
        await s.look()
        await s.press("N")
        assert s.view.chosen() == {"node": "/arm/left"}
        await s.press("enter")
        await s.until(lambda: len(s.console.window.numbers) == 2)
        assert str(s.view.content) == "source nodes/arm.py:7"


async def test_the_source_of_a_line_that_names_none(graph: Graph) -> None:
    """/rosout has told where it was written."""
    node = Talker()
    await graph.start(node)
    async with stage(Content("log"), graph=graph) as s:
        live = s.console.hub.live
        assert live is not None
        await graph.settle()
        node.log.warning("here I am")
        now = time.time()
        await graph.settle()
        s.console.hub.logs.add([record("here I am", "/talker", 1, now), record("a print", "/talker", 1, now)])
        await s.look()
        await s.press("up", "enter")
        await s.until("nobody has told where")
        await s.press("up", "enter")
        await s.until(lambda: len(s.console.window.numbers) == 2)
        assert re.fullmatch(r".*test_log\.py:\d+", s.view.about)


async def test_long_lines_wrap_when_asked() -> None:
    """Otherwise they are cut."""
    async with stage(Content("log", "/talker"), records=[record("x" * 150 + "END")]) as s:
        await s.look()
        assert "END" not in s.text
        await s.press("w")
        assert "END" in s.text


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("(arrival.py:41 in arrived)", "arrival.py:41"),
        ('  File "/x/y.py", line 3, in f', "/x/y.py:3"),
        ("nodes/a_b.py:12: oh", "nodes/a_b.py:12"),
        ("at 12:30", None),
        ("graph.yaml:3:4", "graph.yaml:3"),
    ],
)
def test_places_in_lines(text: str, place: str | None) -> None:
    """As Python's tracebacks and graphflow's reports write them."""
    assert place_in(text) == place
