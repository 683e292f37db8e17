"""A node's parameters on the network: ROS 2's six services and the topic /parameter_events.

Source: rcl_interfaces. Unlike rclpy, an unknown name in a `get` does not empty the whole response: its
value is "not set".
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from graphflow.errors import ParameterError
from graphflow.interface import TYPE_IDS, Parameter, type_id
from graphflow.msgs.base import Message
from graphflow.qos import PARAMETER_EVENTS
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.parameters.params import ParameterChange, Parameters
from graphflow.runtime.parameters.values import from_message, to_message
from graphflow.runtime.part import Host, Part

if TYPE_CHECKING:
    from graphflow.msgs.rcl_interfaces import msg as rcl
    from graphflow.msgs.rcl_interfaces import srv

_INT64 = range(-(2**63), 2**63)


def type_number(parameter: Parameter, value: object) -> int:
    """Return the rcl_interfaces/msg/ParameterType number of a parameter with `value`."""
    return type_id(value) if parameter.dynamic else TYPE_IDS[parameter.type]


def to_descriptor(parameter: Parameter) -> rcl.ParameterDescriptor:
    """Convert a declaration to a ParameterDescriptor; exclusive limits go to the additional constraints."""
    from graphflow.msgs.rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor

    descriptor = ParameterDescriptor(
        name=parameter.name,
        type=TYPE_IDS[parameter.type],
        description=f"{parameter.doc}{f' [{parameter.unit}]' if parameter.unit else ''}",
        read_only=parameter.read_only,
        dynamic_typing=parameter.dynamic,
    )
    if parameter.choices:
        descriptor.additional_constraints = parameter.choices_text()
    elif parameter.gt is not None or parameter.lt is not None:
        descriptor.additional_constraints = parameter.range_text()
    if parameter.ge is None and parameter.le is None and not parameter.step:
        return descriptor
    if parameter.type in ("int", "list[int]"):
        low = _INT64.start if parameter.ge is None else math.ceil(parameter.ge)
        high = _INT64.stop - 1 if parameter.le is None else math.floor(parameter.le)
        descriptor.integer_range = [IntegerRange(from_value=low, to_value=high, step=int(parameter.step) or 1)]
    else:
        low_f = -math.inf if parameter.ge is None else parameter.ge
        high_f = math.inf if parameter.le is None else parameter.le
        descriptor.floating_point_range = [FloatingPointRange(from_value=low_f, to_value=high_f, step=parameter.step)]
    return descriptor


def _is_listed(name: str, prefixes: Iterable[str], depth: int) -> bool:
    """Whether `name` is under a prefix, if there are any, and at most `depth` levels below it (0: any depth)."""
    for prefix in prefixes or ("",):
        if not prefix or name == prefix or name.startswith(f"{prefix}."):
            below = name.removeprefix(prefix).strip(".")
            if not depth or below.count(".") < depth:
                return True
    return False


class ParameterServices:
    """Handlers of a node's six parameter services."""

    def __init__(self, parameters: Parameters) -> None:
        self._parameters = parameters

    def handlers(self) -> Iterable[tuple[str, str, Callable[[Any], Message]]]:
        """List the services: (name below the node, service type in rcl_interfaces, handler)."""
        yield "get_parameters", "GetParameters", self.get
        yield "get_parameter_types", "GetParameterTypes", self.get_types
        yield "set_parameters", "SetParameters", self.set
        yield "set_parameters_atomically", "SetParametersAtomically", self.set_atomically
        yield "list_parameters", "ListParameters", self.list
        yield "describe_parameters", "DescribeParameters", self.describe

    def _type(self, name: str) -> int:
        return type_number(self._parameters.describe(name), self._parameters.get(name))

    def get(self, request: srv.GetParameters_Request) -> srv.GetParameters_Response:
        from graphflow.msgs.rcl_interfaces.msg import ParameterValue
        from graphflow.msgs.rcl_interfaces.srv import GetParameters

        values = self._parameters
        return GetParameters.Response(
            values=[
                to_message(values.get(n), self._type(n)) if n in values else ParameterValue() for n in request.names
            ]
        )

    def get_types(self, request: srv.GetParameterTypes_Request) -> srv.GetParameterTypes_Response:
        from graphflow.msgs.rcl_interfaces.srv import GetParameterTypes

        known = self._parameters
        return GetParameterTypes.Response(types=[self._type(n) if n in known else 0 for n in request.names])

    def describe(self, request: srv.DescribeParameters_Request) -> srv.DescribeParameters_Response:
        from graphflow.msgs.rcl_interfaces.msg import ParameterDescriptor
        from graphflow.msgs.rcl_interfaces.srv import DescribeParameters

        known = self._parameters
        return DescribeParameters.Response(
            descriptors=[
                to_descriptor(known.describe(n)) if n in known else ParameterDescriptor(name=n) for n in request.names
            ]
        )

    def list(self, request: srv.ListParameters_Request) -> srv.ListParameters_Response:
        from graphflow.msgs.rcl_interfaces.msg import ListParametersResult
        from graphflow.msgs.rcl_interfaces.srv import ListParameters

        names = [n for n in self._parameters.names() if _is_listed(n, request.prefixes, request.depth)]
        prefixes = {name.rpartition(".")[0] for name in names if "." in name}
        return ListParameters.Response(result=ListParametersResult(names=names, prefixes=sorted(prefixes)))

    def set(self, request: srv.SetParameters_Request) -> srv.SetParameters_Response:
        from graphflow.msgs.rcl_interfaces.srv import SetParameters

        return SetParameters.Response(results=[self._set([p]) for p in request.parameters])

    def set_atomically(self, request: srv.SetParametersAtomically_Request) -> srv.SetParametersAtomically_Response:
        from graphflow.msgs.rcl_interfaces.srv import SetParametersAtomically

        return SetParametersAtomically.Response(result=self._set(request.parameters))

    def _set(self, parameters: Iterable[rcl.Parameter]) -> rcl.SetParametersResult:
        from graphflow.msgs.rcl_interfaces.msg import SetParametersResult

        try:
            self._parameters.set({p.name: from_message(p.value) for p in parameters})
        except ParameterError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)


class ParameterEvents(Part):
    """The publisher of a node's parameter changes on /parameter_events; at the start, all count as new."""

    def __init__(self, host: Host, parameters: Parameters) -> None:
        from graphflow.msgs.rcl_interfaces.msg import ParameterEvent

        self._host, self._parameters = host, parameters
        self._publisher = TopicPublisher(host, ParameterEvent, "/parameter_events", PARAMETER_EVENTS)

    def open(self) -> None:
        self._publisher.open()
        parameters = self._parameters
        self.publish({name: ParameterChange(None, parameters.get(name)) for name in parameters.names()})

    def publish(self, changes: Mapping[str, ParameterChange]) -> None:
        """Publish changes, if there are subscriptions."""
        if not self._publisher.is_wanted:
            return
        from graphflow.msgs.rcl_interfaces.msg import Parameter as ParameterMessage
        from graphflow.msgs.rcl_interfaces.msg import ParameterEvent

        event = ParameterEvent(stamp=self._host.clock.now(), node=self._host.full_name)
        for name, (old, new) in changes.items():
            if old is None and new is None:
                continue
            if new is None:
                event.deleted_parameters.append(ParameterMessage(name=name, value=to_message(old, type_id(old))))
                continue
            number = type_number(self._parameters.describe(name), new)
            target = event.new_parameters if old is None else event.changed_parameters
            target.append(ParameterMessage(name=name, value=to_message(new, number)))
        self._publisher.publish(event)

    def close(self) -> None:
        self._publisher.close()
        self._host.forget(self)
