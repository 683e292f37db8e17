"""Every other key of the console does what its description says."""

from __future__ import annotations

import pytest

from graphflow.testing import Graph
from graphflow.tui.commands.actions import CONSOLE, console_actions
from graphflow.tui.panes import Content
from graphflow.tui.widgets.dialogs import AskToStop, Note, Pick
from tests.cases import sample, slow, some
from tests.tui.nodes import Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@pytest.mark.parametrize("view", some(["nodes", "prompt"], "prompt"))
@pytest.mark.parametrize(
    ("key", "screen"),
    sample(
        [
            ("question_mark", Note),
            ("colon", "CommandLine"),
            ("s", Pick),
            ("f", Pick),
            ("v", Pick),
            ("D", Pick),
            ("S", AskToStop),
            ("tilde", Note),
        ]
    ),
)
async def test_keys_that_ask(view: str, key: str, screen: object) -> None:
    """The dialog opens, and escape closes it."""
    async with stage(Content(view)) as s:
        await s.prefix(key)
        name = type(s.console.screen).__name__
        assert name == (screen if isinstance(screen, str) else screen.__name__)  # type: ignore[attr-defined]
        await s.press("escape")
        assert len(s.console.screen_stack) == 1


@slow
async def test_keys_that_say(graph: Graph) -> None:
    """The clock, the theme, hints if no node is selected, copied texts."""
    async with stage(Content("topics"), graph=graph) as s:
        await s.prefix("t")
        assert s.console.messages[-1].endswith(tuple(f":{n:02d}" for n in range(60)))
        await s.prefix("T")
        assert s.console.theme == "graphflow-light"
        await s.prefix("T")
        assert s.console.theme == "graphflow-dark"
        for key, words in (
            ("r", "choose a node first"),
            ("m", "choose a node"),
            ("y", "no command has been shown"),
            ("left_square_bracket", "nothing to scroll"),
            ("right_square_bracket", "nothing has been copied"),
        ):
            await s.prefix(key)
            assert words in s.console.messages[-1], key
        await s.prefix("g")
        assert s.console.window.name == "groups"
        await s.prefix("slash")
        await s.until(lambda: s.console.window.name == "logs")
        await s.prefix("y")
        assert s.console.clipboard_text == "graphflow waits"


@slow
async def test_the_palette_does_everything() -> None:
    """The palette lists the actions of the focused view and of the console, with a search."""
    async with stage(Content("nodes")) as s:
        await s.press("ctrl+p")
        await s.type("light or dark")
        await s.press("enter")
        assert s.console.theme == "graphflow-light"
        await s.press("ctrl+p")
        await s.type("split, new pane on the right")
        await s.press("enter")
        assert "prompt" in [p.content.view for p in s.console.window.panes()]


@slow
async def test_the_menu_and_the_search_have_what_is_in_the_graph(graph: Graph) -> None:
    """The menu lists views; the search finds parameters; an unknown name is reported."""
    await graph.start(Talker())
    async with stage(Content("nodes"), graph=graph) as s:
        await s.press("ctrl+p")
        await s.type("nodes and topics as boxes")
        await s.press("enter")
        await s.until(lambda: str(s.view.content) == "graph")
        await s.press("ctrl+f")
        await s.type("zzz")
        await s.until("no match for 'zzz'")
        await s.press("ctrl+u")
        await s.type("shout")
        await s.until("param shout")
        await s.press("enter")
        await s.until(lambda: str(s.view.content) == "params /talker")


@slow
async def test_alt_and_a_digit_as_old_terminals_send_it() -> None:
    """Textual reads it as a character of a Mac's option key."""
    async with stage(Content("nodes")) as s:
        await s.prefix("percent_sign")
        await s.prefix("trade_mark_sign")
        assert s.console.window.layout == "even-vertical"


@slow
async def test_the_prefix_itself() -> None:
    """Typed twice, the prefix goes through; an unknown key is reported; escape cancels; a pause shows the keys."""
    async with stage(Content("prompt")) as s:
        await s.prefix("escape")
        assert not s.console.keyboard.which_key.display
        await s.prefix("J")
        await s.until("^b J is not bound")
        await s.press("ctrl+b")
        await s.until(lambda: s.console.keyboard.which_key.display)
        assert "d detach" in s.text
        await s.press("z")
        assert not s.console.keyboard.which_key.display
        await s.type("ab")
        await s.press("ctrl+b", "ctrl+b")
        assert s.view.query_one("Input.line").value == "ab"  # type: ignore[attr-defined]


@pytest.mark.parametrize("keys", [("ctrl+b", "d"), ("q",), ("ctrl+q",), ("ctrl+c", "d")])
async def test_leaving(keys: tuple[str, ...]) -> None:
    """Four ways to leave, none of which stops anything."""
    async with stage(Content("nodes")) as s:
        await s.press(*keys)
        await s.until(lambda: s.console.return_value is not None)
        assert s.console.return_value == "detach"
        assert s.asked == []


@slow
@pytest.mark.parametrize("keys", [("ctrl+c", "s"), ("ctrl+b", "S", "s")])
async def test_stopping(keys: tuple[str, ...]) -> None:
    """Stopping has a key of its own; the question names the other consoles."""
    async with stage(Content("nodes")) as s:
        supervision = s.console.hub.supervision
        assert supervision is not None
        supervision.consoles = [{"name": name, "since": 0.0} for name in (supervision.name, "pts/7", "pts/9")]
        *ask, stop = keys
        await s.press(*ask)
        await s.until("Leave or stop lab, 2 nodes?")
        await s.until("Stopping ends it for the other consoles, too: pts/7, pts/9")
        await s.press(stop)
        await s.until(lambda: s.console.return_value is not None)
        assert s.console.return_value == "stop"


@slow
async def test_ctrl_c_never_stops_the_graph() -> None:
    """Typed twice, it only opens the question; in a prompt it interrupts the command or clears the line."""
    async with stage(Content("nodes"), Content("prompt")) as s:
        await s.press("ctrl+c", "ctrl+c", "ctrl+c")
        await s.until("Leave or stop lab")
        await s.press("escape")
        await s.prefix("1")
        await s.type("node li")
        await s.press("ctrl+c", "ctrl+c")
        assert "Leave or stop lab" not in s.text
        assert "nothing runs here any more; ^b S asks to stop the graph" in s.text
        assert s.view.query_one("Input.line").value == ""  # type: ignore[attr-defined]
        await s.press("f1")
        await s.until("Keys")
        await s.press("ctrl+c")
        assert len(s.console.screen_stack) == 1
        assert s.console.return_value is None


async def test_without_a_supervisor_nothing_can_be_stopped() -> None:
    """A console on a robot says so instead."""
    async with stage(Content("nodes"), supervised=False, size=(80, 24)) as s:
        assert "no supervisor here" in s.text
        await s.press("ctrl+c")
        await s.until("No supervisor here")
        assert "stop the graph" not in s.text


def test_every_chord_is_used_once() -> None:
    """No key has two meanings, with or without the prefix."""
    chords = [key for action in console_actions() for key in action.chord]
    keys = [key for action in console_actions() for key in action.keys]
    assert len(chords) == len(set(chords))
    assert len(keys) == len(set(keys))
    assert len({a.name for a in console_actions()}) == sum(map(len, CONSOLE.values()))


@slow
@pytest.mark.parametrize("verb", ["restart", "stop"])
async def test_a_supervisor_that_has_gone_is_asked_nothing(verb: str) -> None:
    """Restart and stop are not sent; the message says how to start the graph again."""
    async with stage(Content("nodes")) as s:
        assert s.console.hub.supervision is not None
        s.console.hub.supervision.is_lost = True
        commands = s.console.commands
        (commands.restart if verb == "restart" else commands.stop_node)("/talker")
        await s.until(lambda: "the supervisor has gone; q leaves" in s.text)
        assert verb not in [asked["do"] for asked in s.asked]
