"""The log: levels, filter, following, muting, going to the source."""

from __future__ import annotations

import re
import time
from collections import deque
from pathlib import Path

import pytest
from textual.widgets import Input

from graphflow.testing import Graph
from graphflow.tui.panes import Content
from graphflow.tui.views.log import place_in
from tests.cases import slow
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


@slow
async def test_all_nodes_one_node_a_namespace() -> None:
    """Names are shown if there are several nodes."""
    async with stage(Content("log"), Content("log", "/talker"), Content("log", "/arm"), records=RECORDS) as s:
        await s.look()
        assert re.search(r"/talker +ready", s.text)
        assert re.search(r"/arm/left +WARN low battery", s.text)
        await s.prefix("1")
        await s.look()
        await s.until("ready")
        assert "battery" not in s.text
        await s.prefix("2")
        await s.look()
        await s.until("battery")
        assert "tick" not in s.text


@slow
@pytest.mark.parametrize(("width", "begins"), [(120, 29), (40, 4)])
async def test_a_report_in_a_narrow_pane(width: int, begins: int) -> None:
    """In little room, a report's further lines begin below the names, and keep their relative indent."""
    told = record("DEADLOCK: a ring", "/turtle1/follower", 3)
    more = [told._replace(text=" " * n + "holds group 'all', and waits", is_more=True) for n in (4, 12)]
    async with stage(Content("log"), records=[told, *more, RECORDS[0]], size=(width, 20)) as s:
        await s.until("holds group 'all', and waits")
        at = [line.index("holds") for line in s.text.split("\n") if "holds" in line]
        assert at[0] == begins + (2 if width == 120 else 0)
        assert at[1] - at[0] == (8 if width == 120 else 4)


@slow
async def test_levels_and_filter() -> None:
    """1 to 5 choose the level; / filters by a regular expression while it is typed, and marks matches."""
    async with stage(Content("log"), records=RECORDS) as s:
        await s.look()
        await s.press("3")
        await s.look()
        await s.until("low battery")
        assert "ready" not in s.text
        assert "warn+" in s.text
        await s.press("1", "slash")
        await s.type("tick [5-5]")
        await s.until("tick 5")
        assert "tick 6" not in s.text
        await s.type("(")
        await s.look()
        await s.until("not a regular expression")
        await s.press("escape")
        await s.until("tick 6")
        assert s.view.content.options == {"level": "debug"}


async def test_a_filter_that_is_much_too_long() -> None:
    """An overlong filter is ignored."""
    async with stage(Content("log"), records=RECORDS) as s:
        await s.press("slash")
        s.view.query_one(Input).value = "x" * 201
        await s.look()
        await s.until("low battery")


@slow
async def test_what_is_new_is_followed_until_one_scrolls() -> None:
    """The view follows new lines until the user scrolls up, and again from the end."""
    many = [record(f"old {i}") for i in range(100)]
    async with stage(Content("log"), records=many) as s:
        await s.look()
        await s.until("old 99")
        await s.until("follow ▼")
        await s.press("pageup")
        s.console.hub.logs.add([record("new one")])
        await s.look()
        assert "new one" not in s.text
        assert "f follows" in s.text
        await s.press("f")
        await s.until("new one")
        await s.press("home")
        await s.until("old 0")
        await s.press("end")
        await s.until("new one")


@slow
async def test_muting() -> None:
    """A muted node is left out of merged logs, but not of its own log."""
    async with stage(Content("log"), Content("log", "/talker"), records=RECORDS) as s:
        await s.look()
        await s.press("up", "m")
        await s.look()
        assert "tick 6" not in s.text
        assert "1 muted" in s.text
        await s.prefix("1")
        await s.look()
        await s.until("tick 6")


async def test_going_to_the_next_warning_and_to_the_source() -> None:
    """n and N go to warnings; enter opens the file that the line names."""
    async with stage(Content("log"), records=RECORDS) as s:
        await s.look()
        await s.press("N")
        assert s.view.chosen() == {"node": "/arm/left"}
        await s.press("enter")
        await s.until(lambda: len(s.console.window.numbers) == 2)
        assert str(s.view.content) == "source nodes/arm.py:7"


@slow
async def test_the_source_of_a_line_that_names_none(graph: Graph) -> None:
    """The source of other lines comes from /rosout."""
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
        await s.until("the source of this line is unknown")
        await s.press("up", "enter")
        await s.until(lambda: len(s.console.window.numbers) == 2)
        assert re.fullmatch(r".*test_log\.py:\d+", s.view.about)


async def test_long_lines_wrap_unless_told_otherwise() -> None:
    """Wrapped text is aligned with the text of its line, without repeating the time or the node."""
    async with stage(Content("log"), records=[record("  x" * 60 + "END")], size=(70, 20)) as s:
        await s.look()
        lines = [text for text in s.text.split("\n") if "x" in text]
        assert len(lines) > 3
        assert all(text.startswith(" " * 17) for text in lines[1:])
        assert "END" in lines[-1]
        await s.press("w")
        assert "END" not in s.text


@slow
async def test_a_line_that_comes_again_and_again() -> None:
    """Consecutive repetitions are shown once with their number; other nodes, levels and tracebacks are not merged."""
    same = [record("stuck"), record("stuck"), record("stuck", "/arm"), record("stuck", "/arm", 3)]
    async with stage(Content("log"), records=same) as s:
        await s.look()
        assert s.text.count("stuck") == 3
        assert "stuck  x2" in s.text
        s.console.hub.logs.add([record("stuck", "/arm", 3)] * 6)
        await s.look()
        assert s.text.count("stuck") == 3
        assert "ERROR stuck  x7" in s.text


def written(folder: Path, node: str, lines: list[str]) -> None:
    text = "".join(f"[INFO] [{1700000000 + i}.0] [{node}]: {line}\n" for i, line in enumerate(lines))
    (folder / f"{node}.log").write_text(text)


@slow
async def test_a_quiet_node_in_a_flood(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A node's own log is complete, read from its file; the merged one reports that older lines are gone."""
    monkeypatch.setattr("graphflow.tui.feeds.log_feed.RECORDS", 50)
    written(tmp_path, "quiet", [f"word {i}" for i in range(10)])
    async with stage(Content("log", "/quiet"), Content("log"), nodes=("/quiet",), folder=tmp_path) as s:
        s.console.hub.logs.records = deque(maxlen=50)
        s.console.hub.logs.add([record(f"noise {i}") for i in range(100)])
        await s.look()
        await s.until("word 0")
        await s.until("word 9")
        assert "gone" not in s.text
        await s.prefix("1")
        await s.look()
        await s.until("50 older ones gone, o shows one node")


async def test_errors_outlive_a_flood() -> None:
    """Old warnings and errors are still there at their level."""
    async with stage(Content("log")) as s:
        s.console.hub.logs.records = deque(maxlen=50)
        s.console.hub.logs.add([record("it broke", level=3), *(record(f"noise {i}") for i in range(100))])
        await s.look()
        assert "it broke" not in s.text
        await s.press("4")
        await s.look()
        await s.until("it broke")


@slow
async def test_going_to_the_newest_error(tmp_path: Path) -> None:
    """The newest error is shown in the log of its node, with the cursor on it, and then counts as seen."""
    lines = "".join(f"[INFO] [{1700000000 + i}.0] [arm]: line {i}\n" for i in range(200))
    (tmp_path / "arm.log").write_text(f"{lines}[ERROR] [1700000300.0] [arm]: it broke\n{lines}")
    async with stage(Content("nodes"), nodes=("/arm",), folder=tmp_path) as s:
        s.console.hub.logs.follow(s.console.hub.log_files())
        s.console.hub.logs.read()
        await s.look()
        await s.until("E1 ^b e")
        await s.until("it broke")
        await s.prefix("e")
        await s.until("▌log /arm")
        await s.look()
        chosen = s.view.chosen()
        assert chosen == {"node": "/arm"}
        assert "line 199" in s.text
        assert "ERROR it broke" in s.text
        await s.until(lambda: "E1 ^b e" not in s.text)


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
    """Places are found in the forms of Python's tracebacks and graphflow's reports."""
    assert place_in(text) == place
