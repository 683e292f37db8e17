"""`graphflow bag record`, `play`, `info`, `echo`, `recover`, `convert`, `filter` and `merge`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

import click

from graphflow.cli import exits, output
from graphflow.cli.messages.bag_words import BagVerb, all_or_some, moment_option
from graphflow.cli.messages.plot_options import plot_options
from graphflow.cli.messages.types import use_project
from graphflow.cli.verbs import Verbs
from graphflow.cli.words import pattern_option
from graphflow.errors import UsageFault
from graphflow.names import expand

DELAY = 0.5
"""Seconds before the first message, in which subscriptions find the publishers."""

SHOWN_EVERY = 0.25
"""Seconds between two lines of how far a new bag is, at a terminal."""
_FORMATS = {"mcap", "sqlite3"}
"""ROS 2's names of the formats of bags."""

F = TypeVar("F", bound=Callable[..., Any])


@click.group(cls=Verbs)
def bag() -> None:
    """Record topics into bags, and play and change bags."""


def _qos_path(command: F) -> F:
    """Add the file of QoS profiles by topic."""
    file = click.Path(path_type=Path)
    return click.option("--qos-profile-overrides-path", "qos_path", type=file, help="QoS by topic, in YAML.")(command)


def _names(words: tuple[str, ...]) -> frozenset[str]:
    """Full names, of words that may have several each."""
    return frozenset(expand(name, "/", "cli") for word in words for name in word.split())


def _types(words: tuple[str, ...]) -> frozenset[str]:
    """Types, of which a name without its kind is a message's; they need not be known here."""
    from graphflow.msgs import registry

    for word in words:
        if "/" not in word:
            registry.full_name(word)  # raises, unless it is Python's name
    words = tuple(word.replace(".", "/") for word in words)
    return frozenset(name.replace("/", "/msg/") if name.count("/") == 1 else name for name in words)


def _chosen(command: F) -> F:
    """Add what says which topics are meant."""
    option = click.option
    for add in (
        option("--exclude-services", multiple=True, help="Leave these services out."),
        option("--exclude-topic-types", multiple=True, help="Leave topics of these types out."),
        option("--exclude-topics", multiple=True, help="Leave these topics out."),
        option("-x", "--exclude-regex", default="", callback=pattern_option, help="Leave out topics that match."),
        option("-e", "--regex", default="", callback=pattern_option, help="Topics that match."),
        option("--services", multiple=True, help="Calls of these services, which must have introspection."),
        option("--topics", "named", multiple=True, help="These topics."),
    ):
        command = add(command)
    return command


def _choice(options: dict[str, Any], topics: tuple[str, ...] = (), **more: Any) -> Any:
    """Take out of the options which topics are meant."""
    from graphflow.bag.topic_choice import Choice

    named = _names((*topics, *options.pop("named")))
    services = _names(options.pop("services"))
    regex = options.pop("regex")
    excluded = {
        "exclude": _names(options.pop("exclude_topics")),
        "exclude_types": _types(options.pop("exclude_topic_types")),
        "exclude_regex": options.pop("exclude_regex"),
        "exclude_services": _names(options.pop("exclude_services")),
    }
    is_open = not (named or services or regex)
    more.setdefault("all", is_open)
    return Choice(topics=named, services=services, regex=regex, **excluded, **more)


def _known_format(_: click.Context, __: click.Parameter, word: str | None) -> str | None:
    """See that `-s` names a format, and neither a speed nor a start."""
    if word is not None and word not in _FORMATS:
        raise UsageFault(f"-s is the bag's format, {' or '.join(sorted(_FORMATS))}, not {word!r}; the speed is -r")
    return word


_storage = click.option(
    "-s", "--storage", hidden=True, callback=_known_format, help="For ROS 2's commands: the file says it."
)


@bag.command(short_help="Record topics of the running graph.")
@click.argument("topics", nargs=-1, metavar="[TOPIC...]")
@click.option("-a", "--all", "everything", is_flag=True, help="All topics, and those that appear later.")
@click.option("--all-topics", is_flag=True, help="The same.")
@click.option("--all-services", is_flag=True, help="The calls of all services that have introspection.")
@click.option("--topic-types", multiple=True, help="Topics of these types.")
@_chosen
@click.option("-o", "--output", "folder", type=click.Path(path_type=Path), help="The bag's folder. [rosbag2_DATE-TIME]")
@click.option(
    "-s", "--storage", type=click.Choice(["mcap", "sqlite3"]), default="mcap", help="The format of files. [mcap]"
)
@click.option("-b", "--max-bag-size", type=click.IntRange(0), default=0, help="Bytes before a new file. [0: never]")
@click.option("-d", "--max-bag-duration", type=click.FloatRange(0), default=0.0, help="Seconds before a new file.")
@click.option("--max-cache-size", type=click.IntRange(1), help="Bytes that may wait to be written. [104857600]")
@click.option("--compression", type=click.Choice(["zstd", "lz4", "none"]), help="Of MCAP's chunks. [zstd]")
@click.option("--include-hidden-topics", is_flag=True, help="Hidden topics, too.")
@click.option("--no-discovery", is_flag=True, help="Only topics that are there at the start.")
@click.option("--start-paused", is_flag=True, help="Begin when SPACE is pressed.")
@click.option("--snapshot-mode", is_flag=True, help="Write the last messages when ~/snapshot is called or S pressed.")
@click.option("--duration", type=click.FloatRange(0, min_open=True), help="Seconds to record.")
@click.option(
    "--qos-profile-overrides-path", "qos_path", type=click.Path(path_type=Path), help="QoS by topic, in YAML."
)
@click.option("--include-unpublished-topics", is_flag=True, help="Topics that are only listened to, too.")
@click.option("--ignore-leaf-topics", is_flag=True, help="No topics that nobody else listens to.")
@click.option("--topic-throttle-frequency", multiple=True, metavar="TOPIC=HZ", help="Record it so often, not more.")
@click.option(
    "--repeat-transient-local", multiple=True, metavar="TOPIC[=NUMBER]", help="Repeat its last messages in each file."
)
@click.option(
    "--repeat-all-transient-local",
    is_flag=False,
    flag_value=1,
    default=0,
    type=click.IntRange(0, 1000),
    help="Repeat so many of each transient-local topic. [1]",
)
@click.option("--use-sim-time", is_flag=True, help="Stamp messages by /clock.")
@click.option("--custom-data", multiple=True, help="KEY=VALUE, for the bag's metadata.")
@click.option("--disable-keyboard-controls", is_flag=True, help="Keys do nothing.")
@click.option("-f", "--serialization-format", type=click.Choice(["cdr"]), hidden=True, help="For ROS 2's commands.")
@click.option("--compression-queue-size", type=int, hidden=True, help="For ROS 2's commands.")
@click.option("--compression-threads", type=int, hidden=True, help="For ROS 2's commands.")
@click.option("--node-name", default="rosbag2_recorder", show_default=True, help="Name of the recording node.")
@click.option(
    "-p", "--polling-interval", type=int, hidden=True, help="For ROS 2's commands: the graph tells by itself."
)
def record(topics: tuple[str, ...], **options: Any) -> int:
    """Record topics of the running graph into a folder, in MCAP or .db3 files. Ctrl-C ends it, SPACE pauses it."""
    if topics and (options["everything"] or options["all_topics"]):
        raise UsageFault(all_or_some(topics))
    from graphflow.cli.messages import recording

    use_project()
    everything = any([options.pop("everything"), options.pop("all_topics")])
    types = _types(options.pop("topic_types"))
    more = {"all": everything, "types": types, "all_services": options.pop("all_services")}
    choice = _choice(options, topics, **more, hidden=options.pop("include_hidden_topics"))
    if not (everything or types or choice.all_services or choice.topics or choice.services or choice.regex):
        folder = options["folder"]
        taken = f"; -o took {folder} as the bag's folder" if folder is not None else ""
        raise UsageFault(f"nothing to record was named{taken}; write topics, or -a for all: graphflow bag record -a")
    options["compression"] = _compression(options)
    ours = ("polling_interval", "serialization_format", "compression_queue_size", "compression_threads")
    for unused in ours:
        options.pop(unused)
    return recording.run(choice, recording.RecordOptions(**options))


@bag.command(cls=BagVerb, short_help="Play a bag into the running graph.")
@click.argument("path", metavar="BAG", type=click.Path(path_type=Path))
@_chosen
@click.option("-r", "--rate", type=click.FloatRange(0.001, 1000), default=1.0, help="Speed. [1.0]")
@click.option("-l", "--loop", is_flag=True, help="Again and again.")
@click.option("-p", "--start-paused", is_flag=True, help="Begin when SPACE is pressed.")
@click.option("--start-offset", type=click.FloatRange(0), default=0.0, help="Seconds of the bag to leave out.")
@click.option("--playback-duration", type=click.FloatRange(0, min_open=True), help="Seconds of the bag to play.")
@click.option("--playback-until-sec", type=click.FloatRange(0, min_open=True), help="Play up to here, since 1970.")
@click.option("--playback-until-nsec", type=click.IntRange(1), help="The same in nanoseconds.")
@click.option(
    "-d", "--delay", type=click.FloatRange(0), default=DELAY, show_default=True, help="Seconds before the start."
)
@click.option("--clock", "clock", is_flag=False, flag_value="40", default="0", help="Publish /clock, so often. [40 Hz]")
@click.option("--clock-topics", multiple=True, help="Publish /clock with each message of these topics, too.")
@click.option("--clock-topics-all", is_flag=True, help="Publish /clock with each message.")
@click.option(
    "--qos-profile-overrides-path", "qos_path", type=click.Path(path_type=Path), help="QoS by topic, in YAML."
)
@click.option("-m", "--remap", "remaps", multiple=True, help="OLD:=NEW, for a topic.")
@click.option("--allow-commands", is_flag=True, help="Play what makes others act: goals of actions, calls of services.")
@click.option("--node-name", default="rosbag2_player", show_default=True, help="Name of the playing node.")
@_storage
@click.option("--read-ahead-queue-size", type=int, hidden=True, help="For ROS 2's commands.")
@click.option("--disable-loan-message", is_flag=True, hidden=True, help="For ROS 2's commands.")
@click.option("--disable-keyboard-controls", is_flag=True, help="Keys do nothing.")
def play(path: Path, **options: Any) -> int:
    """Play a bag into the running graph: a folder, an MCAP file, a .db3 file or ROS 1's .bag.

    \b
    SPACE        pause and go on
    RIGHT, or s  send the next message while paused
    UP, DOWN     faster, slower, by a tenth
    """  # noqa: D301 - click wants the character
    from graphflow.bag.overrides import read as read_overrides
    from graphflow.bag.player import PlayOptions
    from graphflow.cli.messages import playing

    use_project()
    for unused in ("storage", "read_ahead_queue_size"):
        options.pop(unused)
    try:
        clock_hz = float(options.pop("clock"))
        if not 0 <= clock_hz <= 10_000:
            raise ValueError(clock_hz)
    except ValueError:
        raise UsageFault("--clock takes a number of Hz; write it as --clock=40, or behind the bag") from None
    chosen = PlayOptions(
        rate=options["rate"],
        loop=options["loop"],
        start_offset=options["start_offset"],
        duration=options["playback_duration"],
        until_ns=options["playback_until_nsec"] or round((options["playback_until_sec"] or 0) * 1e9) or None,
        delay=options["delay"],
        clock_hz=clock_hz,
        is_paused=options["start_paused"],
        allows_commands=options["allow_commands"],
        choice=_choice(options, hidden=True),
        remaps=_remaps(options["remaps"]),
        qos={} if options["qos_path"] is None else read_overrides(options["qos_path"]),
        clock_topics=_names(options["clock_topics"]),
        clocks_all=options["clock_topics_all"],
    )
    return playing.run(path, chosen, options["node_name"], keys=not options["disable_keyboard_controls"])


@bag.command(cls=BagVerb, short_help="Send messages of a bag at once.")
@click.argument("path", metavar="BAG", type=click.Path(path_type=Path))
@_chosen
@click.option("-n", "--num-messages", type=click.IntRange(0), default=0, help="How many; 0 for all. [0]")
@click.option("--start-offset", type=click.FloatRange(0), default=0.0, help="Seconds of the bag to leave out.")
@click.option("-m", "--remap", "remaps", multiple=True, help="OLD:=NEW, for a topic.")
@click.option(
    "--qos-profile-overrides-path", "qos_path", type=click.Path(path_type=Path), help="QoS by topic, in YAML."
)
@click.option("--allow-commands", is_flag=True, help="Send what makes others act: goals of actions, calls of services.")
@click.option("--node-name", default="rosbag2_player", show_default=True, help="Name of the sending node.")
@_storage
@click.option("--read-ahead-queue-size", type=int, hidden=True, help="For ROS 2's commands.")
@click.option("--disable-loan-message", is_flag=True, hidden=True, help="For ROS 2's commands.")
def burst(path: Path, num_messages: int, **options: Any) -> int:
    """Send messages of a bag into the running graph, one right after the other."""
    from graphflow.bag.overrides import read as read_overrides
    from graphflow.bag.player import PlayOptions
    from graphflow.cli.messages import playing

    use_project()
    chosen = PlayOptions(
        start_offset=options["start_offset"],
        delay=DELAY,
        allows_commands=options["allow_commands"],
        choice=_choice(options, hidden=True),
        remaps=_remaps(options["remaps"]),
        qos={} if options["qos_path"] is None else read_overrides(options["qos_path"]),
    )
    return playing.run(path, chosen, options["node_name"], keys=False, burst=num_messages)


def _remaps(words: tuple[str, ...]) -> dict[str, str]:
    found = {}
    for word in " ".join(words).split():
        old, arrow, new = word.partition(":=")
        if not (old and arrow and new):
            raise UsageFault(
                f"{word!r} is no remap rule; write OLD:=NEW, for example /turtle1/cmd_vel:=/turtle2/cmd_vel"
            )
        found[expand(old, "/", "cli")] = expand(new, "/", "cli")
    return found


@bag.command()
@click.argument("path", metavar="BAG", type=click.Path(path_type=Path))
@click.option("-t", "--topic-name", is_flag=True, help="Only the names of topics.")
@click.option("-v", "--verbose", is_flag=True, help="Also QoS, hash and definition of each topic.")
@click.option("--sort", type=click.Choice(["name", "type", "count"]), default="name", help="Order of topics. [name]")
@_storage
@click.option("--json", "json_", is_flag=True, help="Print JSON.")
def info(path: Path, topic_name: bool, verbose: bool, sort: str, storage: str, json_: bool) -> int:  # noqa: ARG001
    """Show what is in a bag."""
    from graphflow.bag import info as about
    from graphflow.bag.reader import Bag

    found = Bag(path)
    if json_:
        output.as_json(about.as_json(found))
    elif topic_name:
        output.lines(sorted(found.contents.topics))
    else:
        output.lines(about.lines(found, sort, verbose=verbose))
    return exits.OK


@bag.command(cls=BagVerb)
@click.argument("path", metavar="BAG", type=click.Path(path_type=Path))
@click.argument("topics", nargs=-1, metavar="[TOPIC...]")
@click.option("-n", "--count", type=click.IntRange(1), help="Only so many messages.")
@click.option("--csv", is_flag=True, help="Time, topic and values, separated by commas.")
@click.option("--json", "json_", is_flag=True, help="One JSON object per line.")
@click.option("-f", "--full-length", is_flag=True, help="Show long arrays and strings in full.")
def echo(path: Path, topics: tuple[str, ...], count: int | None, csv: bool, json_: bool, full_length: bool) -> int:
    """Show the messages of a bag."""
    from itertools import islice

    from graphflow.bag.missing import check_messages, remarks
    from graphflow.bag.reader import Bag
    from graphflow.bag.topic_choice import Choice
    from graphflow.bag.typed import said as messages
    from graphflow.introspect.messages import echo as texts

    use_project()
    found, named = Bag(path), _names(topics)
    absent = remarks([found], Choice(topics=named))
    wanted = named & found.contents.topics.keys() if named else found.contents.topics.keys()
    check_messages([found], wanted, absent)
    _note(path, absent)
    for said in islice(messages(found.records(wanted)), count):
        data = texts.plain(said.message)
        if json_:
            output.as_json({"topic": said.topic, "time_ns": said.time_ns, "message": data})
        elif csv:
            output.data(f"{said.time_ns},{said.topic},{texts.csv(data)}")
        else:
            shown = data if full_length else texts.truncated(data)
            when = f"{said.time_ns // 10**9}.{said.time_ns % 10**9:09d}"
            output.data(f"# {said.topic} {when}\n{texts.block(shown)}\n---")
    return exits.OK


@bag.command(cls=BagVerb, short_help="Draw numbers of a bag as curves.")
@click.argument("path", metavar="BAG", type=click.Path(path_type=Path))
@click.argument("names", metavar="TOPIC[.FIELD,...]...", nargs=-1, required=True)
@click.option("--start", type=click.FloatRange(0), default=0.0, help="Seconds of the bag to leave out.")
@click.option("--end", type=click.FloatRange(0), help="Second of the bag to stop at.")
@plot_options
def plot(path: Path, names: tuple[str, ...], start: float, end: float | None, **options: Any) -> int:
    """Draw numbers of a bag as curves, in the terminal or into a file.

    \b
    graphflow bag plot my_bag /turtle1/pose.x,y
    graphflow bag plot my_bag /turtle1/pose.theta --png theta.png
    """  # noqa: D301 - click wants the character
    from graphflow.cli.messages import plotting

    use_project()
    chosen = plotting.PlotOptions(**options)
    chosen.check()
    return plotting.recorded(path, names, start, end, chosen)


def _made(command: F) -> F:
    """Add what says where a bag that is made of others goes, and how it is packed."""
    option = click.option
    for add in (
        option("--compression", type=click.Choice(["zstd", "lz4", "none"]), help="Of MCAP's chunks. [zstd]"),
        option("-s", "--storage", type=click.Choice(["mcap", "sqlite3"]), default="mcap", help="The format. [mcap]"),
        option("-b", "--max-bag-size", type=click.IntRange(0), default=0, help="Bytes before a new file. [0: never]"),
        option("-o", "--output", "folder", type=click.Path(path_type=Path), help="The new bag's folder."),
    ):
        command = add(command)
    return command


@bag.command()
@click.argument("path", metavar="BAG", type=click.Path(path_type=Path))
@_made
def recover(path: Path, **options: Any) -> int:
    """Make a whole bag of one that was not closed properly."""
    return _copied((path,), "recovered", options)


bag.add_command(recover, "reindex")


@bag.command()
@click.argument("words", metavar="BAG", nargs=-1)
@click.option("-i", "--input", "inputs", multiple=True, metavar="BAG", help="The bag; several become one.")
@click.option("--output-options", type=click.Path(path_type=Path), help="File that says which bags to make.")
@_made
def convert(words: tuple[str, ...], inputs: tuple[str, ...], output_options: Path | None, **options: Any) -> int:
    """Write a bag anew: a .db3 or ROS 1's .bag as MCAP, compressed otherwise, in one file or several.

    Where -o names a file and not a new folder, it is one of ROS 2's, which says what bags to make.
    """
    from graphflow.bag import output_options as outputs

    formats = _FORMATS.intersection(words) if inputs else set()  # ROS 2 takes them behind the bag: the file says it
    paths = tuple(Path(word) for word in (*inputs, *words) if word not in formats)
    if not paths or (len(paths) > 1 and not inputs):
        raise UsageFault("name one bag, or several by -i: graphflow bag convert -i A -i B -o BOTH")
    if output_options is None and options["folder"] is not None and outputs.is_options(options["folder"]):
        output_options = options["folder"]
    if output_options is None:
        return _copied(paths, "converted", options)
    for made in outputs.read(output_options):
        _note(output_options, made.remarks)
        options.update(folder=made.folder, storage=made.storage, compression=made.compression)
        options.update(max_bag_size=made.max_size, max_seconds=made.max_seconds, times=(made.start_ns, made.end_ns))
        _copied(paths, "converted", options, made.choice)
    return exits.OK


@bag.command("filter", cls=BagVerb)
@click.argument("path", metavar="BAG", type=click.Path(path_type=Path))
@_chosen
@click.option(
    "--start", callback=moment_option, help="From here on: seconds from the beginning of the bag, or since 1970."
)
@click.option("--end", callback=moment_option, help="Up to here.")
@click.option("-m", "--remap", "remaps", multiple=True, help="OLD:=NEW, for a topic.")
@_made
def filter_(path: Path, **options: Any) -> int:
    """Write some topics of a bag, or some time of it, into a new one."""
    choice = _choice(options, hidden=True)
    if choice.all:
        choice = replace(choice, all_services=True)
    return _copied((path,), "filtered", options, choice)


@bag.command()
@click.argument("paths", metavar="BAG...", type=click.Path(path_type=Path), nargs=-1, required=True)
@_made
def merge(paths: tuple[Path, ...], **options: Any) -> int:
    """Write several bags into a new one, in the order of their times."""
    return _copied(paths, "merged", options)


def _compression(options: dict[str, Any]) -> str:
    """How the chunks of files are compressed."""
    if options["storage"] == "sqlite3" and options["compression"] not in (None, "none"):
        raise UsageFault(f"--compression {options['compression']} is for MCAP; leave it out, or write -s mcap")
    return options["compression"] or "zstd"


def _note(path: Path, absent: list[str]) -> None:
    """Tell of names that a bag does not have, where there is something else to do."""
    for remark in absent:
        output.talk(f"note: {path}: {remark}")


def _progress(folder: Path) -> Callable[[int, int | None], None]:
    """Show how far a bag is that is being made, a few times a second."""
    from time import monotonic

    shown = monotonic()

    def told(count: int, total: int | None) -> None:
        nonlocal shown
        if monotonic() - shown >= SHOWN_EVERY:
            shown = monotonic()
            of_all = "" if total is None else f" of {total:,}"
            output.progress(f"{folder}: {count:,}{of_all} messages")

    return told


def _copied(paths: tuple[Path, ...], word: str, options: dict[str, Any], choice: Any = None) -> int:
    from graphflow.bag.copying import beside, copy, times
    from graphflow.bag.info import size, topics_of
    from graphflow.bag.missing import check_messages, remarks
    from graphflow.bag.reader import Bag
    from graphflow.bag.topic_choice import Choice
    from graphflow.bag.writer import BagWriter

    bags = []
    for path in paths:
        output.progress(f"reading {path}")  # one that was not closed, or is compressed, is read as a whole
        bags.append(Bag(path))
    output.progress("")
    start_ns, end_ns = options.get("times") or times(bags, options.get("start"), options.get("end"))
    remaps = _remaps(options.get("remaps", ()))
    folder = options["folder"] or beside(paths[0], word)
    every = choice or Choice(all=True, hidden=True, all_services=True)
    absent = remarks(bags, every, remaps)
    wanted = {name for bag in bags for name, topic in bag.contents.topics.items() if every.wants(name, topic.type)}
    check_messages(bags, wanted, absent, start_ns, end_ns)
    _note(paths[0], absent)
    size_limit, seconds = options["max_bag_size"], options.get("max_seconds", 0.0)
    packed = {"storage": options["storage"], "compression": _compression(options)}
    with BagWriter(folder, **packed, max_size=size_limit, max_seconds=seconds) as writer:
        try:
            told = _progress(folder)
            copied = copy(bags, writer, every, remaps=remaps, start_ns=start_ns, end_ns=end_ns, told=told)
        finally:
            output.progress("")
    output.data(f"{folder}: {copied.message_count:,} messages of {topics_of(len(copied.topics))}, {size(writer.size)}")
    return exits.OK
