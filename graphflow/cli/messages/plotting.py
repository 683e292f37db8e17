"""The work of `topic plot` and `bag plot`: draw numbers of messages as curves."""

from __future__ import annotations

import asyncio
import os
import shutil
import sys
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from graphflow.bag import typed
from graphflow.bag.reader import Bag
from graphflow.cli import exits, output
from graphflow.cli.temporary_node import run_with_node
from graphflow.errors import CallError, UsageFault
from graphflow.introspect.drawing.curves import COLOURS, CURVES, Curve, chart
from graphflow.introspect.messages.fields import numbers
from graphflow.msgs import registry
from graphflow.names import did_you_mean, expand
from graphflow.qos import BEST_AVAILABLE
from graphflow.runtime.node import Node

if TYPE_CHECKING:
    from graphflow.msgs.base import Message

EVERY = 0.2
"""Seconds between two pictures on a terminal."""
HEIGHT = 24
"""Rows of a picture that is printed once."""
DOTS = 150
"""Dots per inch of a PNG file."""


@dataclass(frozen=True)
class PlotOptions:
    """The options of both verbs, under click's names."""

    seconds: float = 30.0
    """Seconds shown on a terminal."""
    duration: float | None = None
    svg: str | None = None
    png: str | None = None
    as_csv: bool = False

    def check(self) -> None:
        """Check early what would otherwise fail only at the end.

        Raises:
            UsageFault: Matplotlib is not installed, or a file's folder does not exist.
        """
        for file in filter(None, (self.svg, self.png)):
            if not Path(file).parent.is_dir():
                raise UsageFault(f"{file}: there is no folder {Path(file).parent}")
        if self.svg or self.png:
            try:
                import matplotlib  # noqa: F401
            except ImportError:
                from graphflow.introspect.installation import requirement

                raise UsageFault(f"--svg and --png need the extra `plot`: pip install {requirement('plot')}") from None

    @property
    def is_live(self) -> bool:
        """Whether the picture is updated on a terminal."""
        return not (self.svg or self.png or self.as_csv) and sys.stdout.isatty()


def parse_fields(words: Sequence[str], topics: Collection[str]) -> dict[str, list[str]]:
    """Parse words into topics and the fields of each; no fields stand for all numbers.

    Args:
        words: `/pose`, `/pose.x,theta`, `/pose/x` or `/pose/linear/x`, as rqt_plot and PlotJuggler write fields.
        topics: The existing topics.
    """
    found: dict[str, list[str]] = {}
    for word in words:
        name, fields = _split(word)
        full = expand(name, "/", "cli")
        listed = [field for field in fields.split(",") if field]
        if full not in topics and not listed:
            above = max((t for t in topics if full.startswith(f"{t}/")), key=len, default=full)
            listed = [full[len(above) + 1 :].replace("/", ".")] if above != full else []
            full = above
        found.setdefault(full, []).extend(listed)
    return found


def _split(word: str) -> tuple[str, str]:
    """Split a word at its first dot; without a dot, `ranges[0]` is split off at the last slash."""
    name, dot, fields = word.partition(".")
    if not dot and "[" in name:
        name, _, fields = name.rpartition("/")
    return name, fields


def curves_of(meant: Mapping[str, list[str]], types: Mapping[str, str]) -> dict[str, list[Curve]]:
    """Return the curves to draw, by topic.

    Raises:
        UsageFault: A topic has no such field, or no numbers.
    """
    found: dict[str, list[Curve]] = {}
    for topic, fields in meant.items():
        chosen = fields or numbers(types[topic])[:CURVES]
        if not chosen:
            raise UsageFault(f"{topic}: {types[topic]} has no field that is a number")
        head = f"{topic}." if len(meant) > 1 else ""
        found[topic] = [Curve(field, types[topic], f"{head}{field}") for field in chosen]
    return found


def plot_live(meant: Mapping[str, list[str]], types: Mapping[str, str], options: PlotOptions) -> int:
    """Draw topics as their messages arrive; return the exit code."""
    curves = curves_of(meant, types)
    return run_with_node(lambda node: _listen(node, curves, types, options))


def plot_bag(path: Path, words: Sequence[str], start: float, end: float | None, options: PlotOptions) -> int:
    """Draw topics of a bag over the seconds since its beginning; return the exit code."""
    bag = Bag(path)
    topics = bag.contents.topics
    meant = parse_fields(words, topics)
    for topic in meant:
        if topic not in topics:
            raise CallError(f"{path} has no topic {topic}{did_you_mean(topic, topics)}")
        typed.learn(topics[topic])
    curves = curves_of(meant, {topic: topics[topic].type for topic in meant})
    zero = bag.contents.start_ns
    start_ns = zero + int(start * 1e9)
    end_ns = None if end is None else zero + int(end * 1e9)
    for record in typed.read(path, meant, start_ns=start_ns, end_ns=end_ns):
        for curve in curves[record.topic]:
            curve.add((record.time_ns - zero) / 1e9, record.message)
    return _finished(curves, options)


async def _listen(node: Node, curves: Mapping[str, list[Curve]], types: Mapping[str, str], options: PlotOptions) -> int:
    zero = node.clock.monotonic_ns() / 1e9

    def listen(topic: str) -> None:
        def arrived(message: Message) -> None:
            at = node.clock.monotonic_ns() / 1e9 - zero
            for curve in curves[topic]:
                curve.add(at, message)

        node.create_subscription(registry.interface_class(types[topic]), topic, arrived, BEST_AVAILABLE)

    for topic in curves:
        listen(topic)
    if not options.is_live:
        until = f"for {options.duration:g} s" if options.duration else "until Ctrl-C"
        output.talk(f"listening to {', '.join(curves)} {until}")
    try:
        async with asyncio.timeout(options.duration):
            while True:
                await node.clock.sleep(EVERY)
                if options.is_live:
                    _show(curves, node.clock.monotonic_ns() / 1e9 - zero, options.seconds)
    except (TimeoutError, asyncio.CancelledError):  # --duration has passed, or Ctrl-C
        return exits.OK if options.is_live else _finished(curves, options)


def _show(curves: Mapping[str, list[Curve]], now: float, seconds: float) -> None:
    for curve in _all(curves):
        curve.forget(now - seconds)
    colours = () if "NO_COLOR" in os.environ else COLOURS
    columns, rows = shutil.get_terminal_size()
    picture = chart(_all(curves), (columns, rows - 1), span=(now - seconds, now), colours=colours)
    output.screen(picture or _nothing(curves))


def _finished(curves: Mapping[str, list[Curve]], options: PlotOptions) -> int:
    """Output the finished picture, or the numbers; return the exit code."""
    every = _all(curves)
    title = next(iter(curves)) if len(curves) == 1 else ""
    if all(curve.is_empty for curve in every):
        output.error(_nothing(curves))
        return exits.FAILED
    if options.as_csv:
        output.lines(_csv(every))
    for kind, file in (("svg", options.svg), ("png", options.png)):
        if file is not None:
            try:
                _draw(every, title, file, kind)
            except OSError as error:
                output.error(f"{file}: {error.strerror or error}")
                return exits.FAILED
            output.data(file)
    if not (options.as_csv or options.svg or options.png):
        output.lines(chart(every, (shutil.get_terminal_size().columns, HEIGHT)).splitlines())
    return exits.OK


def _nothing(curves: Mapping[str, list[Curve]]) -> str:
    """Explain why there is no picture."""
    came = {topic: len(some[0].values) for topic, some in curves.items() if some[0].values}
    if not came:
        return f"no message of {', '.join(curves)} has arrived"
    return "; ".join(
        f"{count} messages of {topic} arrived, but none had {' or '.join(curve.label for curve in curves[topic])}"
        for topic, count in came.items()
    )


def _csv(curves: Sequence[Curve]) -> Iterator[str]:
    yield "seconds,name,value"
    for curve in curves:
        for at, value in zip(curve.times, curve.values, strict=True):
            yield f"{at:.6f},{curve.label},{value!r}"


def _draw(curves: Sequence[Curve], title: str, file: str, kind: str) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 5), layout="constrained")
    axes = figure.add_subplot()
    for i, curve in enumerate(curves):
        axes.plot(curve.times, curve.values, label=curve.label, color=COLOURS[i % len(COLOURS)], linewidth=1.2)
    axes.set(xlabel="seconds", title=title)
    axes.grid(visible=True, alpha=0.3)
    axes.legend()
    figure.savefig(file, format=kind, dpi=DOTS)


def _all(curves: Mapping[str, list[Curve]]) -> list[Curve]:
    return [curve for some in curves.values() for curve in some]
