"""Words of verbs of `bag` that stand in the wrong place, and moments of a bag."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from contextlib import suppress
from datetime import datetime
from pathlib import Path

import click

from graphflow.cli.verbs import Verb


class BagVerb(Verb):
    """A verb of one bag, that tells where the bag and the topics stand."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        takes_option = any("--topics" in param.opts for param in self.params)
        ctx.allow_extra_args = takes_option
        left = super().parse_args(ctx, args)
        if ctx.resilient_parsing:
            return left
        words = [str(ctx.params["path"]), *left, *ctx.params.get("topics", ()), *ctx.params.get("names", ())]
        bag = words[0] if Path(words[0]).exists() else next(filter(_is_there, words), words[0])
        topics = [word for word in words if word != bag]
        if left and (rule := _rule(ctx, left)):
            ctx.fail(f"a remap rule is one word: {ctx.command_path} {bag} -m {rule}")
        if left:
            line = f"{ctx.command_path} {bag} --topics {shlex.quote(' '.join(topics))}"
            ctx.fail(f"topics are named by --topics: {line}")
        if bag != words[0]:
            ctx.fail(f"the bag stands first: {ctx.command_path} {shlex.join([bag, *topics])}")
        return left


def all_or_some(topics: Sequence[str]) -> str:
    """Answer `-a` beside names, one of which may be the bag's."""
    folder = "" if "/" in topics[0] else f"; the bag's folder is named by -o: graphflow bag record -a -o {topics[0]}"
    return f"all topics, or only {' '.join(topics)}: leave out -a, or the names{folder}"


def _rule(ctx: click.Context, left: list[str]) -> str:
    """The remap rule that words are meant as which stand apart, or without -m; empty if they are none."""
    old = next((word for word in ctx.params.get("remaps", ()) if ":=" not in word), None)
    if old is not None:
        return f"{old.rstrip(':=')}:={left[0].lstrip(':=')}"
    return left[0] if "remaps" in ctx.params and ":=" in left[0] else ""


def _is_there(word: str) -> bool:
    return Path(word).exists()


def moment_option(_: click.Context, __: click.Parameter, value: str | None) -> float | None:
    """The seconds that an option has, from the beginning of a bag or since 1970.

    Raises:
        BadParameter: It is no number; a date is told as one.
    """
    if value is None:
        return None
    try:
        return float(value)
    except ValueError:
        text = f"{value!r} is no number of seconds, from the beginning of the bag or since 1970"
    with suppress(ValueError):
        text += f"; in the time here it is {datetime.fromisoformat(value).timestamp():.0f}"
    raise click.BadParameter(text)
