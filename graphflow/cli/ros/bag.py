"""`graphflow bag record`, `play`, `burst`, `info`, `echo`, `plot`, `recover`, `convert`, `filter` and `merge`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from graphflow.cli import exits, output
from graphflow.cli.messages.bag_words import (
    FORMATS,
    BagVerb,
    all_or_some,
    check_for_bags,
    chunk_compression,
    full_names,
    moment_option,
    new_bag_options,
    qos_path_option,
    remap_rules,
    storage_option,
    take_choice,
    topic_options,
    type_names,
)
from graphflow.cli.messages.plot_options import plot_options
from graphflow.cli.messages.types import use_project
from graphflow.cli.verbs import Verbs
from graphflow.errors import UsageFault

if TYPE_CHECKING:
    from graphflow.bag.topic_choice import Choice

DELAY = 0.5
"""Seconds before the first message, in which subscriptions discover the publishers."""

SHOWN_EVERY = 0.25
"""Seconds between two updates of the progress line."""


@click.group(cls=Verbs)
def bag() -> None:
    """Record, play, inspect and convert bags."""


@bag.command(short_help="Record topics of the running graph.")
@click.argument("topics", nargs=-1, metavar="[TOPIC...]")
@click.option("-a", "--all", "everything", is_flag=True, help="Record all topics, including those that appear later.")
@click.option("--all-topics", is_flag=True, help="Same as -a.")
@click.option("--all-services", is_flag=True, help="Record the calls of all services with introspection.")
@click.option("--topic-types", multiple=True, help="Record topics of these types.")
@topic_options
@click.option("-o", "--output", "folder", type=click.Path(path_type=Path), help="The bag's folder. [rosbag2_DATE-TIME]")
@click.option(
    "-s", "--storage", type=click.Choice(["mcap", "sqlite3"]), default="mcap", help="Format of the files. [mcap]"
)
@click.option(
    "-b", "--max-bag-size", type=click.IntRange(0), default=0, help="Bytes after which a new file begins. [0: never]"
)
@click.option(
    "-d", "--max-bag-duration", type=click.FloatRange(0), default=0.0, help="Seconds after which a new file begins."
)
@click.option("--max-cache-size", type=click.IntRange(1), help="Bytes that may wait to be written. [104857600]")
@click.option("--compression", type=click.Choice(["zstd", "lz4", "none"]), help="Compression of MCAP chunks. [zstd]")
@click.option("--include-hidden-topics", is_flag=True, help="Include hidden topics.")
@click.option("--no-discovery", is_flag=True, help="Record only topics that exist at the start.")
@click.option("--start-paused", is_flag=True, help="Start paused; SPACE resumes.")
@click.option(
    "--snapshot-mode", is_flag=True, help="Write only the last messages, when S is pressed or ~/snapshot called."
)
@click.option("--duration", type=click.FloatRange(0, min_open=True), help="Seconds to record.")
@qos_path_option
@click.option("--include-unpublished-topics", is_flag=True, help="Include topics without publishers.")
@click.option("--ignore-leaf-topics", is_flag=True, help="Exclude topics without other subscriptions.")
@click.option(
    "--topic-throttle-frequency", multiple=True, metavar="TOPIC=HZ", help="Highest rate at which a topic is recorded."
)
@click.option(
    "--repeat-transient-local",
    multiple=True,
    metavar="TOPIC[=NUMBER]",
    help="Repeat the topic's last messages in each file.",
)
@click.option(
    "--repeat-all-transient-local",
    is_flag=False,
    flag_value=1,
    default=0,
    type=click.IntRange(0, 1000),
    help="The same for each transient-local topic: how many messages. [1]",
)
@click.option("--use-sim-time", is_flag=True, help="Stamp messages with the time of /clock.")
@click.option("--custom-data", multiple=True, help="KEY=VALUE, for the bag's metadata.")
@click.option("--disable-keyboard-controls", is_flag=True, help="Ignore the keyboard.")
@click.option("-f", "--serialization-format", type=click.Choice(["cdr"]), hidden=True, help="Accepted for ROS 2.")
@click.option("--compression-queue-size", type=int, hidden=True, help="Accepted for ROS 2.")
@click.option("--compression-threads", type=int, hidden=True, help="Accepted for ROS 2.")
@click.option("--node-name", default="rosbag2_recorder", show_default=True, help="Name of the recording node.")
@click.option(
    "-p",
    "--polling-interval",
    type=int,
    hidden=True,
    help="Accepted for ROS 2; changes are discovered without polling.",
)
def record(topics: tuple[str, ...], **options: Any) -> int:
    """Record topics of the running graph into a folder, as MCAP or .db3 files. SPACE pauses, Ctrl-C ends it."""
    if topics and (options["everything"] or options["all_topics"]):
        raise UsageFault(all_or_some(topics))
    if options["folder"] is None:
        check_for_bags(topics)
    from graphflow.cli.messages import recording

    use_project()
    everything = any([options.pop("everything"), options.pop("all_topics")])
    types = type_names(options.pop("topic_types"))
    more = {"all": everything, "types": types, "all_services": options.pop("all_services")}
    choice = take_choice(options, topics, **more, hidden=options.pop("include_hidden_topics"))
    if not (everything or types or choice.all_services or choice.topics or choice.services or choice.regex):
        folder = options["folder"]
        note = f"; {folder}, after -o, is the bag's folder" if folder is not None else ""
        raise UsageFault(f"no topics to record{note}; name topics, or record all: graphflow bag record -a")
    options["compression"] = chunk_compression(options)
    ignored = ("polling_interval", "serialization_format", "compression_queue_size", "compression_threads")
    for unused in ignored:
        options.pop(unused)
    return recording.run(choice, recording.RecordOptions(**options))


class _SpeedFactor(click.FloatRange):
    """A factor; -r is also that of a remap elsewhere."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        if isinstance(value, str) and ":=" in value:
            self.fail(f"{value!r} is a remap rule: write -m {value}", param, ctx)
        return super().convert(value, param, ctx)


@bag.command(cls=BagVerb, short_help="Play a bag into the running graph.")
@click.argument("path", metavar="BAG", type=click.Path(path_type=Path))
@topic_options
@click.option("-r", "--rate", type=_SpeedFactor(0.001, 1000), default=1.0, help="Speed factor. [1.0]")
@click.option("-l", "--loop", is_flag=True, help="Play repeatedly.")
@click.option("-p", "--start-paused", is_flag=True, help="Start paused; SPACE resumes.")
@click.option("--start-offset", type=click.FloatRange(0), default=0.0, help="Seconds of the bag to skip.")
@click.option("--playback-duration", type=click.FloatRange(0, min_open=True), help="Seconds of the bag to play.")
@click.option(
    "--playback-until-sec",
    type=click.FloatRange(0, min_open=True),
    help="Time at which to stop, in seconds since 1970.",
)
@click.option("--playback-until-nsec", type=click.IntRange(1), help="The same in nanoseconds.")
@click.option(
    "-d", "--delay", type=click.FloatRange(0), default=DELAY, show_default=True, help="Seconds before the start."
)
@click.option(
    "--clock", "clock", is_flag=False, flag_value="40", default="0", help="Publish /clock at this rate. [40 Hz]"
)
@click.option("--clock-topics", multiple=True, help="Publish /clock with each message of these topics, too.")
@click.option("--clock-topics-all", is_flag=True, help="Publish /clock with each message.")
@qos_path_option
@click.option("-m", "--remap", "remaps", multiple=True, help="Rename a topic, OLD:=NEW.")
@click.option("--allow-commands", is_flag=True, help="Also play what makes nodes act: goals and service calls.")
@click.option("--node-name", default="rosbag2_player", show_default=True, help="Name of the playing node.")
@storage_option
@click.option("--read-ahead-queue-size", type=int, hidden=True, help="Accepted for ROS 2.")
@click.option("--disable-loan-message", is_flag=True, hidden=True, help="Accepted for ROS 2.")
@click.option("--disable-keyboard-controls", is_flag=True, help="Ignore the keyboard.")
def play(path: Path, **options: Any) -> int:
    """Play a bag into the running graph: a folder, an MCAP file, a .db3 file or a ROS 1 .bag.

    \b
    SPACE        pause and resume
    RIGHT, or s  play the next message while paused
    UP, DOWN     play faster or slower by 10 %
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
        raise UsageFault("--clock takes a rate in Hz; write it as --clock=40, or put --clock after the bag") from None
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
        choice=take_choice(options, hidden=True),
        remaps=remap_rules(options["remaps"]),
        qos={} if options["qos_path"] is None else read_overrides(options["qos_path"]),
        clock_topics=full_names(options["clock_topics"]),
        clocks_all=options["clock_topics_all"],
    )
    return playing.run(path, chosen, options["node_name"], keys=not options["disable_keyboard_controls"])


@bag.command(cls=BagVerb, short_help="Publish messages of a bag at once.")
@click.argument("path", metavar="BAG", type=click.Path(path_type=Path))
@topic_options
@click.option("-n", "--num-messages", type=click.IntRange(0), default=0, help="Number of messages; 0 for all. [0]")
@click.option("--start-offset", type=click.FloatRange(0), default=0.0, help="Seconds of the bag to skip.")
@click.option("-m", "--remap", "remaps", multiple=True, help="Rename a topic, OLD:=NEW.")
@qos_path_option
@click.option("--allow-commands", is_flag=True, help="Also send what makes nodes act: goals and service calls.")
@click.option("--node-name", default="rosbag2_player", show_default=True, help="Name of the sending node.")
@storage_option
@click.option("--read-ahead-queue-size", type=int, hidden=True, help="Accepted for ROS 2.")
@click.option("--disable-loan-message", is_flag=True, hidden=True, help="Accepted for ROS 2.")
def burst(path: Path, num_messages: int, **options: Any) -> int:
    """Publish messages of a bag into the running graph as fast as possible."""
    from graphflow.bag.overrides import read as read_overrides
    from graphflow.bag.player import PlayOptions
    from graphflow.cli.messages import playing

    use_project()
    chosen = PlayOptions(
        start_offset=options["start_offset"],
        delay=DELAY,
        allows_commands=options["allow_commands"],
        choice=take_choice(options, hidden=True),
        remaps=remap_rules(options["remaps"]),
        qos={} if options["qos_path"] is None else read_overrides(options["qos_path"]),
    )
    return playing.run(path, chosen, options["node_name"], keys=False, burst=num_messages)


@bag.command()
@click.argument("path", metavar="BAG", type=click.Path(path_type=Path))
@click.option("-t", "--topic-name", is_flag=True, help="Print only the names of topics.")
@click.option("-v", "--verbose", is_flag=True, help="Also show QoS, hash and definition of each topic.")
@click.option("--sort", type=click.Choice(["name", "type", "count"]), default="name", help="Order of topics. [name]")
@storage_option
@click.option("--json", "json_", is_flag=True, help="Print JSON.")
def info(path: Path, topic_name: bool, verbose: bool, sort: str, storage: str, json_: bool) -> int:  # noqa: ARG001
    """Show a bag's topics, message counts and times."""
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
@click.option("-n", "--count", type=click.IntRange(1), help="Print at most this many messages.")
@click.option("--csv", is_flag=True, help="Print time, topic and values, separated by commas.")
@click.option("--json", "json_", is_flag=True, help="Print one JSON object per line.")
@click.option("-f", "--full-length", is_flag=True, help="Show long arrays and strings in full.")
def echo(path: Path, topics: tuple[str, ...], count: int | None, csv: bool, json_: bool, full_length: bool) -> int:
    """Show the messages of a bag."""
    from itertools import islice

    from graphflow.bag.missing import check_messages, remarks
    from graphflow.bag.reader import Bag
    from graphflow.bag.topic_choice import Choice
    from graphflow.bag.typed import messages
    from graphflow.introspect.messages import echo as texts

    use_project()
    found, named = Bag(path), full_names(topics)
    absent = remarks([found], Choice(topics=named))
    wanted = named & found.contents.topics.keys() if named else found.contents.topics.keys()
    check_messages([found], wanted, absent)
    _note(path, absent)
    for message in islice(messages(found.records(wanted)), count):
        data = texts.plain(message.message)
        if json_:
            output.as_json({"topic": message.topic, "time_ns": message.time_ns, "message": data})
        elif csv:
            output.data(f"{message.time_ns},{message.topic},{texts.csv(data)}")
        else:
            shown = data if full_length else texts.truncated(data)
            when = f"{message.time_ns // 10**9}.{message.time_ns % 10**9:09d}"
            output.data(f"# {message.topic} {when}\n{texts.block(shown)}\n---")
    return exits.OK


@bag.command(cls=BagVerb, short_help="Draw numbers of a bag as curves.")
@click.argument("path", metavar="BAG", type=click.Path(path_type=Path))
@click.argument("names", metavar="TOPIC[.FIELD,...]...", nargs=-1, required=True)
@click.option("--start", type=click.FloatRange(0), default=0.0, help="Seconds of the bag to skip.")
@click.option("--end", type=click.FloatRange(0), help="Seconds from the beginning of the bag at which to stop.")
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
    return plotting.plot_bag(path, names, start, end, chosen)


@bag.command()
@click.argument("path", metavar="BAG", type=click.Path(path_type=Path))
@new_bag_options
def recover(path: Path, **options: Any) -> int:
    """Repair a bag that was not closed properly, into a new one."""
    return _copy_bags((path,), "recovered", options)


bag.add_command(recover, "reindex")


@bag.command()
@click.argument("words", metavar="BAG", nargs=-1)
@click.option("-i", "--input", "inputs", multiple=True, metavar="BAG", help="A bag to read; several are merged.")
@click.option(
    "--output-options", type=click.Path(path_type=Path), help="File that describes the bags to write, as in ROS 2."
)
@new_bag_options
def convert(words: tuple[str, ...], inputs: tuple[str, ...], output_options: Path | None, **options: Any) -> int:
    """Convert a bag to another format, compression or file size.

    .db3 files and ROS 1 .bags become MCAP unless -s is given. If -o names an existing file, it is read as
    --output-options.
    """
    from graphflow.bag import output_options as outputs

    formats = FORMATS.intersection(words) if inputs else set()  # ROS 2 has them after the bag
    paths = tuple(Path(word) for word in (*inputs, *words) if word not in formats)
    if not paths or (len(paths) > 1 and not inputs):
        raise UsageFault("name one bag, or several with -i: graphflow bag convert -i A -i B -o BOTH")
    if output_options is None and options["folder"] is not None and outputs.is_options(options["folder"]):
        output_options = options["folder"]
    if output_options is None:
        return _copy_bags(paths, "converted", options)
    for wanted in outputs.read(output_options):
        _note(output_options, wanted.remarks)
        options.update(folder=wanted.folder, storage=wanted.storage, compression=wanted.compression)
        options.update(
            max_bag_size=wanted.max_size, max_seconds=wanted.max_seconds, times=(wanted.start_ns, wanted.end_ns)
        )
        _copy_bags(paths, "converted", options, wanted.choice)
    return exits.OK


@bag.command("filter", cls=BagVerb)
@click.argument("path", metavar="BAG", type=click.Path(path_type=Path))
@topic_options
@click.option(
    "--start", callback=moment_option, help="Start time: seconds from the beginning of the bag, or since 1970."
)
@click.option("--end", callback=moment_option, help="End time, likewise.")
@click.option("-m", "--remap", "remaps", multiple=True, help="Rename a topic, OLD:=NEW.")
@new_bag_options
def filter_(path: Path, **options: Any) -> int:
    """Copy some topics of a bag, or a span of its time, into a new bag."""
    choice = take_choice(options, hidden=True)
    if choice.all:
        choice = replace(choice, all_services=True)
    return _copy_bags((path,), "filtered", options, choice)


@bag.command()
@click.argument("paths", metavar="BAG...", type=click.Path(path_type=Path), nargs=-1, required=True)
@new_bag_options
def merge(paths: tuple[Path, ...], **options: Any) -> int:
    """Merge several bags into a new one, in the order of time."""
    return _copy_bags(paths, "merged", options)


def _note(path: Path, absent: list[str]) -> None:
    """Warn about names that a bag does not have."""
    for remark in absent:
        output.talk(f"note: {path}: {remark}")


def _progress(folder: Path) -> Callable[[int, int | None], None]:
    """Return a function that shows the progress of a new bag, a few times a second."""
    from time import monotonic

    shown = monotonic()

    def show(count: int, total: int | None) -> None:
        nonlocal shown
        if monotonic() - shown >= SHOWN_EVERY:
            shown = monotonic()
            of_all = "" if total is None else f" of {total:,}"
            output.progress(f"{folder}: {count:,}{of_all} messages")

    return show


def _copy_bags(paths: tuple[Path, ...], word: str, options: dict[str, Any], choice: Choice | None = None) -> int:
    from graphflow.bag.copying import beside, copy, joined, times
    from graphflow.bag.info import size, topics_of
    from graphflow.bag.missing import check_messages, remarks
    from graphflow.bag.reader import Bag
    from graphflow.bag.topic_choice import Choice
    from graphflow.bag.writer import BagWriter

    bags = []
    for path in paths:
        output.progress(f"reading {path}")  # takes a while: an unclosed or compressed bag is read completely
        bags.append(Bag(path))
    output.progress("")
    start_ns, end_ns = options.get("times") or times(bags, options.get("start"), options.get("end"))
    remaps = remap_rules(options.get("remaps", ()))
    folder = options["folder"] or beside(paths[0], word)
    every = choice or Choice(all=True, hidden=True, all_services=True)
    absent = remarks(bags, every, remaps)
    wanted = {name for bag in bags for name, topic in bag.contents.topics.items() if every.wants(name, topic.type)}
    check_messages(bags, wanted, absent, start_ns, end_ns)
    _note(paths[0], absent)
    topics = joined(bags, every, remaps)
    size_limit, seconds = options["max_bag_size"], options.get("max_seconds", 0.0)
    packed = {"storage": options["storage"], "compression": chunk_compression(options)}
    with BagWriter(folder, **packed, max_size=size_limit, max_seconds=seconds) as writer:
        try:
            show = _progress(folder)
            copied = copy(bags, writer, topics, start_ns=start_ns, end_ns=end_ns, on_progress=show)
        finally:
            output.progress("")
    output.data(f"{folder}: {copied.message_count:,} messages of {topics_of(len(copied.topics))}, {size(writer.size)}")
    return exits.OK
