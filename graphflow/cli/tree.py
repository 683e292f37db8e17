"""The command line as data: verbs, their arguments and options."""

from __future__ import annotations

from typing import Any

import click


def verbs() -> dict[str, Any]:
    """Return every verb with its help, arguments and options, and its own verbs likewise.

    {"topic": {"help": ..., "commands": {"echo": {"help": ..., "arguments": ["TOPIC", "[TYPE]"],
    "options": {"--once": False, "--field": True}}}}}: True for an option with a value.
    """
    from graphflow.cli.main import cli

    with click.Context(cli) as context:
        return _commands(cli, context)


def _commands(group: click.Group, context: click.Context) -> dict[str, Any]:
    found = {}
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        if command is not None and not command.hidden:
            found[name] = _describe(command, context)
    return found


def _describe(command: click.Command, context: click.Context) -> dict[str, Any]:
    arguments = [p.make_metavar(context) for p in command.params if isinstance(p, click.Argument)]
    options = {
        name: not (p.is_flag or p.count)
        for p in command.params
        if isinstance(p, click.Option)
        for name in p.opts
        if name.startswith("--")
    }
    described: dict[str, Any] = {"help": command.get_short_help_str(100), "arguments": arguments, "options": options}
    if isinstance(command, click.Group):
        described["commands"] = _commands(command, context)
    return described
