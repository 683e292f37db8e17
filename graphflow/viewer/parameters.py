"""The parameters of all nodes as parameters of viewers: `/turtlesim.background_r`."""

from __future__ import annotations

import asyncio
import base64
import binascii
import logging
import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from graphflow.errors import GraphflowError, ParameterError, ServiceUnavailable, UsageFault, printable
from graphflow.introspect.parameters import as_declared
from graphflow.msgs import registry
from graphflow.msgs.values import from_plain
from graphflow.names import did_you_mean, is_hidden
from graphflow.qos import PARAMETER_EVENTS
from graphflow.runtime.node import Node
from graphflow.runtime.parameters.values import from_message, to_message
from graphflow.viewer.protocol import Value
from graphflow.wire.liveliness import Kind

logger = logging.getLogger("graphflow")

LIMIT = 2.0
"""Seconds that a node has to reply."""
_LIST = "/list_parameters"
_TYPES = {3: "float64", 5: "byte_array", 8: "float64_array"}
"""Types that JSON cannot tell apart, by the numbers of rcl_interfaces/msg/ParameterType."""

Words = dict[str, Any]
"""A parameter in the protocol's form: name, value and type."""


class Parameters:
    """The parameters of all nodes in a graph.

    Args:
        changed: Called with parameters that have changed.
    """

    def __init__(self, node: Node, changed: Callable[[list[Words]], object]) -> None:
        self._node, self._tell = node, changed
        event: Any = registry.interface_class("rcl_interfaces/msg/ParameterEvent")
        node.create_subscription(event, "/parameter_events", self._changed, PARAMETER_EVENTS)

    async def get(self, names: Sequence[str]) -> list[Words]:
        """Return the existing parameters of these names; all if there are none."""
        of_node: dict[str, list[str]] = defaultdict(list)
        for name in names:
            node, _, parameter = name.partition(".")
            of_node[node].append(parameter)
        services = self._node.context.cache.services()
        there = {name.removesuffix(_LIST) for name in services if name.endswith(_LIST)}
        there = {node for node in there if not is_hidden(node) and (not names or node in of_node)}
        found = await asyncio.gather(*(self._of(node, of_node[node]) for node in sorted(there)))
        return [parameter for some in found for parameter in some]

    async def set(self, wanted: Iterable[Value]) -> None:
        """Set parameters, one after the other.

        Raises:
            GraphflowError: A node refuses a value; the text says which and why.
        """
        for value in wanted:
            node, _, name = value.name.partition(".")
            described = (await self._ask(node, "describe_parameters", "DescribeParameters", names=[name])).descriptors
            type_ = described[0].type if len(described) else 0
            if not type_:
                raise UsageFault(f"{value.name}: node {node} has no such parameter")
            message = {"name": name, "value": _message(value, type_)}
            results = (await self._ask(node, "set_parameters", "SetParameters", parameters=[message])).results
            if not (len(results) and results[0].successful):
                raise ParameterError(f"{value.name}: {results[0].reason if len(results) else 'the node said nothing'}")

    async def _of(self, node: str, names: list[str]) -> list[Words]:
        try:
            names = names or list((await self._ask(node, "list_parameters", "ListParameters")).result.names)
            values = (await self._ask(node, "get_parameters", "GetParameters", names=names)).values
            return [shown(node, name, value) for name, value in zip(names, values, strict=False) if value.type]
        except GraphflowError as error:
            logger.warning("the parameters of %s are not shown: %s", printable(node), printable(str(error)))
            return []

    async def _ask(self, node: str, service: str, type_name: str, **fields: Any) -> Any:
        cache = self._node.context.cache
        if not cache.endpoints(Kind.SERVICE, f"{node}/{service}"):
            raise ServiceUnavailable(f"no node {node} has parameters{did_you_mean(node, cache.nodes(hidden=False))}")
        type_: Any = registry.interface_class(f"rcl_interfaces/srv/{type_name}")
        client: Any = self._node.create_client(type_, f"{node}/{service}")
        try:
            return await client.call(from_plain(type_.Request, fields), timeout=LIMIT)
        finally:
            client.close()

    def _changed(self, event: Any) -> None:
        try:
            now = [shown(event.node, p.name, p.value) for p in (*event.new_parameters, *event.changed_parameters)]
        except GraphflowError as error:
            logger.warning("a parameter event of %s is not shown: %s", printable(event.node), printable(str(error)))
            return
        gone = [{"name": f"{event.node}.{parameter.name}"} for parameter in event.deleted_parameters]
        self._tell([*now, *gone])


def shown(node: str, name: str, message: Any) -> Words:
    """Convert a parameter to the protocol's form.

    Args:
        message: rcl_interfaces/msg/ParameterValue.

    Raises:
        ParameterError: Its type is not one of ROS 2's.
    """
    value = from_message(message)
    words = {"name": f"{node}.{name}", "value": base64.b64encode(value).decode() if message.type == 5 else _json(value)}
    return words | ({"type": _TYPES[message.type]} if message.type in _TYPES else {})


def _json(value: Any) -> Any:
    """Convert a value to JSON; infinities and NaN become strings."""
    if isinstance(value, list):
        return [_json(item) for item in value]
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def _message(value: Value, type_: int) -> Any:
    """Convert a client's value to the type that the node expects.

    Raises:
        UsageFault: It is not of the parameter's type.
    """
    try:
        given = base64.b64decode(value.value, validate=True) if type_ == 5 else as_declared(value.value, type_)
        return to_message(given, type_)
    except (GraphflowError, TypeError, ValueError, OverflowError, binascii.Error) as error:
        raise UsageFault(f"{value.name}: {error}") from None
