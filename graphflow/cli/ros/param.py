"""`graphflow param list`, `get`, `set`, `delete`, `describe`, `dump` and `load`."""

from __future__ import annotations

import re
import shlex
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import click

from graphflow.cli import exits, output
from graphflow.cli.verbs import GraphVerbs, Verb
from graphflow.cli.words import ValueCommand, pattern_option
from graphflow.domain import domain_id
from graphflow.errors import CallError, UsageFault
from graphflow.introspect import server_logs
from graphflow.introspect.empty_hint import nothing_here
from graphflow.introspect.graph_view import View
from graphflow.introspect.parameters import RemoteParameters, as_declared, read_value
from graphflow.names import did_you_mean, is_hidden
from graphflow.wire.liveliness import Kind

if TYPE_CHECKING:
    from graphflow.graph.plan import Setting
    from graphflow.msgs.rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, ParameterValue


@click.group(cls=GraphVerbs)
def param() -> None:
    """List, get, set, describe, dump and load parameters."""


SUGGESTED = 2
"""Most nodes for which a whole command is suggested if the node is missing."""
_timeout = click.option("--timeout", type=click.FloatRange(0, min_open=True), default=2.0, help="Seconds to wait.")
_hidden = click.option(
    "--include-hidden-nodes",
    is_flag=True,
    expose_value=False,
    help="Accepted for ROS 2; hidden nodes are always found by name.",
)


@param.command(name="list")
@click.argument("name", metavar="[NODE]", required=False)
@click.option("--param-type", is_flag=True, help="Also show types.")
@click.option(
    "--filter", "pattern", default="", callback=pattern_option, help="List only parameters that match this pattern."
)
@click.option("--param-prefixes", multiple=True, help="List only parameters below these prefixes.")
@click.option("--include-hidden-nodes", is_flag=True, help="Include parameters of hidden nodes.")
@_timeout
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def list_(
    name: str | None,
    param_type: bool,
    pattern: str,
    param_prefixes: tuple[str, ...],
    include_hidden_nodes: bool,
    timeout: float,
    as_json: bool,
) -> None:
    """List the parameters of one node or of all."""
    found: dict[str, dict[str, str]] = {}
    with View(domain_id()) as view:
        servers = {e.node_name for e in view.cache.endpoints(Kind.SERVICE) if e.name.endswith("/list_parameters")}
        nodes = [view.node(name)] if name else sorted(n for n in servers if include_hidden_nodes or not is_hidden(n))
        for node in nodes:
            try:
                remote = RemoteParameters(view, node, timeout)
                below = tuple(f"{prefix}." for prefix in param_prefixes)
                names = [n for n in remote.names() if re.search(pattern, n)]
                names = [n for n in names if not below or n.startswith(below) or n in param_prefixes]
                described = remote.describe(names) if param_type or as_json else {}
            except CallError as error:
                if name:
                    raise
                output.talk(f"{node}: {error}")
                continue
            found[node] = {n: _type_name(described[n].type) if n in described else "" for n in names}
    if as_json:
        output.as_json(found)
        return
    if not nodes:
        output.talk(nothing_here("no nodes"))
    elif (pattern or param_prefixes) and not any(found.values()):
        output.talk("no parameter matches; without --filter and --param-prefixes, all are listed")
    for node, names_and_types in found.items():
        if not name:
            output.data(f"{node}:")
        output.lines(f"  {n}{f' (type: {t})' if t else ''}" for n, t in names_and_types.items())


def _lacking(view: View, timeout: float, verb: str, *words: str) -> UsageFault:
    """Return the error for a command without a node or without the words after it.

    Args:
        words: The words that were given.

    Raises:
        CallError: The first word begins with a slash, but there is no such node.
    """
    first, *rest = (word for word in words if word)
    form = f"param {verb} NODE PARAMETER{' VALUE' if verb == 'set' else ''}"
    if _is_node(view, first):
        if verb == "set" and rest and (given := _ASSIGNED.fullmatch(rest[0])):
            rest = [given["name"], shlex.quote(given["value"])]
            return UsageFault(f"write {form}: graphflow param set {' '.join([first, *rest])}")
        lacking = ["PARAMETER"] * (not rest) + ["VALUE"] * (verb == "set")
        return UsageFault(f"write {form}: graphflow param {verb} {' '.join([first, *rest, *lacking])}")
    known = _names_by_node(view, timeout)
    bare = first.lstrip("/")  # parameters of ROS 1 begin with a slash
    having = [node for node, names in known.items() if bare in names]
    node, name = max((first.rpartition(sign)[::2] for sign in "./"), key=lambda pair: len(pair[0]))
    if not having and node and _is_node(view, node):
        value = rest or ["VALUE"] * (verb == "set")
        return UsageFault(f"write {form}: graphflow param {verb} {' '.join([node, name, *value])}")
    if not having and first.startswith("/"):
        view.node(first)
    if not having:
        near = did_you_mean(first, (), hidden={name for names in known.values() for name in names})
        return UsageFault(f"write {form}: there is no node {first!r}, nor a parameter of that name{near}")
    if len(having) > SUGGESTED:
        return UsageFault(f"write {form}; {bare!r} is a parameter of {', '.join(having)}")
    after = [bare, *(rest or ["VALUE"] * (verb == "set"))]
    ways = [f"graphflow param {verb} {' '.join([node, *after])}" for node in having]
    return UsageFault(f"write {form}: {' or '.join(ways)}")


_ASSIGNED = re.compile(r"\{?\s*(?P<name>[\w./]+)\s*(:=|=|:\s)\s*(?P<value>[^{}]*[^{}\s])\s*\}?")
"""A parameter and its value in one word, as in files and in other commands."""


def _is_node(view: View, name: str) -> bool:
    try:
        view.node(name)
    except CallError:
        return False
    return True


def _names_by_node(view: View, timeout: float) -> dict[str, list[str]]:
    """Return the names of parameters, by node, of all nodes that answer."""
    found = {}
    for node in sorted(e.node_name for e in view.cache.endpoints(Kind.SERVICE) if e.name.endswith("/list_parameters")):
        with suppress(CallError):
            found[node] = RemoteParameters(view, node, timeout).names()
    return found


def _type_name(type_: int) -> str:
    from graphflow.interface import TYPE_NAMES

    return TYPE_NAMES[type_]


@param.command()
@click.argument("name", metavar="NODE")
@click.argument("parameter", default="", metavar="PARAMETER")
@click.option("--hide-type", is_flag=True, help="Print only the value.")
@_hidden
@_timeout
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def get(name: str, parameter: str, hide_type: bool, timeout: float, as_json: bool) -> None:
    """Show the value of a parameter."""
    from graphflow.runtime.parameters.values import from_message, type_word

    with View(domain_id()) as view:
        if not parameter:
            raise _lacking(view, timeout, "get", name)
        remote = RemoteParameters(view, view.node(name), timeout)
        message = remote.get([parameter])[0]
        if message.type == 0:
            remote.known(parameter)  # raises unless the parameter exists without a value
            output.as_json(None) if as_json else output.data("Parameter not set.")
            return
    value = from_message(message)
    plain = list(value) if isinstance(value, bytes) else value
    if as_json:
        output.as_json(plain)
    else:
        output.data(f"{plain}" if hide_type else f"{type_word(message.type)}: {plain}")


@param.command(name="set", cls=ValueCommand)
@click.argument("name", metavar="NODE")
@click.argument("parameter", default="", metavar="PARAMETER")
@click.argument("value", nargs=-1, metavar="VALUE...")
@_hidden
@_timeout
def set_(name: str, parameter: str, value: tuple[str, ...], timeout: float) -> int:
    """Set a parameter. VALUE is YAML, converted to the parameter's type."""
    with View(domain_id()) as view:
        if not value:
            raise _lacking(view, timeout, "set", name, parameter)
        node = view.node(name)
        remote = RemoteParameters(view, node, timeout)
        declared = remote.known(parameter)
        read = read_value(" ".join(value), 0 if declared.dynamic_typing else declared.type)
        with view.hear(server_logs.TOPIC, server_logs.TYPE, server_logs.BOUND) as logs:
            result = remote.set({parameter: _message(read, declared)})[0]
            time.sleep(server_logs.OVERTAKING)
            logged = server_logs.lines(server_logs.read(logs.take()), {node}, result.reason)
    if result.successful:
        output.data("Set parameter successful" + (f": {result.reason}" if result.reason else ""))
        for text in logged:  # such as that the node reads the parameter only at its start
            output.talk(text)
        return exits.OK
    is_slip = result.reason.startswith("Wrong parameter type") and isinstance(read, float)  # ROS's words, without a way
    way = "; write an integer, or have the node declare it with a double, such as 1.0" if is_slip else ""
    output.talk(f"Setting parameter failed: {result.reason}{way}")
    return exits.FAILED


@param.command()
@click.argument("name", metavar="NODE")
@click.argument("parameter", default="", metavar="PARAMETER")
@_hidden
@_timeout
def delete(name: str, parameter: str, timeout: float) -> int:
    """Delete a parameter that was declared with dynamic typing."""
    from graphflow.msgs.rcl_interfaces.msg import ParameterValue

    with View(domain_id()) as view:
        if not parameter:
            raise _lacking(view, timeout, "delete", name)
        remote = RemoteParameters(view, view.node(name), timeout)
        remote.known(parameter)
        result = remote.set({parameter: ParameterValue()})[0]
    if result.successful:
        output.data("Deleted parameter successfully")
        return exits.OK
    output.talk(f"Deleting parameter failed: {result.reason}")
    return exits.FAILED


@param.command()
@click.argument("name", metavar="NODE")
@click.argument("parameters", nargs=-1, metavar="[PARAMETER]...")
@_hidden
@_timeout
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def describe(name: str, parameters: tuple[str, ...], timeout: float, as_json: bool) -> int:
    """Show the type, description and limits of parameters. Without PARAMETER, all are shown."""
    from graphflow.introspect.messages.echo import plain

    with View(domain_id()) as view:
        if not parameters and not _is_node(view, name):
            raise _lacking(view, timeout, "describe", name)
        remote = RemoteParameters(view, view.node(name), timeout)
        wanted = list(parameters) or remote.names()
        found = remote.describe(wanted)
        missing = [str(remote.unknown(n)) for n in wanted if n not in found]
    if as_json:
        output.as_json([plain(found[n]) for n in wanted if n in found])
    else:
        output.lines(_describe(found[n]) for n in wanted if n in found)
    for text in missing:
        output.error(text)
    return exits.FAILED if missing else exits.OK


def _describe(d: ParameterDescriptor) -> str:
    from graphflow.interface import TYPE_NAMES

    lines = [f"Parameter name: {d.name}", f"  Type: {TYPE_NAMES[d.type]}"]
    lines += [f"  Description: {d.description}"] if d.description else []
    lines.append("  Constraints:")
    lines += ["    Read only: true"] if d.read_only else []
    lines += ["    Dynamic typing: true"] if d.dynamic_typing else []
    ranges: list[FloatingPointRange | IntegerRange] = [*d.integer_range, *d.floating_point_range]
    for limits in ranges:
        lines += [f"    Min value: {limits.from_value}", f"    Max value: {limits.to_value}"]
        lines += [f"    Step: {limits.step}"] if limits.step else []
    lines += [f"    Additional constraints: {d.additional_constraints}"] if d.additional_constraints else []
    return "\n".join(lines[:-1] if lines[-1] == "  Constraints:" else lines)


@param.command()
@click.argument("name", metavar="NODE")
@_hidden
@_timeout
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.argument("file", default="", metavar="")
def dump(name: str, timeout: float, as_json: bool, file: str) -> None:
    """Print the parameters of a node as a parameter file. `param load`, `--params-file` and ROS 2 read it."""
    from graphflow.graph.params_file import write
    from graphflow.runtime.parameters.values import from_message

    if file:
        raise UsageFault(f"dump prints; to write a file: graphflow param dump {name} > {file}")

    with View(domain_id()) as view:
        node = view.node(name)
        remote = RemoteParameters(view, node, timeout)
        names = remote.names()
        values = dict(zip(names, map(from_message, remote.get(names)), strict=True))
    set_ones = {n: v for n, v in values.items() if v is not None}
    if as_json:
        output.as_json({"node": node, "parameters": set_ones})
    else:
        output.data(write(node, set_ones).rstrip())


class _Load(Verb):
    """A verb of a node and a file, which corrects their order."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        words = [word for word in args if not word.startswith("-")]
        files = [word for word in words if word.endswith((".yaml", ".yml")) or Path(word).is_file()]
        if not ctx.resilient_parsing and files and words[0] == files[0]:
            others = [word for word in words if word not in files]
            if len(words) <= 2 and "--help" not in args:
                ctx.fail(f"the node comes first: graphflow param load {others[0] if others else 'NODE'} {files[0]}")
        return super().parse_args(ctx, args)


@param.command(cls=_Load)
@click.argument("name", metavar="NODE")
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--no-use-wildcard", is_flag=True, help="Use only the sections that name the node.")
@_hidden
@_timeout
def load(name: str, file: Path, no_use_wildcard: bool, timeout: float) -> int:
    """Set the parameters of a node to those in a file."""
    from graphflow.graph import params_file

    sections = params_file.read(file, str(file))
    with View(domain_id()) as view:
        node = view.node(name)
        fitting = [s for s in sections if s.fits(node) and (s.is_exact or not no_use_wildcard)]
        if not fitting:
            raise UsageFault(f"{file} has nothing for {node}{params_file.hint_for(sections, node)}")
        failed = _load(RemoteParameters(view, node, timeout), params_file.params_for(fitting, node))
    return exits.FAILED if failed else exits.OK


def _load(remote: RemoteParameters, settings: Mapping[str, Setting]) -> bool:
    """Set parameters, as far as possible; return whether any could not be set."""
    described = remote.describe(list(settings))
    present = dict(zip(described, remote.get(list(described)), strict=True))
    failed = False
    for name, setting in settings.items():
        if name not in described:
            output.error(f"{setting.place}: {remote.unknown(name)}")
            failed = failed or not setting.is_optional
            continue
        message = _message(as_declared(setting.value, described[name].type), described[name])
        if described[name].read_only and message == present[name]:
            output.data(f"Parameter {name} is read-only and already has this value")
            continue
        result = remote.set({name: message})[0]
        if result.successful:
            output.data(f"Set parameter {name} successful")
        else:
            output.talk(f"Set parameter {name} failed: {result.reason}")
            failed = True
    return failed


def _message(value: object, declared: ParameterDescriptor) -> ParameterValue:
    """Convert a value to a message; an empty list gets the declared type."""
    from graphflow.interface import type_id
    from graphflow.runtime.parameters.values import to_message

    return to_message(value, declared.type if value == [] else type_id(value))
