"""Generate the page of all keys from the table of actions.

`python -m graphflow.tui.commands.keys_page` prints `docs/keys.md`; a test holds the file to it.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator

from graphflow.console.views import VIEWS
from graphflow.tui.commands.actions import CONSOLE, Action, keys_of
from graphflow.tui.registry import view_class

PREFIX = "ctrl+b"
HEAD = """\
# The keys of the console

`^b` is the prefix, Ctrl and b: press it, let go, then press the key. Keys without it act at once, except while you type
in a line; the keys of a view act while its pane has the focus. `^b ?` shows this list for the console that you are in,
the views of other packages included. [The console](console.md) says what it is all good for.
"""


def page() -> str:
    """Return the page as Markdown."""
    return "\n".join([HEAD, *_sections()])


def _sections() -> Iterator[str]:
    for title, actions in CONSOLE.items():
        yield from _section(title, actions)
    for name in VIEWS:
        view = view_class(name)
        if view.ACTIONS:
            yield from _section(f"View `{name}`: {view.DOC}", view.ACTIONS)


def _section(title: str, actions: Iterable[Action]) -> Iterator[str]:
    yield from (f"## {title}", "", "| keys | what they do | the same in a shell |", "|---|---|---|")
    for action in actions:
        keys = ", ".join(f"`{key}`" for key in keys_of(action, PREFIX).split(", "))
        yield f"| {keys} | {action.title} | {f'`{action.verb}`' if action.verb else ''} |"
    yield ""


if __name__ == "__main__":
    sys.stdout.write(page())
