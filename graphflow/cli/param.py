"""`graphflow param list`, `get` and `set`."""

from __future__ import annotations

from typing import Any

import click

from graphflow.cli import exits, output
from graphflow.cli.words import ValueCommand
from graphflow.domain import domain_id
from graphflow.errors import CallError, GraphflowError, ParameterError
from graphflow.introspect.view import View
from graphflow.names import did_you_mean, is_hidden
from graphflow.wire.liveliness import Kind

_WORDS = {"on": True, "yes": True, "true": True, "off": False, "no": False, "false": False}


@click.group()
def param() -> None:
    """List, get and set parameters."""


_timeout = click.option("--timeout", type=click.FloatRange(0, min_open=True), default=2.0, help="Seconds to wait.")


@param.command(name="list")
@click.argument("name", metavar="[NODE]", required=False)
@click.option("--param-type", is_flag=True, help="With their types.")
@click.option("--include-hidden-nodes", is_flag=True, help="Parameters of hidden nodes too.")
@_timeout
@click.option("--json", "as_json", is_flag=True, help="For programs.")
def list_(name: str | None, param_type: bool, include_hidden_nodes: bool, timeout: float, as_json: bool) -> None:
    """List the parameters of a node, or of all."""
    from graphflow.interface import TYPE_NAMES

    found: dict[str, dict[str, str]] = {}
    with View(domain_id()) as view:
        servers = {e.node_name for e in view.cache.endpoints(Kind.SERVICE) if e.name.endswith("/list_parameters")}
        nodes = [view.node(name)] if name else sorted(n for n in servers if include_hidden_nodes or not is_hidden(n))
        for node in nodes:
            try:
                names = _names(view, node, timeout)
                types = _types(view, node, names, timeout) if param_type or as_json else {}
            except CallError as error:
                if name:
                    raise
                output.talk(f"{node}: {error}")
                continue
            found[node] = {n: TYPE_NAMES[types[n]] if types else "" for n in names}
    if as_json:
        output.as_json(found)
        return
    for node, names_and_types in found.items():
        if not name:
            output.data(f"{node}:")
        output.lines(f"  {n}{f' (type: {t})' if t else ''}" for n, t in names_and_types.items())


@param.command()
@click.argument("name", metavar="NODE")
@click.argument("parameter")
@click.option("--hide-type", is_flag=True, help="Only the value.")
@_timeout
@click.option("--json", "as_json", is_flag=True, help="For programs.")
def get(name: str, parameter: str, hide_type: bool, timeout: float, as_json: bool) -> None:
    """Show the value of a parameter."""
    from graphflow.runtime.values import from_message, type_word

    with View(domain_id()) as view:
        node = view.node(name)
        message = _call(view, node, "GetParameters", {"names": [parameter]}, timeout).values
        if not message or message[0].type == 0:
            raise ParameterError(_unknown(view, node, parameter, timeout))
    value = from_message(message[0])
    if as_json:
        output.as_json(value)
    else:
        text = str(list(value)) if isinstance(value, bytes) else str(value)
        output.data(text if hide_type else f"{type_word(message[0].type)}: {text}")


@param.command(name="set", cls=ValueCommand)
@click.argument("name", metavar="NODE")
@click.argument("parameter")
@click.argument("value", nargs=-1, required=True)
@_timeout
def set_(name: str, parameter: str, value: tuple[str, ...], timeout: float) -> int:
    """Set a parameter: VALUE is YAML, read as the type the parameter has."""
    from graphflow.interface import TYPE_IDS, type_of
    from graphflow.runtime.values import to_message

    with View(domain_id()) as view:
        node = view.node(name)
        described = _call(view, node, "DescribeParameters", {"names": [parameter]}, timeout).descriptors
        if not described or described[0].type == 0:
            raise ParameterError(_unknown(view, node, parameter, timeout))
        read = read_value(" ".join(value), described[0].type)
        message = to_message(read, TYPE_IDS[type_of(read)])
        request = {"parameters": [{"name": parameter, "value": message}]}
        result = _call(view, node, "SetParameters", request, timeout).results[0]
    if result.successful:
        output.data("Set parameter successful" + (f": {result.reason}" if result.reason else ""))
        return exits.OK
    output.talk(f"Setting parameter failed: {result.reason}")
    return exits.FAILED


def read_value(text: str, type_: int) -> Any:
    """A value from the command line as the declared type wants it: quoted or not, `on` for a bool, 2 for a double.

    Args:
        type_: A number of rcl_interfaces/msg/ParameterType.

    Raises:
        UsageFault: It is not YAML.
    """
    from graphflow.graph.source import parse_value

    if type_ == 4:
        try:
            value = parse_value(text)
        except GraphflowError:
            return text
        return value if isinstance(value, str) else text
    if type_ == 1 and text.lower() in _WORDS:
        return _WORDS[text.lower()]
    try:
        value = parse_value(text)
    except GraphflowError as error:
        raise exits.UsageFault(str(error)) from None
    if type_ == 3 and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if type_ == 8 and isinstance(value, list):
        return [float(v) if isinstance(v, int) and not isinstance(v, bool) else v for v in value]
    if type_ == 5 and isinstance(value, list) and all(type(v) is int and v in range(256) for v in value):
        return bytes(value)
    return value


def _call(view: View, node: str, what: str, request: dict[str, Any], timeout: float) -> Any:
    from graphflow.msgs import registry
    from graphflow.msgs.values import from_plain

    type_name = f"rcl_interfaces/srv/{what}"
    name = {
        "GetParameters": "get_parameters",
        "SetParameters": "set_parameters",
        "ListParameters": "list_parameters",
        "DescribeParameters": "describe_parameters",
    }[what]
    service = f"{node}/{name}"
    view.service_type(service)
    message = from_plain(registry.interface_class(f"{type_name}_Request"), request)
    return view.call(service, type_name, message, timeout)


def _names(view: View, node: str, timeout: float) -> list[str]:
    return sorted(_call(view, node, "ListParameters", {}, timeout).result.names)


def _types(view: View, node: str, names: list[str], timeout: float) -> dict[str, int]:
    descriptors = _call(view, node, "DescribeParameters", {"names": names}, timeout).descriptors
    return {d.name: d.type for d in descriptors}


def _unknown(view: View, node: str, parameter: str, timeout: float) -> str:
    return f"node {node} has no parameter {parameter!r}{did_you_mean(parameter, _names(view, node, timeout))}"
