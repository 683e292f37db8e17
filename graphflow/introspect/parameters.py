"""The parameters of a node, read and set through its services."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from graphflow.errors import GraphflowError, ParameterError, UsageFault
from graphflow.introspect.graph_view import View
from graphflow.names import did_you_mean

if TYPE_CHECKING:
    from graphflow.msgs.rcl_interfaces.msg import ParameterDescriptor, ParameterValue, SetParametersResult

STARTING = 1.0  # most seconds between the tokens of a node and of its services, on a busy machine
_BOOLEANS = {"on": True, "yes": True, "true": True, "off": False, "no": False, "false": False}


class RemoteParameters:
    """The parameters of one node.

    Args:
        node: Its full name.
        timeout: Seconds that each call may take.

    All methods raise CallError if the node does not answer or has no parameter services.
    """

    def __init__(self, view: View, node: str, timeout: float) -> None:
        self._view, self._node, self._timeout = view, node, timeout

    def _call(self, service: str, type_name: str, **request: object) -> Any:
        from graphflow.msgs import registry
        from graphflow.msgs.values import from_plain

        full, type_ = f"{self._node}/{service}", f"rcl_interfaces/srv/{type_name}"
        self._view.wait_for_service(full, min(self._timeout, STARTING))
        message = from_plain(registry.interface_class(f"{type_}_Request"), request)
        return self._view.call(full, type_, message, self._timeout, plain=True)

    def names(self) -> list[str]:
        """Return all names, sorted."""
        return sorted(self._call("list_parameters", "ListParameters").result.names)

    def get(self, names: Sequence[str]) -> list[ParameterValue]:
        """Return the values, which have type 0 for parameters that do not exist."""
        found = list(self._call("get_parameters", "GetParameters", names=list(names)).values)
        if len(found) == len(names):
            return found
        # A ROS 2 node returns nothing at all if it does not know one of the names: query one by one.
        from graphflow.msgs.rcl_interfaces.msg import ParameterValue

        answers = [self._call("get_parameters", "GetParameters", names=[name]).values for name in names]
        return [answer[0] if len(answer) else ParameterValue() for answer in answers]

    def describe(self, names: Sequence[str]) -> dict[str, ParameterDescriptor]:
        """Return the descriptors of the parameters that exist, by name."""
        if not names:
            return {}
        found = self._call("describe_parameters", "DescribeParameters", names=list(names)).descriptors
        if not len(found):
            answers = [self._call("describe_parameters", "DescribeParameters", names=[n]).descriptors for n in names]
            found = [descriptor for answer in answers for descriptor in answer]
        return {d.name: d for d in found if d.type or d.dynamic_typing}  # unset parameters have no type

    def set(self, values: dict[str, ParameterValue]) -> list[SetParametersResult]:
        """Set parameters one by one; return one result for each."""
        parameters = [{"name": name, "value": value} for name, value in values.items()]
        return list(self._call("set_parameters", "SetParameters", parameters=parameters).results)

    def known(self, name: str) -> ParameterDescriptor:
        """Return the descriptor of one parameter.

        Raises:
            ParameterError: It does not exist; the text suggests the nearest.
        """
        described = self.describe([name])
        if name not in described:
            raise self.unknown(name)
        return described[name]

    def unknown(self, name: str) -> ParameterError:
        """Return the error for a parameter that does not exist."""
        known = self.names()
        if name in known:  # asked again, another node of that name has answered
            return ParameterError(f"two nodes are called {self._node}, and one has no parameter {name!r}; rename one")
        return ParameterError(f"node {self._node} has no parameter {name!r}{did_you_mean(name, known)}")


def read_value(text: str, type_: int) -> object:
    """Convert a typed value to the declared type: quoted or not, `on` for a bool, 2 for a double.

    Args:
        type_: A number of rcl_interfaces/msg/ParameterType; 0 for a parameter of any type.

    Raises:
        UsageFault: `text` is not YAML, or a comment.
    """
    from graphflow.markup.source import parse_value

    if type_ == 4:
        try:
            value = parse_value(text)
        except GraphflowError:
            return text
        return value if isinstance(value, str) else text
    if type_ == 1 and text.lower() in _BOOLEANS:
        return _BOOLEANS[text.lower()]
    try:
        value = parse_value(text)
    except GraphflowError as error:
        raise UsageFault(str(error)) from None
    if value is None and text.lstrip().startswith("#"):
        raise UsageFault(f"{text!r} has no value, since # begins a comment in YAML; for the text write '\"{text}\"'")
    return as_declared(value, type_)


def as_declared(value: object, type_: int) -> object:
    """Convert a YAML value to a parameter's type: integers to doubles, lists of numbers to bytes.

    Args:
        type_: A number of rcl_interfaces/msg/ParameterType.
    """
    if type_ == 3 and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if type_ == 8 and isinstance(value, list):
        return [float(v) if isinstance(v, int) and not isinstance(v, bool) else v for v in value]
    if type_ == 5 and isinstance(value, list) and all(type(v) is int and v in range(256) for v in value):
        return bytes(value)
    return value
