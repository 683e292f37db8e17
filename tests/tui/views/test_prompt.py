"""The prompt: verbs run and stream, end by Ctrl-C, are recalled and completed."""

from __future__ import annotations

import sys

import pytest
from textual.widgets import Input

from graphflow.testing import Graph
from graphflow.tui.panes import Content
from tests.cases import slow
from tests.tui.nodes import Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


def program(text: str) -> tuple[str, ...]:
    """Replaces the `graphflow` program."""
    return (sys.executable, "-c", text)


@slow
async def test_output_streams_and_exit_codes_are_told() -> None:
    """stdout, stderr and the exit code are shown; escape sequences have no effect."""
    async with stage(Content("prompt")) as s:
        text = "import sys; print('out', sys.argv[1:]); print('\\x1b[31mred', file=sys.stderr); sys.exit(3)"
        s.console.hub.command = program(text)
        await s.type("topic list 'a b'")
        await s.press("enter")
        await s.until("exit code 3")
        assert "out ['topic', 'list', 'a b']" in s.text
        assert "red" in s.text
        assert "\x1b" not in s.text


@slow
async def test_ctrl_c_ends_the_verb_and_nothing_else() -> None:
    """Ctrl-C interrupts the command, as in a terminal; the console stays."""
    async with stage(Content("prompt")) as s:
        waits = "import time\nprint('up', flush=True)\ntry:\n    time.sleep(60)\n"
        s.console.hub.command = program(f"{waits}except KeyboardInterrupt:\n    print('bye')")
        await s.type("topic echo /x")
        await s.press("enter")
        await s.until("up")
        await s.press("ctrl+c")
        await s.until("bye")
        await s.until(lambda: not s.view.note)
        await s.press("ctrl+c")
        assert "Leave or stop" not in s.text
        assert s.console.return_value is None


@slow
async def test_what_was_interrupted_is_read_at_its_end() -> None:
    """A command that ends by itself is shown from the top; an interrupted one, at its end."""
    lines = "import time\nfor i in range(100): print('line', i, flush=True)\n"
    for ends, shown in (("", "line 0"), ("try:\n    time.sleep(60)\nexcept KeyboardInterrupt: print('bye')", "bye")):
        async with stage(Content("prompt", "topic echo /x", {"run": True}), size=(80, 24)) as s:
            s.console.hub.command = program(lines + ends)
            s.view._run("topic echo /x", at_once=True)  # type: ignore[attr-defined]
            if ends:
                await s.until("line 99")
                await s.press("ctrl+c")
            await s.until(shown)
            await s.until(lambda: s.view._process is None)  # type: ignore[attr-defined]
            await s.until(shown)


@slow
async def test_history_and_words_of_its_own() -> None:
    """↑ recalls; `clear` empties the pane; a console in a console is refused; unbalanced quotes are reported."""
    async with stage(Content("prompt")) as s:
        s.console.hub.command = program("print('ran')")
        for text, answer in (
            ("ps", "ran"),
            ("attach", "this is a console already"),
            ("topic 'list", "check the quotes"),
        ):
            await s.type(text)
            await s.press("enter")
            await s.until(answer)
            await s.until(lambda: s.view._process is None)  # type: ignore[attr-defined]
        await s.press("up", "up", "up")
        assert s.view.query_one(Input).value == "ps"
        await s.press("down", "down", "down")
        await s.type("clear")
        await s.press("enter")
        await s.look()
        assert "ran" not in s.text


async def test_a_command_that_came_back_with_the_windows_waits_for_enter() -> None:
    """A command restored with the windows is not run again by itself, as it may have effects."""
    async with stage(Content("prompt", "action send_goal /x"), Content("prompt", "ps", {"run": True})) as s:
        s.console.hub.command = program("print('ran')")
        assert s.view.query_one(Input).value == "action send_goal /x"
        assert "enter runs this again" in s.text
        await s.press("enter")
        await s.until("ran")
        await s.prefix("1")
        await s.until("$ graphflow ps")
        assert s.view.content == Content("prompt", "ps")


@slow
async def test_completion(graph: Graph) -> None:
    """Tab completes verbs and names from the graph, and shows the candidates if there are several."""
    await graph.start(Talker())
    async with stage(Content("prompt"), graph=graph) as s:
        await s.type("to")
        await s.press("tab")
        await s.until(lambda: s.view.query_one(Input).value == "topic ")
        await s.type("e")
        await s.press("tab")
        await s.until(lambda: s.view.query_one(Input).value == "topic echo ")
        await s.type("/cha")
        await s.press("tab")
        await s.until(lambda: s.view.query_one(Input).value == "topic echo /chatter ")


@slow
async def test_what_comes_too_fast_is_counted() -> None:
    """The pane keeps up; lines left out are counted."""
    async with stage(Content("prompt")) as s:
        s.console.hub.command = program("for i in range(30000): print(i)")
        await s.type("topic echo /x")
        await s.press("enter")
        await s.until("29999")
        await s.look()
        assert "lines left out" in s.text or s.view._lost == 0  # type: ignore[attr-defined]


@slow
async def test_a_colon_opens_the_command_line() -> None:
    """A colon in an empty line opens the command line, as in other views; within a line it is a character."""
    async with stage(Content("prompt")) as s:
        await s.type("a:")
        assert s.view.query_one("Input.line").value == "a:"  # type: ignore[attr-defined]
        await s.press("ctrl+c", "colon")
        await s.until("Any verb of graphflow; or a view")


@slow
async def test_what_was_asked_for_by_a_key_is_read_from_the_top() -> None:
    """The output of a command started by a key is shown from the top; that of later commands is followed."""
    async with stage(Content("nodes"), size=(80, 20)) as s:
        s.console.hub.command = program("print('\\n'.join(f'line {i}' for i in range(100)))")
        s.view.open("prompt", "topic info -v /x", run=True)
        await s.until("line 3")
        await s.until(lambda: "line 99" not in s.text)
        await s.type("again")
        await s.press("enter")
        await s.until("line 99")
