"""The work of `bag record`: record a choice of topics with keys, services and a progress line."""

from __future__ import annotations

import asyncio
import contextlib
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from graphflow.bag.info import size, topics_of
from graphflow.bag.overrides import read as read_overrides
from graphflow.bag.recording.latched import Repeats
from graphflow.bag.recording.recorder import CACHE, Recorder
from graphflow.bag.topic_choice import EVENTS, Choice
from graphflow.bag.writer import BagWriter
from graphflow.cli import exits, output
from graphflow.cli.keys import key_presses
from graphflow.cli.temporary_node import run_with_node
from graphflow.errors import BagError, UsageFault
from graphflow.introspect.empty_hint import nothing_here
from graphflow.msgs.rosbag2_interfaces.srv import IsPaused, Pause, Resume, Snapshot, SplitBagfile
from graphflow.names import check_node_name, expand
from graphflow.qos import Qos
from graphflow.runtime.node import Node

SHOWN_EVERY = 1.0
"""Seconds between two updates of the progress line."""
REPEATED = 1000
"""Most messages of a topic that are repeated in each file."""
SLOWEST, FASTEST = 1e-6, 1e6
"""Bounds of a topic's recording rate, in Hz."""
UNNAMED = "rosbag2_"
"""The beginning of a bag's name where none is given."""
SILENT = 2.0
"""Seconds after which missing topics are reported."""


@dataclass
class RecordOptions:
    """The options of `bag record`, under click's names."""

    folder: Path | None = None
    storage: str = "mcap"
    max_bag_size: int = 0
    max_bag_duration: float = 0.0
    max_cache_size: int | None = None
    compression: str = "zstd"
    no_discovery: bool = False
    start_paused: bool = False
    snapshot_mode: bool = False
    duration: float | None = None
    qos_path: Path | None = None
    custom_data: tuple[str, ...] = ()
    include_unpublished_topics: bool = False
    ignore_leaf_topics: bool = False
    topic_throttle_frequency: tuple[str, ...] = ()
    repeat_transient_local: tuple[str, ...] = ()
    repeat_all_transient_local: int = 0
    use_sim_time: bool = False
    disable_keyboard_controls: bool = False
    node_name: str = "rosbag2_recorder"


def run(choice: Choice, options: RecordOptions) -> int:
    """Record until stopped; return the exit code."""
    check_node_name(options.node_name)
    qos = {} if options.qos_path is None else read_overrides(options.qos_path)
    custom = dict(_pair(word) for word in options.custom_data)
    folder = options.folder or Path(time.strftime(f"{UNNAMED}%Y_%m_%d-%H_%M_%S"))
    rates = _rates(options.topic_throttle_frequency)
    repeats = Repeats(
        _by_topic("--repeat-transient-local", options.repeat_transient_local), options.repeat_all_transient_local
    )
    writer = BagWriter(
        folder,
        storage=options.storage,
        compression=options.compression,
        custom=custom,
        repeats=repeats,
        max_size=options.max_bag_size,
        max_seconds=options.max_bag_duration,
    )

    async def work(node: Node) -> int:
        return await _record(node, writer, choice, options, qos, rates)

    given = {"use_sim_time": True} if options.use_sim_time else {}
    return run_with_node(work, options.node_name, has_services=True, parameters=given)


def _pair(word: str) -> tuple[str, str]:
    key, sign, value = word.partition("=")
    if not (key and sign):
        raise UsageFault(f"--custom-data {word!r}: write KEY=VALUE")
    return key, value


def _by_topic(option: str, words: tuple[str, ...]) -> dict[str, int]:
    """Parse TOPIC=NUMBER, or TOPIC for 1, into numbers by full name."""
    found = {}
    for word in " ".join(words).split():
        name, _, number = word.partition("=")
        if not (number or "1").isdecimal() or not 0 < int(number or "1") <= REPEATED:
            raise UsageFault(f"{option} {word!r}: write TOPIC, or TOPIC=NUMBER with 1 to {REPEATED:,} messages")
        found[expand(name, "/", "cli")] = int(number or "1")
    return found


def _rates(words: tuple[str, ...]) -> dict[str, float]:
    """Parse TOPIC=HZ into rates by full name."""
    found = {}
    for word in " ".join(words).split():
        name, sign, number = word.partition("=")
        try:
            rate = float(number)
        except ValueError:
            rate = 0.0
        if not (name and sign and SLOWEST <= rate <= FASTEST):
            raise UsageFault(f"--topic-throttle-frequency {word!r}: write TOPIC=HZ, for example /camera/image_raw=2")
        found[expand(name, "/", "cli")] = rate
    return found


async def _record(
    node: Node,
    writer: BagWriter,
    choice: Choice,
    options: RecordOptions,
    qos: Mapping[str, Qos],
    rates: Mapping[str, float],
) -> int:
    recorder = Recorder(
        node,
        writer,
        choice,
        cache=options.max_cache_size or CACHE,
        discovery=not options.no_discovery,
        qos=qos,
        unpublished=options.include_unpublished_topics,
        leaves=not options.ignore_leaf_topics,
        rates=rates,
        snapshot=options.snapshot_mode,
        on_topic=lambda text: _report(node, text),
    )
    recorder.is_paused = options.start_paused
    _serve(node, recorder)
    _report(node, "Listening for topics...")
    code = exits.OK

    def key(pressed_key: str) -> None:
        if pressed_key == " ":
            recorder.is_paused = not recorder.is_paused
            _report(node, "Paused" if recorder.is_paused else "Resumed")
        elif pressed_key in "sS" and recorder.take_snapshot():
            _report(node, "Snapshot taken")

    began = time.monotonic()
    with contextlib.nullcontext(False) if options.disable_keyboard_controls else key_presses(key) as has_keys:
        if has_keys:
            keys = "SPACE pauses, S takes a snapshot" if options.snapshot_mode else "SPACE pauses"
            _report(node, f"Recording into {writer.folder}. {keys}, Ctrl-C ends it")
        else:
            _report(node, f"Recording into {writer.folder}")
        shown = asyncio.ensure_future(_show(recorder, began)) if sys.stderr.isatty() else None
        warned = asyncio.ensure_future(_warn_later(node, recorder, writer.folder))
        try:
            async with asyncio.timeout(options.duration):
                await recorder.run()
        except TimeoutError:
            code = exits.OK
        except asyncio.CancelledError:  # Ctrl-C
            code = exits.OK
        except BagError as error:
            output.error(str(error))
            code = exits.FAILED
        finally:
            warned.cancel()
            if shown is not None:
                shown.cancel()
                output.progress("")
    _sum_up(node, recorder, writer, time.monotonic() - began)
    return code if recorder.topics else exits.FAILED


def _sum_up(node: Node, recorder: Recorder, writer: BagWriter, seconds: float) -> None:
    whole = writer.contents
    written = (
        f"{whole.message_count:,} messages of {topics_of(recorder.topics)} in {seconds:.1f} s, {size(writer.size)}"
    )
    _report(node, f"Recording stopped: {written} in {writer.folder}")
    if recorder.dropped:
        output.talk(f"WARNING: {recorder.dropped:,} messages were dropped: they came faster than they could be written")
    if recorder.lost:
        output.talk(f"WARNING: {recorder.lost:,} messages never arrived, by the sequence numbers of their publishers")
    _warn_of_missing(node, recorder, writer.folder)
    if not recorder.topics:
        output.talk("no topic appeared to be recorded; `graphflow topic list` shows all topics")


async def _warn_later(node: Node, recorder: Recorder, folder: Path) -> None:
    await node.clock.sleep(SILENT)
    _warn_of_missing(node, recorder, folder)
    if not set(node.context.cache.nodes(hidden=False)) - {node.full_name}:
        output.talk(await node.offload(nothing_here, "no nodes"))


def _warn_of_missing(node: Node, recorder: Recorder, folder: Path) -> None:
    """Warn about topics that were named, to be recorded or with an option, but have not appeared.

    Args:
        folder: The bag, whose name may have been written as a topic.
    """
    for name in recorder.missing:
        service, cache = name.removesuffix(EVENTS), node.context.cache
        text = cache.unpublished(name) if service == name else cache.without_events(service)
        bag = _as_bag(name)
        if recorder.topics and folder.name.startswith(UNNAMED) and bag and "did you mean" not in text:
            text += f"; if {bag} is the name of the bag, write -o {bag}"
        output.talk(f"WARNING: {text}")
    for text in recorder.unused_options:
        output.talk(f"WARNING: {text}")


def _as_bag(name: str) -> str:
    """Return the bag that a topic's name may mean: a name alone, or a path whose folder exists; empty for others."""
    inner = name[1:]
    if "/" not in inner:
        return inner
    return next((path for path in (name, inner) if Path(path).parent.is_dir()), "")


async def _show(recorder: Recorder, began: float) -> None:
    """Show the state of the recording as a progress line."""
    last, at = 0, began
    while True:
        await asyncio.sleep(SHOWN_EVERY)
        now = time.monotonic()
        rate, last, at = (recorder.recorded - last) / (now - at), recorder.recorded, now
        lost = f", {recorder.dropped + recorder.lost:,} lost" if recorder.dropped + recorder.lost else ""
        state = "paused" if recorder.is_paused else f"{rate:,.0f} messages/s"
        output.progress(f"{now - began:,.0f} s  {topics_of(recorder.topics)}  {state}  {size(recorder.size)}{lost}")


def _serve(node: Node, recorder: Recorder) -> None:
    """Provide the services of ROS 2's recorder."""

    def pause(_: Pause.Request) -> Pause.Response:
        recorder.is_paused = True
        return Pause.Response()

    def resume(_: Resume.Request) -> Resume.Response:
        recorder.is_paused = False
        return Resume.Response()

    def split(_: SplitBagfile.Request) -> SplitBagfile.Response:
        recorder.split()
        return SplitBagfile.Response()

    node.create_service(Pause, "~/pause", pause)
    node.create_service(Resume, "~/resume", resume)
    node.create_service(IsPaused, "~/is_paused", lambda _: IsPaused.Response(paused=recorder.is_paused))
    node.create_service(SplitBagfile, "~/split_bagfile", split)
    node.create_service(Snapshot, "~/snapshot", lambda _: Snapshot.Response(success=recorder.take_snapshot()))


def _report(node: Node, text: str) -> None:
    """Print a line in the format of ROS 2's recorder."""
    output.progress("")
    output.talk(f"[INFO] [{node.clock.time_ns() / 1e9:.9f}] [{node.name}]: {text}")
