"""Arguments and options of the verbs of `bag`, and corrections of misplaced words."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Sequence
from contextlib import suppress
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from graphflow.cli import output
from graphflow.cli.verbs import Verb
from graphflow.cli.words import pattern_option
from graphflow.errors import InvalidName, UsageFault
from graphflow.names import expand
from graphflow.times import seconds_in

if TYPE_CHECKING:
    from graphflow.bag.topic_choice import Choice

F = TypeVar("F", bound=Callable[..., object])

FORMATS = {"mcap", "sqlite3"}
"""ROS 2's names of bag formats."""


class BagVerb(Verb):
    """A verb of one bag, which corrects misplaced bags, topics and remap rules."""

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
            ctx.fail(f"name topics with --topics: {line}")
        if bag != words[0]:
            ctx.fail(f"the bag comes first: {ctx.command_path} {shlex.join([bag, *topics])}")
        return left


def all_or_some(topics: Sequence[str]) -> str:
    """Return the error text for `-a` with names, one of which may be meant as the bag's."""
    folder = "" if "/" in topics[0] else f"; -o names the bag's folder: graphflow bag record -a -o {topics[0]}"
    return f"-a records all topics: leave it out, or the names {' '.join(topics)}{folder}"


def _rule(ctx: click.Context, left: list[str]) -> str:
    """Return the remap rule that separate words, or a word without -m, were meant as; empty if they are not one."""
    old = next((word for word in ctx.params.get("remaps", ()) if ":=" not in word), None)
    if old is not None:
        return f"{old.rstrip(':=')}:={left[0].lstrip(':=')}"
    return left[0] if "remaps" in ctx.params and ":=" in left[0] else ""


def _is_there(word: str) -> bool:
    return Path(word).exists()


def moment_option(_: click.Context, __: click.Parameter, value: str | None) -> float | None:
    """Convert an option to seconds, from the beginning of a bag or since 1970; a callback for click.

    Raises:
        BadParameter: It is not a number; the text has the number of a date.
    """
    if value is None:
        return None
    try:
        return float(value)
    except ValueError:
        text = f"{value!r} is not a number of seconds, from the beginning of the bag or since 1970"
    if seconds := seconds_in(value):
        text += f"; write {seconds}"
    with suppress(ValueError):
        text += f"; as local time it is {datetime.fromisoformat(value).timestamp():.0f}"
    raise click.BadParameter(text)


def qos_path_option(command: F) -> F:
    """Add the option for the file of QoS profiles to a command."""
    file = click.Path(path_type=Path)
    return click.option("--qos-profile-overrides-path", "qos_path", type=file, help="QoS by topic, in YAML.")(command)


def full_names(words: tuple[str, ...]) -> frozenset[str]:
    """Return the full names in words, each of which may contain several."""
    return frozenset(expand(name, "/", "cli") for word in words for name in word.split())


def type_names(words: tuple[str, ...]) -> frozenset[str]:
    """Return types' full names; `package/Name` is a message. The types need not be known here."""
    from graphflow.msgs import registry

    for word in words:
        if "/" not in word:
            registry.full_name(word)  # raises, unless it is written as in Python
    words = tuple(word.replace(".", "/") for word in words)
    return frozenset(name.replace("/", "/msg/") if name.count("/") == 1 else name for name in words)


def topic_options(command: F) -> F:
    """Add the options that choose topics to a command."""
    option = click.option
    for add in (
        option("--exclude-services", multiple=True, help="Exclude these services."),
        option("--exclude-topic-types", multiple=True, help="Exclude topics of these types."),
        option("--exclude-topics", multiple=True, help="Exclude these topics."),
        option("-x", "--exclude-regex", default="", callback=pattern_option, help="Exclude topics that match."),
        option("-e", "--regex", default="", callback=pattern_option, help="Include topics that match."),
        option("--services", multiple=True, help="Include calls of these services, which need introspection."),
        option("--topics", "named", multiple=True, help="Include these topics."),
    ):
        command = add(command)
    return command


def take_choice(options: dict[str, Any], topics: tuple[str, ...] = (), **more: Any) -> Choice:
    """Remove the options that choose topics, and return the choice."""
    from graphflow.bag.topic_choice import Choice

    named = full_names((*topics, *options.pop("named")))
    services = full_names(options.pop("services"))
    regex = options.pop("regex")
    excluded = {
        "exclude": full_names(options.pop("exclude_topics")),
        "exclude_types": type_names(options.pop("exclude_topic_types")),
        "exclude_regex": options.pop("exclude_regex"),
        "exclude_services": full_names(options.pop("exclude_services")),
    }
    is_open = not (named or services or regex)
    more.setdefault("all", is_open)
    return Choice(topics=named, services=services, regex=regex, **excluded, **more)


def check_for_bags(topics: tuple[str, ...]) -> None:
    """Refuse the path of a bag beside the topics to record if it cannot be a topic's name; note one that can be."""
    for word in topics if len(topics) > 1 else ():
        try:
            expand(word, "/", "cli")
        except InvalidName as error:
            if Path(word).parent.is_dir():
                raise UsageFault(f"{error}; if it is the bag to be written, write -o {word}") from None
    without = [word for word in topics if not word.startswith("/")]
    if len(without) == 1 < len(topics):
        output.talk(f"note: /{without[0]} is recorded; if {without[0]} is the name of the bag, write -o {without[0]}")


def _check_format(_: click.Context, __: click.Parameter, word: str | None) -> str | None:
    """Check that `-s` names a format, not a speed or a start time."""
    if word is not None and word not in FORMATS:
        raise UsageFault(f"-s is the bag's format, {' or '.join(sorted(FORMATS))}, not {word!r}; -r is the speed")
    return word


storage_option = click.option(
    "-s", "--storage", hidden=True, callback=_check_format, help="Accepted for ROS 2; the format is read from the file."
)


def remap_rules(words: tuple[str, ...]) -> dict[str, str]:
    """Parse OLD:=NEW into new full names by old ones."""
    found = {}
    for word in " ".join(words).split():
        old, arrow, new = word.partition(":=")
        if not (old and arrow and new):
            raise UsageFault(
                f"{word!r} is not a remap rule; write OLD:=NEW, for example /turtle1/cmd_vel:=/turtle2/cmd_vel"
            )
        found[expand(old, "/", "cli")] = expand(new, "/", "cli")
    return found


def new_bag_options(command: F) -> F:
    """Add the options for the folder, format and compression of a new bag to a command."""
    option = click.option
    for add in (
        option("--compression", type=click.Choice(["zstd", "lz4", "none"]), help="Compression of MCAP chunks. [zstd]"),
        option(
            "-s",
            "--storage",
            type=click.Choice(["mcap", "sqlite3"]),
            default="mcap",
            help="Format of the files. [mcap]",
        ),
        option(
            "-b",
            "--max-bag-size",
            type=click.IntRange(0),
            default=0,
            help="Bytes after which a new file begins. [0: never]",
        ),
        option("-o", "--output", "folder", type=click.Path(path_type=Path), help="The new bag's folder."),
    ):
        command = add(command)
    return command


def chunk_compression(options: dict[str, Any]) -> str:
    """Return the compression of the files' chunks."""
    if options["storage"] == "sqlite3" and options["compression"] not in (None, "none"):
        raise UsageFault(f"--compression {options['compression']} is for MCAP; leave it out, or write -s mcap")
    return options["compression"] or "zstd"
