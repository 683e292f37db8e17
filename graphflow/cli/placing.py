"""Options of `graphflow` itself that are written behind the verb: what to type in their place."""

from __future__ import annotations

import shlex
from collections.abc import Sequence

OF_GRAPHFLOW = ("--domain", "--wire", "--connect", "--net")
"""They have a value each, and stand before the verb."""
_NOT_OURS = ("--", "--ros-args")
"""Words from which on nothing is for graphflow."""


def behind(words: Sequence[str]) -> str | None:
    """The first option of graphflow's among words that come after the verb."""
    for word in words:
        if word in _NOT_OURS:
            return None
        if word.partition("=")[0] in OF_GRAPHFLOW:
            return word.partition("=")[0]
    return None


def before_the_verb(option: str, words: Sequence[str]) -> str:
    """The command line with an option where it belongs, as a sentence.

    Args:
        words: The command line, without the program's name.
    """
    place = next((n for n, word in enumerate(words) if word.partition("=")[0] == option), 0)
    end = place + (1 if "=" in words[place] else 2)
    moved = [*words[place:end], *words[:place], *words[end:]]
    return f"{option} stands before the verb: graphflow {shlex.join(moved)}"
