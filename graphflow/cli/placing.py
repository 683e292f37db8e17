"""Options of `graphflow` itself that were written after the verb, and the command with them in the right place."""

from __future__ import annotations

import shlex
from collections.abc import Sequence

OF_GRAPHFLOW = ("--domain", "--wire", "--connect", "--net")
"""Options that come before the verb; each takes a value."""
_NOT_OURS = ("--", "--ros-args")
"""Words after which no word is an option of graphflow's."""


def option_after_verb(words: Sequence[str]) -> str | None:
    """Return the first option of graphflow's own among words after the verb; None if there is none."""
    for word in words:
        if word in _NOT_OURS:
            return None
        if word.partition("=")[0] in OF_GRAPHFLOW:
            return word.partition("=")[0]
    return None


def before_the_verb(option: str, words: Sequence[str]) -> str:
    """Return an error text with the command line that has the option before the verb.

    Args:
        words: The command line, without the program's name.
    """
    place = next((n for n, word in enumerate(words) if word.partition("=")[0] == option), 0)
    end = place + (1 if "=" in words[place] else 2)
    moved = [*words[place:end], *words[:place], *words[end:]]
    return f"{option} goes before the verb: graphflow {shlex.join(moved)}"
