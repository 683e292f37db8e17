"""Splitting a command line into options and values, where values may look like options.

`graphflow topic pub -r 10 /cmd_vel geometry_msgs/msg/Twist {linear: {x: -2.0}} -1` comes from the shell as many words.
A word is an option when it is written exactly as one of the command's options and stands outside of all brackets;
everything else is a value, and the values of a message are joined again.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import click

_OPEN, _CLOSE = "{[", "}]"


def split_values(words: Sequence[str], flags: frozenset[str], valued: frozenset[str]) -> list[str]:
    """The same words in the order click wants: options first, then `--`, then everything that is a value.

    Args:
        flags: Options without a value.
        valued: Options with one.
    """
    options: list[str] = []
    values: list[str] = []
    depth = 0
    rest = list(words)
    while rest:
        word = rest.pop(0)
        name, equals, _ = word.partition("=")
        if depth == 0 and (word in flags or (equals and name in valued)):
            options.append(word)
        elif depth == 0 and word in valued:
            options += [word, *rest[:1]]
            rest = rest[1:]
        elif depth == 0 and word == "--":
            values += rest
            break
        elif depth == 0 and word.startswith("--") and len(word) > 2:
            options.append(word)  # click says what is wrong with it
        else:
            depth = max(0, depth + sum(word.count(c) for c in _OPEN) - sum(word.count(c) for c in _CLOSE))
            values.append(word)
    return [*options, "--", *values]


class ValueCommand(click.Command):
    """A command whose values may begin with a minus sign, and whose options may stand anywhere."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        flags, valued = {"--help", "-h"}, set[str]()
        for parameter in self.params:
            if isinstance(parameter, click.Option):
                (flags if parameter.is_flag or parameter.count else valued).update(parameter.opts)
                flags.update(parameter.secondary_opts)
        return super().parse_args(ctx, split_values(args, frozenset(flags), frozenset(valued)))


def message_values(words: Sequence[str]) -> Any:
    """The values of a message from the words after its type; None for none.

    Raises:
        GraphflowError: They are not YAML.
    """
    from graphflow.graph.source import parse_value

    return parse_value(" ".join(words)) if words else None
