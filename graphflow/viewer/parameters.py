"""The parameters of all nodes as parameters of viewers: `/turtlesim.background_r`."""

from __future__ import annotations

import asyncio
import base64
import binascii
import itertools
import logging
import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from typing import Required, TypedDict

from graphflow.errors import GraphflowError, ParameterError, ServiceUnavailable, UsageFault, printable
from graphflow.introspect.parameters import as_declared
from graphflow.msgs.base import Request, Response, Service
from graphflow.msgs.rcl_interfaces.msg import Parameter, ParameterEvent, ParameterValue
from graphflow.msgs.rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters
from graphflow.names import did_you_mean
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


class ParameterFields(TypedDict, total=False):
    """A parameter in the protocol's form. Without a value, it does not exist any more."""

    name: Required[str]
    value: object
    type: str


class Parameters:
    """The parameters of all nodes in a graph.

    Args:
        changed: Called with parameters that have changed.
    """

    def __init__(self, node: Node, changed: Callable[[list[ParameterFields]], object]) -> None:
        self._node, self._report = node, changed
        node.create_subscription(ParameterEvent, "/parameter_events", self._changed, PARAMETER_EVENTS)

    async def get(self, names: Sequence[str]) -> list[ParameterFields]:
        """Return the existing parameters of these names; all if there are none. Those of hidden nodes do not count."""
        of_node: dict[str, list[str]] = defaultdict(list)
        for name in names:
            node, _, parameter = name.partition(".")
            of_node[node].append(parameter)
        services = self._node.context.cache.services()
        nodes = {name.removesuffix(_LIST) for name in services if name.endswith(_LIST)}
        nodes = {node for node in nodes if not names or node in of_node}
        parameters = await asyncio.gather(*(self._read(node, of_node[node]) for node in sorted(nodes)))
        return list(itertools.chain.from_iterable(parameters))

    async def set(self, wanted: Iterable[Value]) -> None:
        """Set parameters, one after the other.

        Raises:
            GraphflowError: A node refuses a value; the text says which and why.
        """
        for value in wanted:
            node, _, name = value.name.partition(".")
            describe = DescribeParameters.Request(names=[name])
            described = (await self._call(node, "describe_parameters", DescribeParameters, describe)).descriptors
            type_ = described[0].type if len(described) else 0
            if not type_:
                raise UsageFault(f"{value.name}: node {node} has no such parameter")
            request = SetParameters.Request(parameters=[Parameter(name=name, value=_decode(value, type_))])
            results = (await self._call(node, "set_parameters", SetParameters, request)).results
            if not len(results):
                raise ParameterError(f"{value.name}: node {node} sent no result")
            if not results[0].successful:
                raise ParameterError(f"{value.name}: {results[0].reason}")

    async def _read(self, node: str, names: list[str]) -> list[ParameterFields]:
        try:
            if not names:
                listed = await self._call(node, "list_parameters", ListParameters, ListParameters.Request())
                names = list(listed.result.names)
            values = (
                await self._call(node, "get_parameters", GetParameters, GetParameters.Request(names=names))
            ).values
            return [
                encode_parameter(node, name, value) for name, value in zip(names, values, strict=False) if value.type
            ]
        except GraphflowError as error:
            logger.warning("the parameters of %s are not shown: %s", printable(node), printable(str(error)))
            return []

    async def _call(
        self, node: str, service: str, type_: type[Service[Request, Response]], request: Request
    ) -> Response:
        cache = self._node.context.cache
        if not cache.endpoints(Kind.SERVICE, f"{node}/{service}"):
            raise ServiceUnavailable(f"no node {node} has parameters{did_you_mean(node, cache.nodes(hidden=False))}")
        client = self._node.create_client(type_, f"{node}/{service}")
        try:
            return await client.call(request, timeout=LIMIT)
        finally:
            client.close()

    def _changed(self, event: ParameterEvent) -> None:
        try:
            current = (*event.new_parameters, *event.changed_parameters)
            changes = [encode_parameter(event.node, p.name, p.value) for p in current]
        except GraphflowError as error:
            logger.warning("a parameter event of %s is not shown: %s", printable(event.node), printable(str(error)))
            return
        deleted = [ParameterFields(name=f"{event.node}.{parameter.name}") for parameter in event.deleted_parameters]
        self._report([*changes, *deleted])


def encode_parameter(node: str, name: str, message: ParameterValue) -> ParameterFields:
    """Convert a parameter to the protocol's form.

    Raises:
        ParameterError: Its type is not one of ROS 2's.
    """
    value = from_message(message)
    # JSON has no bytes; the protocol takes base64.
    encoded = base64.b64encode(value).decode() if message.type == 5 else _json(value)
    fields = ParameterFields(name=f"{node}.{name}", value=encoded)
    if message.type in _TYPES:
        fields["type"] = _TYPES[message.type]
    return fields


def _json(value: object) -> object:
    """Convert a value to JSON; infinities and NaN become strings."""
    if isinstance(value, list):
        return [_json(item) for item in value]
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def _decode(value: Value, type_: int) -> ParameterValue:
    """Convert a client's value to the type that the node expects.

    Raises:
        UsageFault: It is not of the parameter's type.
    """
    try:
        if type_ == 5:
            return to_message(base64.b64decode(str(value.value), validate=True), type_)
        return to_message(as_declared(value.value, type_), type_)
    except (GraphflowError, TypeError, ValueError, OverflowError, binascii.Error) as error:
        raise UsageFault(f"{value.name}: {error}") from None
