"""`graphflow completion`: TAB in bash, zsh and fish."""

from __future__ import annotations

import os
import re
import shlex

import click

from graphflow.cli import exits, output
from graphflow.cli.completing import SCRIPTS, choices
from graphflow.cli.verbs import Verbs
from graphflow.errors import UsageFault
from graphflow.folders import home

_FILES = {
    "bash": ".local/share/bash-completion/completions/graphflow",
    "zsh": ".zfunc/_graphflow",
    "fish": ".config/fish/completions/graphflow.fish",
}
"""The file that each shell reads, below the home folder."""


@click.group(cls=Verbs)
def completion() -> None:
    """Set up TAB completion of verbs, live names, types and messages."""


@completion.command()
@click.argument("shell", type=click.Choice(list(SCRIPTS)), required=False)
def install(shell: str | None) -> int:
    """Write the completion script where the shell reads it. [the shell in $SHELL]"""
    from pathlib import Path

    name = shell or Path(os.environ.get("SHELL", "")).name
    if name not in SCRIPTS:
        raise UsageFault(f"name the shell: graphflow completion install {'|'.join(SCRIPTS)}")
    at = home()
    if at is None:
        raise UsageFault(f"there is no home folder: set HOME, or use graphflow completion show {name}")
    file = at / _FILES[name]
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(SCRIPTS[name], encoding="utf-8")
        if name == "bash":  # which finds a script by the name of the command
            (file.parent / "gf").write_text(SCRIPTS[name], encoding="utf-8")
    except OSError as error:
        output.error(f"{file}: {error.strerror}")
        return exits.FAILED
    output.data(str(file))
    hint = {
        "bash": f"new shells load it if bash-completion is installed; for this shell, or without that: . {file}",
        "zsh": "add to ~/.zshrc, before compinit: fpath=(~/.zfunc $fpath)",
        "fish": "new shells load it",
    }
    output.talk(hint[name])
    return exits.OK


@completion.command()
@click.argument("shell", type=click.Choice(list(SCRIPTS)))
def show(shell: str) -> None:
    """Print the completion script. To load it: eval "$(graphflow completion show bash)"."""
    output.data(SCRIPTS[shell])


@completion.command(hidden=True)
@click.argument("line")
def words(line: str) -> None:
    """Print the completions of the last word of a line."""
    before, partial = split_line(line)
    output.lines(choices(before[1:], partial))


def split_line(line: str) -> tuple[list[str], str]:
    """Split a line as a shell does, except for the last word, which is returned as typed, with its quotation mark."""
    found = re.search(r"""(?:^|\s)((?:'[^']*|"[^"]*|[^\s'"]+)?)\Z""", line)
    partial = found[1] if found else ""
    head = line[: len(line) - len(partial)]
    try:
        return shlex.split(head), partial
    except ValueError:  # an unclosed quotation
        return head.split(), partial
