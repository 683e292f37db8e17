"""The parameter services of an rclpy node that only read, answered on the event loop.

So parameters can be read even if the node does not spin, or is stuck in a callback. Only the executor sets them.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from typing import TYPE_CHECKING, Any, Protocol

from graphflow.msgs import registry
from graphflow.qos import PARAMETERS
from graphflow.runtime.node_core import NodeCore
from graphflow.runtime.parameters.values import to_message

if TYPE_CHECKING:
    from rcl_interfaces.msg import ListParametersResult, ParameterDescriptor
    from rcl_interfaces.srv import DescribeParameters, GetParameters, GetParameterTypes, ListParameters


class Stored(Protocol):
    """A parameter, as the services read it."""

    @property
    def value(self) -> Any: ...

    @property
    def type_(self) -> Enum: ...


class Known(Protocol):
    """The parameters of a node, as the services read them."""

    @property
    def values(self) -> Mapping[str, Stored]:
        """The parameters by name."""

    @property
    def descriptors(self) -> Mapping[str, ParameterDescriptor]: ...

    def listed(self, prefixes: list[str], depth: int) -> ListParametersResult:
        """Return an rcl_interfaces/msg/ListParametersResult."""


def _class(name: str) -> Any:
    return registry.interface_class(f"rcl_interfaces/{name}")


class ParameterAnswers:
    """The reading services of one node."""

    def __init__(self, parameters: Known) -> None:
        self._parameters = parameters

    def serve(self, core: NodeCore) -> None:
        """Offer the services that read. Runs on the loop."""
        for name, type_name, answer in (
            ("get_parameters", "GetParameters", self.get),
            ("get_parameter_types", "GetParameterTypes", self.get_types),
            ("list_parameters", "ListParameters", self.list),
            ("describe_parameters", "DescribeParameters", self.describe),
        ):
            core.serve(name, f"rcl_interfaces/srv/{type_name}", answer, PARAMETERS)

    def get(self, request: GetParameters.Request) -> GetParameters.Response:
        values = self._parameters.values
        found = [values.get(name) for name in request.names]
        messages = [to_message(None, 0) if p is None else to_message(p.value, p.type_.value) for p in found]
        return _class("srv/GetParameters").Response(values=messages)

    def get_types(self, request: GetParameterTypes.Request) -> GetParameterTypes.Response:
        values = self._parameters.values
        types = [values[name].type_.value if name in values else 0 for name in request.names]
        return _class("srv/GetParameterTypes").Response(types=types)

    def list(self, request: ListParameters.Request) -> ListParameters.Response:
        result = self._parameters.listed(list(request.prefixes), int(request.depth))
        listed = {"names": list(result.names), "prefixes": list(result.prefixes)}
        return _class("srv/ListParameters").Response(result=listed)

    def describe(self, request: DescribeParameters.Request) -> DescribeParameters.Response:
        known, kind = self._parameters.descriptors, _class("msg/ParameterDescriptor")
        described = [_descriptor(kind, known[n]) if n in known else kind(name=n) for n in request.names]
        return _class("srv/DescribeParameters").Response(descriptors=described)


def _descriptor(kind: type, given: ParameterDescriptor) -> ParameterDescriptor:
    """Convert a descriptor of rclpy's to one of graphflow's."""
    plain = ("name", "type", "description", "additional_constraints", "read_only", "dynamic_typing")
    ranges = {
        name: [{part: getattr(r, part) for part in ("from_value", "to_value", "step")} for r in getattr(given, name)]
        for name in ("floating_point_range", "integer_range")
    }
    return kind(**{name: getattr(given, name) for name in plain}, **ranges)
