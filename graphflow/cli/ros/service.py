"""`graphflow service list`, `type`, `find`, `info`, `call` and `echo`."""

from __future__ import annotations

import shlex
import time
from collections.abc import Sequence
from contextlib import suppress
from typing import Any

import click

from graphflow.cli import exits, output
from graphflow.cli.messages.echo_options import collect_options, echo_options
from graphflow.cli.messages.types import agree, check_kind, check_order, names_of_type, type_of_word, use_project
from graphflow.cli.verbs import GraphVerbs
from graphflow.cli.words import ValueCommand, message_values, stdin_option
from graphflow.domain import domain_id
from graphflow.errors import GraphflowError, ServiceUnavailable, UsageFault
from graphflow.introspect import server_logs
from graphflow.introspect.graph_view import View
from graphflow.machines.matching import shared
from graphflow.names import expand
from graphflow.transport.client import Hearing
from graphflow.wire.liveliness import Kind


@click.group(cls=GraphVerbs)
def service() -> None:
    """List and call services."""


@service.command(name="list")
@click.option("-t", "--show-types", is_flag=True, help="Also show types.")
@click.option("-c", "--count-services", is_flag=True, help="Print only the count.")
@click.option("--include-hidden-services", is_flag=True, help="Include hidden services.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def list_(show_types: bool, count_services: bool, include_hidden_services: bool, as_json: bool) -> None:
    """List the names of all services."""
    with View(domain_id()) as view:
        services = view.cache.services(hidden=include_hidden_services)
    if as_json:
        output.as_json(services)
    elif count_services:
        output.data(str(len(services)))
    else:
        output.lines(f"{name} [{', '.join(types)}]" if show_types else name for name, types in services.items())


@service.command("type")
@click.argument("name", metavar="SERVICE")
def type_(name: str) -> None:
    """Print a service's type."""
    with View(domain_id()) as view:
        output.lines(view.service_types(expand(name, "/", "cli")))


@service.command()
@click.argument("type_name", metavar="TYPE")
@click.option("-c", "--count-services", is_flag=True, help="Print only the count.")
@click.option("--include-hidden-services", is_flag=True, help="Include hidden services.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def find(type_name: str, count_services: bool, include_hidden_services: bool, as_json: bool) -> None:
    """List the services of a type."""
    with View(domain_id()) as view:
        services = view.cache.services(hidden=include_hidden_services)
    output.listing(names_of_type(services, type_name, only_count=count_services), json=as_json)


@service.command()
@click.argument("name", metavar="SERVICE")
@click.option("-v", "--verbose", is_flag=True, help="Also name the nodes that offer and call it.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def info(name: str, verbose: bool, as_json: bool) -> None:
    """Show a service's type, and how many nodes offer and call it."""
    full = expand(name, "/", "cli")
    with View(domain_id()) as view:
        types = view.service_types(full)
        _warn_if_shared(view, full)
        clients, servers = (view.cache.endpoints(kind, full) for kind in (Kind.CLIENT, Kind.SERVICE))
    if as_json:
        nodes = {"clients": [e.node_name for e in clients], "servers": [e.node_name for e in servers]}
        output.as_json({"name": full, "type": ", ".join(types), **nodes})
        return
    output.data(f"Type: {', '.join(types)}")
    for title, ends in (("Clients count", clients), ("Services count", servers)):
        output.data(f"{title}: {len(ends)}")
        output.lines(f"    {end.node_name}" for end in ends if verbose)


def _warn_if_shared(view: View, name: str) -> None:
    """Warn if several nodes offer a service."""
    for text in shared(view.cache.named(name)):
        output.talk(f"WARNING: {text}")


@service.command()
@click.argument("name", metavar="SERVICE")
@echo_options
def echo(name: str, **options: Any) -> int:
    """Show the calls of a service with introspection. Ctrl-C stops it."""
    from graphflow.cli.messages import echoing
    from graphflow.introspect.messages.definitions import learn

    full = expand(name, "/", "cli")
    use_project()
    with View(domain_id()) as view:
        type_name, *others = view.service_types(full)
        if others:
            raise UsageFault(f"{full} has several types: {', '.join([type_name, *others])}; its nodes disagree")
        learn(view, full, type_name, (Kind.SERVICE,))
        if not view.cache.endpoints(Kind.PUBLISHER, f"{full}/_service_event"):
            output.talk(f"WARNING: {view.cache.without_events(full)}")
    return echoing.run(f"{full}/_service_event", f"{type_name}_Event", collect_options(options))


@service.command(cls=ValueCommand, short_help="Call a service with a request in YAML.")
@click.argument("name", metavar="SERVICE")
@click.argument("type_name", metavar="TYPE", required=False)
@click.argument("values", nargs=-1)
@click.option("-r", "--rate", type=click.FloatRange(0, min_open=True), help="Call repeatedly at this rate, in Hz.")
@click.option(
    "--timeout", type=click.FloatRange(0, min_open=True), default=10.0, show_default=True, help="Seconds to wait."
)
@stdin_option
@click.option("--json", "as_json", is_flag=True, help="Print the response as JSON.")
def call(
    name: str,
    type_name: str | None,
    values: tuple[str, ...],
    rate: float | None,
    timeout: float,
    from_stdin: bool,
    as_json: bool,
) -> int:
    """Call a service: VALUES are the request in YAML, such as "{a: 2, b: 5}"."""
    from graphflow.introspect.messages.definitions import learn
    from graphflow.introspect.messages.echo import plain
    from graphflow.msgs import registry
    from graphflow.msgs.values import from_plain

    use_project()
    check_order(name, type_name, "service call")
    full = expand(name, "/", "cli")
    if type_name is None:
        with View(domain_id()) as view:
            types = view.service_types(full)
        all_types, given = " and ".join(types), types[0] if len(types) == 1 else "TYPE"
        raise UsageFault(f"TYPE is missing; {full} is of type {all_types}: graphflow service call {full} {given}")
    with View(domain_id()) as view:
        known = view.cache.services(hidden=True).get(full, [])
        if known:
            learn(view, full, type_name if type_name in known or len(known) > 1 else known[0], (Kind.SERVICE,))
    wanted = type_of_word(type_name, full, known, command="service call", rest=_meant(known, (type_name, *values)))
    check_kind(wanted, "srv")
    values_read = message_values(values, from_stdin=from_stdin)
    with View(domain_id()) as view:
        if full not in view.cache.services(hidden=True):
            output.talk("waiting for service to become available...")
            try:
                view.wait_for_service(full, min(timeout, 2.0), wanted)
            except ServiceUnavailable as error:
                from graphflow.cli.ros.supervised import with_ended  # most calls find their server

                output.error(with_ended(error, view.cache.nodes()))
                return exits.TIMEOUT
        actual = agree(wanted, view.service_types(full), full)
        _warn_if_shared(view, full)
        request = from_plain(registry.interface_class(registry.service_schema(actual).request.name), values_read)
        servers = {server.node_name for server in view.cache.endpoints(Kind.SERVICE, full)}
        with view.hear(server_logs.TOPIC, server_logs.TYPE, server_logs.BOUND) as logs:
            while True:
                started = time.monotonic()
                if not as_json:
                    output.data(f"requester: making request: {request!r}\n")
                response = view.call(full, actual, request, timeout)
                if as_json:
                    output.as_json(plain(response))
                else:
                    output.data(f"response:\n{response!r}\n")
                _tell_logs(logs, servers, is_empty=response == type(response)())
                if rate is None:
                    return exits.OK
                time.sleep(max(0.0, 1 / rate - (time.monotonic() - started)))


def _tell_logs(logs: Hearing, servers: set[str], *, is_empty: bool) -> None:
    """Show the warnings and errors that the servers have logged; for an empty response, they are the only reason."""
    found = server_logs.lines(server_logs.read(logs.take()), servers)
    if not found and is_empty:
        time.sleep(server_logs.PATIENCE)
        found = server_logs.lines(server_logs.read(logs.take()), servers)
    for text in found:
        output.talk(text)


def _meant(types: list[str], words: Sequence[str]) -> str:
    """Return the request that words in the place of the type were meant as; empty if unclear."""
    from graphflow.msgs import registry
    from graphflow.msgs.instead import named

    if len(types) != 1:
        return ""
    with suppress(GraphflowError):
        request = registry.interface_class(registry.service_schema(types[0]).request.name)
        if words[0].rpartition("/")[2] == types[0].rpartition("/")[2]:  # the type, written in short
            words = words[1:]
        if not words:
            return ""
        values = message_values(words)
        text = " ".join(words) if isinstance(values, dict) else named(request, values)
        return "" if text is None else shlex.quote(text)
    return ""
