"""The table of keys: every action has a method, and keys are shown in the usual notation."""

from __future__ import annotations

import pytest

from graphflow.console.views import VIEWS
from graphflow.tui.commands.actions import Action, by_chord, carry_out, console_actions, keys_of, shown
from graphflow.tui.commands.console_commands import ConsoleCommands
from graphflow.tui.registry import view_class


@pytest.mark.parametrize("action", list(console_actions()), ids=lambda a: a.name)
def test_every_action_of_the_console_is_carried_out(action: Action) -> None:
    """Every action has a method, and a key or a chord."""
    assert hasattr(ConsoleCommands, f"do_{action.name.partition(':')[0]}")
    assert action.chord or action.keys
    assert action.title


def test_every_action_of_a_view_is_carried_out() -> None:
    """Every action has a method, no key has two meanings, and hints have short titles."""
    for view in map(view_class, VIEWS):
        keys = [key for action in view.ACTIONS for key in action.keys]
        assert len(keys) == len(set(keys)), view
        for action in view.ACTIONS:
            assert hasattr(view, f"do_{action.name.partition(':')[0]}"), (view, action.name)
            assert not action.hint or len(action.title) <= 36


@pytest.mark.parametrize(
    ("key", "text"),
    [("percent_sign", "%"), ("ctrl+b", "^b"), ("alt+1", "M-1"), ("left", "←"), ("ctrl+left", "^←"), ("f2", "f2")],
)
def test_keys_as_people_write_them(key: str, text: str) -> None:
    """Signs are shown as such, control keys as in tmux."""
    assert shown(key) == text


def test_all_keys_of_an_action() -> None:
    """Chords are shown with the prefix."""
    detach = next(a for a in console_actions() if a.name == "detach")
    assert keys_of(detach, "ctrl+a") == "^a d, q, ^q"
    assert by_chord()["d"] is detach


def test_an_action_with_a_word() -> None:
    """`name:argument` calls `do_name("argument")`."""

    class Doer:
        done: list[str] = []  # noqa: RUF012

        def do_turn(self, degrees: str) -> None:
            self.done.append(degrees)

        def do_stop(self) -> None:
            self.done.append("stop")

    doer = Doer()
    carry_out(doer, "turn:90")
    carry_out(doer, "stop")
    assert doer.done == ["90", "stop"]
