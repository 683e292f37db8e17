"""A node's parameters: typed, ranged values, and the six services through which ROS 2 reads and sets them.

Source: rcl_interfaces; rclpy's rules for declared parameters. Unlike rclpy, one unknown name in a `get` does not
empty the whole answer: it comes back as not set.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from graphflow.errors import ParameterError
from graphflow.interface import TYPE_IDS, Parameter
from graphflow.names import did_you_mean
from graphflow.runtime.values import from_message, to_message

if TYPE_CHECKING:
    from graphflow.msgs.rcl_interfaces import msg as rcl

_INT64 = range(-(2**63), 2**63)


class Parameters:
    """One node's parameters.

    Args:
        overrides: Values from outside (graph file, command line) by name, each with where it was written.
    """

    def __init__(self, overrides: Mapping[str, tuple[Any, str]] | None = None) -> None:
        self._declared: dict[str, Parameter] = {}
        self._values: dict[str, Any] = {}
        self._sources: dict[str, str] = {}
        self._overrides = dict(overrides or {})
        self._checks: list[Callable[[Mapping[str, Any]], None]] = []
        self._observers: list[Callable[[str, Any], None]] = []

    def declare(self, parameter: Parameter) -> Any:
        """Add a parameter; its value is the override given for it, else its default.

        Raises:
            ParameterError: It is declared already, or the override does not fit.
        """
        if parameter.name in self._declared:
            raise ParameterError(f"parameter {parameter.name!r} is declared twice")
        if parameter.name in self._overrides:
            raw, source = self._overrides[parameter.name]
            try:
                value = parameter.fit(raw)
            except ParameterError as error:
                raise ParameterError(f"{error} (from {source})") from None
        else:
            value, source = parameter.fit(parameter.default), "default"
        self._declared[parameter.name] = parameter
        self._values[parameter.name], self._sources[parameter.name] = value, source
        return value

    def unused_overrides(self) -> list[str]:
        """Overrides for which no parameter has been declared, as sentences that help."""
        return [
            f"there is no parameter {name!r} (from {source}){did_you_mean(name, self._declared)}"
            for name, (_, source) in self._overrides.items()
            if name not in self._declared
        ]

    def __contains__(self, name: str) -> bool:
        return name in self._declared

    def names(self) -> list[str]:
        return sorted(self._declared)

    def get(self, name: str) -> Any:
        """A parameter's value.

        Raises:
            ParameterError: There is none of that name; the text names the nearest.
        """
        if name not in self._values:
            raise ParameterError(f"there is no parameter {name!r}{did_you_mean(name, self._declared)}")
        return self._values[name]

    def source(self, name: str) -> str:
        """Where the value came from: `default`, a file and line, `command line`, `set`."""
        return self._sources[name]

    def describe(self, name: str) -> Parameter:
        """A parameter's declaration. Raises ParameterError as `get`."""
        self.get(name)
        return self._declared[name]

    def set(self, values: Mapping[str, Any], source: str = "set") -> None:
        """Set parameters, all or none.

        Raises:
            ParameterError: One is unknown, read-only, of another type or out of range; nothing was changed.
        """
        fitted = {}
        for name, value in values.items():
            declared = self.describe(name)
            if declared.read_only:
                raise ParameterError(f"parameter {name!r} is read-only")
            fitted[name] = declared.fit(value)
        for check in self._checks:
            check(fitted)
        for name, value in fitted.items():
            self._values[name], self._sources[name] = value, source
        for name, value in fitted.items():
            for observer in self._observers:
                observer(name, value)

    def check(self, check: Callable[[Mapping[str, Any]], None]) -> None:
        """Have `check(changes)` called before each change; a ParameterError that it raises refuses them all."""
        self._checks.append(check)

    def observe(self, observer: Callable[[str, Any], None]) -> None:
        """Have `observer(name, value)` called after each change."""
        self._observers.append(observer)


def to_descriptor(parameter: Parameter) -> rcl.ParameterDescriptor:
    """A declaration as rcl_interfaces/msg/ParameterDescriptor; strict limits go into the additional constraints."""
    from graphflow.msgs.rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor

    descriptor = ParameterDescriptor(
        name=parameter.name,
        type=TYPE_IDS[parameter.type],
        description=f"{parameter.doc}{f' [{parameter.unit}]' if parameter.unit else ''}",
        read_only=parameter.read_only,
    )
    if parameter.gt is not None or parameter.lt is not None:
        descriptor.additional_constraints = parameter.range_text()
    if parameter.ge is None and parameter.le is None:
        return descriptor
    if parameter.type in ("int", "list[int]"):
        low = _INT64.start if parameter.ge is None else math.ceil(parameter.ge)
        high = _INT64.stop - 1 if parameter.le is None else math.floor(parameter.le)
        descriptor.integer_range = [IntegerRange(from_value=low, to_value=high, step=1)]
    else:
        low_f = -math.inf if parameter.ge is None else parameter.ge
        high_f = math.inf if parameter.le is None else parameter.le
        descriptor.floating_point_range = [FloatingPointRange(from_value=low_f, to_value=high_f)]
    return descriptor


def _is_listed(name: str, prefixes: Iterable[str], depth: int) -> bool:
    """Whether `name` is under one of the prefixes, if there are any, at most `depth` levels below it; 0: any depth."""
    for prefix in prefixes or ("",):
        if not prefix or name == prefix or name.startswith(f"{prefix}."):
            below = name.removeprefix(prefix).strip(".")
            if not depth or below.count(".") < depth:
                return True
    return False


class ParameterServices:
    """The handlers of a node's six parameter services."""

    def __init__(self, parameters: Parameters) -> None:
        self._parameters = parameters

    def handlers(self) -> Iterable[tuple[str, str, Callable[[Any], Any]]]:
        """(name under the node, service type in rcl_interfaces, handler)."""
        yield "get_parameters", "GetParameters", self.get
        yield "get_parameter_types", "GetParameterTypes", self.get_types
        yield "set_parameters", "SetParameters", self.set
        yield "set_parameters_atomically", "SetParametersAtomically", self.set_atomically
        yield "list_parameters", "ListParameters", self.list
        yield "describe_parameters", "DescribeParameters", self.describe

    def get(self, request: Any) -> Any:
        from graphflow.msgs.rcl_interfaces.msg import ParameterValue
        from graphflow.msgs.rcl_interfaces.srv import GetParameters

        values = self._parameters
        return GetParameters.Response(
            values=[
                to_message(values.get(n), TYPE_IDS[values.describe(n).type]) if n in values else ParameterValue()
                for n in request.names
            ]
        )

    def get_types(self, request: Any) -> Any:
        from graphflow.msgs.rcl_interfaces.srv import GetParameterTypes

        known = self._parameters
        return GetParameterTypes.Response(
            types=[TYPE_IDS[known.describe(n).type] if n in known else 0 for n in request.names]
        )

    def describe(self, request: Any) -> Any:
        from graphflow.msgs.rcl_interfaces.msg import ParameterDescriptor
        from graphflow.msgs.rcl_interfaces.srv import DescribeParameters

        known = self._parameters
        return DescribeParameters.Response(
            descriptors=[
                to_descriptor(known.describe(n)) if n in known else ParameterDescriptor(name=n) for n in request.names
            ]
        )

    def list(self, request: Any) -> Any:
        from graphflow.msgs.rcl_interfaces.msg import ListParametersResult
        from graphflow.msgs.rcl_interfaces.srv import ListParameters

        names = [n for n in self._parameters.names() if _is_listed(n, request.prefixes, request.depth)]
        prefixes = {name.rpartition(".")[0] for name in names if "." in name}
        return ListParameters.Response(result=ListParametersResult(names=names, prefixes=sorted(prefixes)))

    def set(self, request: Any) -> Any:
        from graphflow.msgs.rcl_interfaces.srv import SetParameters

        return SetParameters.Response(results=[self._set([p]) for p in request.parameters])

    def set_atomically(self, request: Any) -> Any:
        from graphflow.msgs.rcl_interfaces.srv import SetParametersAtomically

        return SetParametersAtomically.Response(result=self._set(request.parameters))

    def _set(self, parameters: Iterable[Any]) -> Any:
        from graphflow.msgs.rcl_interfaces.msg import SetParametersResult

        try:
            self._parameters.set({p.name: from_message(p.value) for p in parameters})
        except ParameterError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)
