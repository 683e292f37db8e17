"""`graphflow topic list`, `info`, `type`, `find`, `echo`, `hz`, `bw`, `delay`, `plot` and `pub`."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from graphflow.cli import exits, output
from graphflow.cli.messages.echo_options import collect_options, echo_options
from graphflow.cli.messages.plot_options import plot_options
from graphflow.cli.messages.profiles import qos_options, take_qos
from graphflow.cli.messages.types import names_of_type
from graphflow.cli.verbs import GraphVerbs
from graphflow.cli.words import ValueCommand, message_values, messages_in, stdin_option
from graphflow.domain import domain_id
from graphflow.errors import CallError, EncodeError, GraphflowError, UsageFault
from graphflow.introspect.empty_hint import nothing_here
from graphflow.introspect.graph_view import View
from graphflow.machines.cache import GraphCache
from graphflow.machines.matching import Verdict, verdict
from graphflow.names import expand, is_hidden
from graphflow.qos import DEFAULT, INFINITE_NS
from graphflow.wire.gid import gid_text
from graphflow.wire.liveliness import Entity, Kind

if TYPE_CHECKING:
    from graphflow.cli.messages.publishing import Draft


@click.group(cls=GraphVerbs)
def topic() -> None:
    """List, describe, show and publish to topics."""


@topic.command(name="list")
@click.option("-t", "--show-types", is_flag=True, help="Also show types.")
@click.option("-c", "--count-topics", is_flag=True, help="Print only the count.")
@click.option("-v", "--verbose", is_flag=True, help="Also show the number of publishers and subscribers.")
@click.option("--include-hidden-topics", is_flag=True, help="Include hidden topics.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def list_(show_types: bool, count_topics: bool, verbose: bool, include_hidden_topics: bool, as_json: bool) -> None:
    """List the names of all topics."""
    with View(domain_id()) as view:
        cache = view.cache
    topics = cache.topics(hidden=include_hidden_topics)
    if as_json:
        output.as_json(topics)
    elif count_topics:
        output.data(str(len(topics)))
    elif verbose:
        for title, kind, word in (
            ("Published topics:", Kind.PUBLISHER, "publisher"),
            ("Subscribed topics:", Kind.SUBSCRIPTION, "subscriber"),
        ):
            output.data(title)
            for name, types in topics.items():
                count = len(cache.endpoints(kind, name))
                if count:
                    output.data(f" * {name} [{', '.join(types)}] {count} {word}{'s' if count > 1 else ''}")
            output.data("")
    else:
        output.lines(f"{name} [{', '.join(types)}]" if show_types else name for name, types in topics.items())
        if not topics:
            output.talk(nothing_here("no topics"))


@topic.command()
@click.argument("name", metavar="TOPIC")
@click.option("-v", "--verbose", is_flag=True, help="Show every endpoint: node, QoS, GID, type hash.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def info(name: str, verbose: bool, as_json: bool) -> int:
    """Show a topic's type, publishers and subscriptions."""
    full = expand(name, "/", "cli")
    with View(domain_id()) as view:
        cache = view.cache
        types = cache.topics(hidden=True).get(full)
        if types is None:
            near = cache.instead(full, cache.topics()) or view.nobody_here()
            raise CallError(f"Unknown topic '{full}'{near}")
    publishers, subscriptions = cache.endpoints(Kind.PUBLISHER, full), cache.endpoints(Kind.SUBSCRIPTION, full)
    if as_json:
        endpoints = {"publishers": publishers, "subscriptions": subscriptions}
        rows = {k: [_row(e, cache) for e in v] for k, v in endpoints.items()}
        output.as_json({"name": full, "types": types, **rows})
        return exits.OK
    output.data(f"Type: {types[0]}" if len(types) == 1 else f"Types: {', '.join(types)}")
    for title, endpoints_of_kind in (("Publisher count", publishers), ("Subscription count", subscriptions)):
        output.data(f"{chr(10) if verbose else ''}{title}: {len(endpoints_of_kind)}")
        if verbose:
            output.lines(f"\n{_describe_endpoint(e, cache)}" for e in endpoints_of_kind)
    return exits.OK


def _incompatibilities(e: Entity, cache: GraphCache) -> list[str]:
    """Describe why an endpoint does not connect to others on its topic, here or over DDS."""
    judged = [(other, verdict(e, other)) for other in cache.named(e.name)]
    return [
        f"INCOMPATIBLE with {other.node_name}: {', '.join(found.policies) or _difference(e, other)}{_kept(found)}"
        for other, found in judged
        if found is not None and found.complaint
    ]


def _kept(found: Verdict) -> str:
    """Return the way for a subscription to receive what was published before it opened, if it asks for that."""
    return "; give the publisher TRANSIENT_LOCAL, which keeps messages" if "durability" in found.policies else ""


def _difference(e: Entity, other: Entity) -> str:
    return f"type {other.type}" if e.type != other.type else f"a different definition of the type, {other.hash}"


def _row(e: Entity, cache: GraphCache) -> dict[str, object]:
    return {
        "node": e.node_name,
        "type": e.type,
        "hash": e.hash,
        "gid": gid_text(e.gid),
        "qos": {
            "reliability": e.qos.reliability.name,
            "durability": e.qos.durability.name,
            "history": e.qos.history.name,
            "depth": e.qos.depth,
        },
        "incompatible": _incompatibilities(e, cache),
    }


def _describe_endpoint(e: Entity, cache: GraphCache) -> str:
    def span(ns: int) -> str:
        return "Infinite" if ns == INFINITE_NS else f"{ns} nanoseconds"

    kind = "PUBLISHER" if e.kind is Kind.PUBLISHER else "SUBSCRIPTION"
    return "\n".join(
        [
            f"Node name: {e.node}",
            f"Node namespace: {e.namespace}",
            f"Topic type: {e.type}",
            f"Topic type hash: {e.hash}",
            f"Endpoint type: {kind}",
            f"GID: {gid_text(e.gid)}",
            "QoS profile:",
            f"  Reliability: {e.qos.reliability.name}",
            f"  History (Depth): {e.qos.history.name} ({e.qos.depth})",
            f"  Durability: {e.qos.durability.name}",
            f"  Lifespan: {span(e.qos.lifespan_ns)}",
            f"  Deadline: {span(e.qos.deadline_ns)}",
            f"  Liveliness: {e.qos.liveliness.name}",
            f"  Liveliness lease duration: {span(e.qos.lease_ns)}",
            *_incompatibilities(e, cache),
        ]
    )


@topic.command()
@click.argument("name", metavar="TOPIC")
@click.argument("type_name", metavar="[TYPE]", required=False)
@echo_options
def echo(name: str, type_name: str | None, **options: Any) -> int:
    """Show the messages of a topic as they arrive. Ctrl-C stops it."""
    from graphflow.cli.messages import echoing
    from graphflow.cli.messages.types import check_order, use_project

    use_project()
    check_order(name, type_name, "topic echo")
    whole, dot, field = name.partition(".")
    if dot:
        raise UsageFault(f"to show a field: graphflow topic echo {whole} --field {field}")
    full = expand(name, "/", "cli")
    return echoing.run(full, _echo_type(full, type_name), collect_options(options))


def _warn_of_profile(view: View, full: str) -> None:
    if kept_back := view.kept_back(full, Kind.PUBLISHER):
        output.talk(f"WARNING: {kept_back}")


_A_FIELD = re.compile(r"[a-z_][a-z0-9_]*(\.\w+)*")
"""The path of a field, which cannot be a type."""


def _echo_type(full: str, given: str | None) -> str:
    """Return the type to subscribe with: the graph's, or else the given one."""
    from graphflow.cli.messages.types import agree, check_kind, type_of_word
    from graphflow.errors import SupervisorError
    from graphflow.introspect.messages.definitions import learn

    try:
        with View(domain_id()) as view:
            cache, topics = view.cache, view.cache.topics(hidden=True)
            types = topics.get(full, [])
            if len(types) == 1:
                learn(view, full, types[0])
            _warn_of_profile(view, full)
            if subscribed := view.subscribed_only(full):
                output.talk(f"WARNING: topic [{full}] does not appear to be published yet{subscribed}")
            alone = "" if types else view.nobody_here()
    except SupervisorError:
        if given is None:
            raise
        cache, topics, types, alone = GraphCache(), {}, [], ""
    if given and types and f"/{given}" not in topics and _A_FIELD.fullmatch(given):
        raise UsageFault(f"to show a field: graphflow topic echo {full} --field {given}")
    wanted = type_of_word(given, full, types, topics) if given else None
    if wanted is not None:
        check_kind(wanted, "msg")
    if types:
        if len(types) > 1 and wanted is None:
            raise UsageFault(f"{full} has several types: {', '.join(types)}; name one after the topic")
        return types[0] if wanted is None else agree(wanted, types, full)
    if wanted is None:
        raise CallError(f"topic {full} does not appear to be published{alone}") if alone else _absent(full, cache)
    near = cache.instead(full, (), topics) or alone
    output.talk(f"WARNING: topic [{full}] does not appear to be published yet{near}")
    return wanted


def _absent(full: str, cache: GraphCache) -> GraphflowError:
    """Return the error for a topic that does not exist, whose type was not given, either."""
    visible = list(cache.topics())
    if topic := next((topic for topic in visible if full.startswith(f"{topic}/")), None):
        field = full.removeprefix(f"{topic}/").replace("/", ".")
        return UsageFault(f"there is no topic {full}; to show a field: graphflow topic echo {topic} --field {field}")
    near = cache.instead(full, visible)
    if near.startswith("; it is"):
        return CallError(f"Unknown topic '{full}'{near}")
    to = " To" if near.endswith("?") else "; to"
    return CallError(
        f"topic {full} does not appear to be published yet{near}{to} wait for it, give its type: "
        f"graphflow topic echo {full} TYPE"
    )


@topic.command("type")
@click.argument("name", metavar="TOPIC")
def type_(name: str) -> int:
    """Print a topic's type."""
    full = expand(name, "/", "cli")
    with View(domain_id()) as view:
        cache = view.cache
        topics = cache.topics(hidden=True)
        near = "" if full in topics else cache.instead(full, topics) or view.nobody_here()
    output.lines(topics.get(full, []))
    if full not in topics:
        output.error(f"Unknown topic '{full}'{near}")
    return exits.OK if full in topics else exits.FAILED


@topic.command()
@click.argument("type_name", metavar="TYPE")
@click.option("-c", "--count-topics", is_flag=True, help="Print only the count.")
@click.option("--include-hidden-topics", is_flag=True, help="Include hidden topics.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def find(type_name: str, count_topics: bool, include_hidden_topics: bool, as_json: bool) -> None:
    """List the topics of a type."""
    with View(domain_id()) as view:
        topics = view.cache.topics(hidden=include_hidden_topics)
    output.listing(names_of_type(topics, type_name, only_count=count_topics), json=as_json)


@topic.command()
@click.argument("names", metavar="TOPIC...", nargs=-1, required=True)
@click.option("-w", "--window", type=click.IntRange(1), default=10000, show_default=True, help="Messages to average.")
@click.option("--filter", "expression", default="", help="Count only messages m for which this holds: 'm.data > 3'.")
@click.option("--wall-time", is_flag=True, help="Accepted for ROS 2; the wall clock is always used.")
@click.option("--json", "as_json", is_flag=True, help="Print a line of JSON every second for each topic.")
def hz(names: tuple[str, ...], window: int, expression: str, wall_time: bool, as_json: bool) -> int:  # noqa: ARG001 - ROS 2's word
    """Show how often messages arrive. Ctrl-C stops it."""
    from graphflow.cli.messages import measuring

    topics = list(dict.fromkeys(expand(name, "/", "cli") for name in names))
    _learn(*topics if expression else ())
    return measuring.hz(topics, window, expression, as_json=as_json)


@topic.command()
@click.argument("names", metavar="TOPIC...", nargs=-1, required=True)
@click.option("-w", "--window", type=click.IntRange(1), default=100, show_default=True, help="Messages to average.")
@click.option("--json", "as_json", is_flag=True, help="Print a line of JSON every second for each topic.")
def bw(names: tuple[str, ...], window: int, as_json: bool) -> int:
    """Show how many bytes arrive. Ctrl-C stops it."""
    from graphflow.cli.messages import measuring

    return measuring.bw(list(dict.fromkeys(expand(name, "/", "cli") for name in names)), window, as_json=as_json)


@topic.command()
@click.argument("name", metavar="TOPIC")
@click.option("-w", "--window", type=click.IntRange(1), default=10000, show_default=True, help="Messages to average.")
@click.option("--json", "as_json", is_flag=True, help="Print a line of JSON every second.")
def delay(name: str, window: int, as_json: bool) -> int:
    """Show how old messages are on arrival. Their headers' stamps give the age. Ctrl-C stops it."""
    from graphflow.cli.messages import measuring

    full = expand(name, "/", "cli")
    _learn(full)
    return measuring.delay(full, window, as_json=as_json)


@topic.command(short_help="Draw numbers of messages as curves.")
@click.argument("names", metavar="TOPIC[.FIELD,...]...", nargs=-1, required=True)
@click.option("-s", "--seconds", type=click.FloatRange(1), default=30.0, show_default=True, help="Seconds to show.")
@click.option("--duration", type=click.FloatRange(0, min_open=True), help="Seconds to listen. [until Ctrl-C]")
@plot_options
def plot(names: tuple[str, ...], seconds: float, duration: float | None, **options: Any) -> int:
    """Draw numbers of messages as curves, in the terminal or into a file. Ctrl-C stops it.

    \b
    graphflow topic plot /turtle1/pose.x,y
    graphflow topic plot /turtle1/pose/theta --duration 10 --png theta.png
    """  # noqa: D301 - click wants the character
    from graphflow.cli.messages import plotting

    chosen = plotting.PlotOptions(seconds=seconds, duration=duration, **options)
    chosen.check()
    with View(domain_id()) as view:
        cache, topics = view.cache, view.cache.topics(hidden=True)
    meant = plotting.parse_fields(names, topics)
    for full in meant:
        if full not in topics:
            near = cache.instead(full, [t for t in topics if not is_hidden(t)])
            raise CallError(f"topic {full} does not appear to be published yet{near}")
    _learn(*meant)
    return plotting.plot_live(meant, {full: topics[full][0] for full in meant}, chosen)


def _learn(*topics: str) -> None:
    """Fetch the types of topics from the graph, as far as the topics exist."""
    from graphflow.cli.messages.types import use_project
    from graphflow.errors import SupervisorError
    from graphflow.introspect.messages.definitions import learn

    use_project()
    try:
        with View(domain_id()) as view:
            for topic_name in topics:
                for type_name in view.cache.topics(hidden=True).get(topic_name, [])[:1]:
                    learn(view, topic_name, type_name)
                _warn_of_profile(view, topic_name)
    except SupervisorError as error:  # no graph is running yet; the verb waits for one
        if error.exit_code != exits.NOT_RUNNING:
            raise


@topic.command(cls=ValueCommand, short_help="Publish messages given in YAML.")
@click.argument("name", metavar="TOPIC")
@click.argument("type_name", metavar="TYPE", default="")
@click.argument("values", nargs=-1)
@click.option(
    "-r", "--rate", type=click.FloatRange(0, min_open=True), default=1.0, show_default=True, help="Rate in Hz."
)
@click.option("-1", "--once", is_flag=True, help="Publish one message and exit.")
@click.option("-t", "--times", type=click.IntRange(1), help="Publish this many messages and exit.")
@click.option("-p", "--print", "print_every", type=click.IntRange(0), default=1, help="Print only every N-th message.")
@click.option(
    "-w", "--wait-matching-subscriptions", type=click.IntRange(0), help="Wait for this many first. [1 with -1 or -t]"
)
@click.option(
    "--max-wait-time-secs", type=click.FloatRange(0, min_open=True), help="Longest wait for them, in seconds."
)
@click.option("--keep-alive", type=click.FloatRange(0), default=0.1, help="Seconds to stay after the last message.")
@click.option("-n", "--node-name", help="Name of the publishing node.")
@stdin_option
@click.option("--yaml-file", type=click.Path(path_type=Path), help="Publish each message in a file once.")
@qos_options
def pub(name: str, type_name: str, values: tuple[str, ...], **options: Any) -> int:
    """Publish messages. VALUES are the fields in YAML, such as "{data: hello}"; quotes are optional.

    `header: auto` and `stamp: now` stand for the time of publication. A --yaml-file has messages as `topic echo` prints
    them, separated by `---`; each is published once.
    """
    from graphflow.cli.messages import publishing
    from graphflow.cli.messages.types import agree, check_kind, check_order, type_of_word, use_project
    from graphflow.errors import SupervisorError
    from graphflow.introspect.messages.definitions import learn

    use_project()
    if options["once"] and name.isdecimal():
        raise UsageFault("--once takes no number; to publish several messages: --times N")
    check_order(name, type_name, "topic pub")
    full = expand(name, "/", "cli")
    try:
        with View(domain_id()) as view:
            known = view.cache.topics(hidden=True).get(full, [])
            if len(known) == 1:
                learn(view, full, known[0])
    except SupervisorError:  # no graph is running yet; subscriptions may appear later
        known = []
    if not type_name or type_name.startswith("{"):
        has, missing = (f"; it carries {known[0]}", known[0]) if known else ("", "TYPE")
        raise UsageFault(f"the topic's type comes before the values: graphflow topic pub {full} {missing} ...{has}")
    wanted = type_of_word(type_name, full, known)
    if known:
        wanted = agree(wanted, known, full)
    check_kind(wanted, "msg")
    if options["once"] and options["times"]:
        raise UsageFault("--once publishes one message, --times N that many: leave one of them out")
    file: Path | None = options.pop("yaml_file")
    from_stdin = options.pop("from_stdin")
    if file is not None and (values or from_stdin):
        raise UsageFault(f"--yaml-file reads the messages from {file}; leave out {values[0] if values else '--stdin'}")
    given = [("", message_values(values, from_stdin=from_stdin))] if file is None else messages_in(file)
    drafts = [_draft(wanted, data, place) for place, data in given]
    options["qos"] = take_qos(options, DEFAULT)
    return publishing.run(full, drafts, publishing.PubOptions(**options, is_series=file is not None))


def _draft(type_name: str, data: object, place: str) -> Draft:
    """Convert plain values to a message.

    Args:
        place: File and line of the values, for errors; empty for the command line.

    Raises:
        UsageFault: The values do not fit.
    """
    from graphflow.cli.messages.publishing import Draft
    from graphflow.cli.messages.stamps import split_stamps
    from graphflow.msgs import registry
    from graphflow.msgs.values import from_plain

    values, stamps = split_stamps(type_name, data)
    try:
        return Draft(from_plain(registry.interface_class(type_name), values), stamps)
    except EncodeError as error:
        raise UsageFault(f"{place}: {error}" if place else str(error)) from None
