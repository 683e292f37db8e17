"""The actions of the console: the one table behind bindings, bars, palette, help and documentation.

An action `name` is carried out by the method `do_name` of the console or of the view it belongs to; one named
`name:argument`, by `do_name("argument")`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Action:
    """An action of the console or of a view.

    Attributes:
        chord: Alternative keys after the prefix.
        keys: Alternative keys without the prefix; those of a view apply while it is focused.
        verb: The equivalent command, with {node}, {topic}, ... for the selection.
        hint: Whether the bottom line shows it.
        label: Keys and title in the bottom line, if one entry covers several actions.
        short: Label in the bar after the prefix; empty to leave it out. Actions with the same label share an entry.
    """

    name: str
    title: str
    chord: tuple[str, ...] = ()
    keys: tuple[str, ...] = ()
    verb: str = ""
    hint: bool = False
    label: str = ""
    short: str = ""


CONSOLE: dict[str, tuple[Action, ...]] = {
    "Leave": (
        Action("detach", "detach; the nodes run on", ("d",), ("q", "ctrl+q"), hint=True, short="detach"),
        Action("ask_to_stop", "stop the graph...", ("S",), verb="graphflow down", short="stop"),
        Action("interrupt", "interrupt the pane's command; without one, leave or stop...", keys=("ctrl+c",)),
        Action("pause_in_shell", "back to the shell until fg; the nodes run on", keys=("ctrl+z",)),
        Action("sessions", "switch to another graph", ("s",), verb="graphflow attach --graph NAME", short="graphs"),
    ),
    "Panes": (
        Action("split:columns", "split, new pane on the right", ("percent_sign",), hint=True, short="split"),
        Action("split:rows", "split, new pane below", ("quotation_mark",), hint=True, short="split"),
        Action("focus:left", "pane on the left", ("left",), short="go"),
        Action("focus:right", "pane on the right", ("right",), short="go"),
        Action("focus:up", "pane above", ("up",), short="go"),
        Action("focus:down", "pane below", ("down",), short="go"),
        Action("step_pane:1", "next pane", ("o",), ("tab",)),
        Action("step_pane:-1", "previous pane", (), ("shift+tab",)),
        Action("last_pane", "pane that was focused before", ("semicolon",)),
        Action("zoom", "zoom the pane, or back", ("z",), hint=True, short="zoom"),
        Action("close_pane", "close the pane; never stops a node", ("x",), short="close"),
        Action("swap:-1", "swap with the pane before", ("left_curly_bracket",), short="swap"),
        Action("swap:1", "swap with the pane after", ("right_curly_bracket",), short="swap"),
        Action("break_pane", "move the pane to a window of its own", ("exclamation_mark",)),
        Action("grow:left", "move the border left", ("ctrl+left",)),
        Action("grow:right", "move the border right", ("ctrl+right",)),
        Action("grow:up", "move the border up", ("ctrl+up",)),
        Action("grow:down", "move the border down", ("ctrl+down",)),
        Action("next_layout", "next layout", ("space",), short="layout"),
        Action("arrange:even-horizontal", "panes side by side", ("alt+1",)),
        Action("arrange:even-vertical", "panes one above the other", ("alt+2",)),
        Action("arrange:main-horizontal", "a large pane above", ("alt+3",)),
        Action("arrange:main-vertical", "a large pane on the left", ("alt+4",)),
        Action("arrange:tiled", "tiles", ("alt+5",)),
        Action("scroll_mode", "scroll back", ("left_square_bracket",), short="scroll"),
        Action("paste", "paste the copied text", ("right_square_bracket",)),
        Action("change_view", "show something else in this pane", ("v",), ("f2",), short="view"),
    ),
    "Windows": (
        Action("new_window", "new window", ("c",), hint=True, short="window"),
        Action("step_window:1", "next window", ("n",), short="next/prev"),
        Action("step_window:-1", "previous window", ("p",), short="next/prev"),
        Action("last_window", "window that was open before", ("l",)),
        *(Action(f"select_window:{n}", f"window {n}", (str(n),), short="window no.") for n in range(10)),
        Action("rename_window", "rename the window", ("comma",), short="rename"),
        Action("close_window", "close the window; never stops a node", ("ampersand",)),
        Action("windows", "list of windows and panes", ("w",), short="windows"),
        Action("save_layout", "write the windows into the graph file", ("ctrl+s",)),
    ),
    "Graph": (
        Action("find", "find a node, topic, service or parameter", ("f",), ("ctrl+f",), short="find"),
        Action("groups", "who waits for whom: groups and deadlocks", ("g",), verb="graphflow waits", short="groups"),
        Action("restart_node", "restart the selected node", ("r",), verb="graphflow restart {node}", short="restart"),
        Action("newest_error", "the newest error, in its log", ("e",), short="error"),
        Action("search_logs", "search in all logs", ("slash",), verb="graphflow logs", short="search"),
        Action("mute_node", "mute the node in merged logs, or not", ("m",)),
        Action("palette", "all commands", (), ("ctrl+p",), hint=True),
        Action("command", "command line: any verb", ("colon",), ("colon",), hint=True, short="command"),
    ),
    "Console": (
        Action("dismiss_welcome", "hide the line for newcomers", keys=("escape",)),
        Action("help", "all keys", ("question_mark",), ("question_mark", "f1"), hint=True, short="all keys"),
        Action("clients", "who else is attached", ("D",), verb="graphflow ls"),
        Action("clock", "the time", ("t",)),
        Action("theme", "light or dark", ("T",), short="theme"),
        Action("messages", "the messages so far", ("tilde",)),
        Action("copy_command", "copy the last shell command", ("y",)),
    ),
}
"""The console's own actions by section, in the order of the help."""

OPTION_KEYS = {
    "inverted_exclamation_mark": "alt+1",
    "trade_mark_sign": "alt+2",
    "pound_sign": "alt+3",
    "cent_sign": "alt+4",
    "infinity": "alt+5",
}
"""Textual's names for alt and a digit as a Mac's option key sends them."""
_NAMES = {
    "percent_sign": "%",
    "quotation_mark": '"',
    "left_curly_bracket": "{",
    "right_curly_bracket": "}",
    "left_square_bracket": "[",
    "right_square_bracket": "]",
    "exclamation_mark": "!",
    "question_mark": "?",
    "semicolon": ";",
    "ampersand": "&",
    "comma": ",",
    "colon": ":",
    "slash": "/",
    "tilde": "~",
    "plus": "+",
    "minus": "-",
    "equals_sign": "=",
    "full_stop": ".",
    "left": "←",
    "right": "→",
    "up": "↑",
    "down": "↓",
    "escape": "esc",
    "pageup": "pgup",
    "pagedown": "pgdn",
}


def console_actions() -> Iterable[Action]:
    """Iterate over the console's own actions in order."""
    for actions in CONSOLE.values():
        yield from actions


def by_chord() -> dict[str, Action]:
    """Return the console's actions by the key after the prefix."""
    return {key: action for action in console_actions() for key in action.chord}


def shown(key: str) -> str:
    """Return the usual notation of a key: `%` for percent_sign, `^b` for ctrl+b."""
    *modifiers, last = key.split("+")
    name = _NAMES.get(last, last)
    if modifiers == ["ctrl"]:
        return f"^{name}"
    if modifiers == ["alt"]:
        return f"M-{name}"
    return "+".join([*modifiers, name])


def keys_of(action: Action, prefix: str) -> str:
    """Return all keys of an action for the help: `^b d, q`."""
    chords = list(action.chord)
    return ", ".join([*(f"{shown(prefix)} {shown(key)}" for key in chords), *map(shown, action.keys)])


def carry_out(target: object, name: str) -> None:
    """Call the method of a view or of the console that carries out an action."""
    method, _, argument = name.partition(":")
    getattr(target, f"do_{method}")(*([argument] if argument else []))
