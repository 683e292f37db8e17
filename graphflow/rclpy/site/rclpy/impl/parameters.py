"""A node's parameters by rclpy's rules, with its error texts.

Source: the documentation of `rclpy.node.Node`.
"""

from __future__ import annotations

import math
import threading
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from graphflow.names import nearest
from rclpy.exceptions import (
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from rclpy.impl.callers import stack_level
from rclpy.impl.mistakes.arguments import must_return
from rclpy.impl.overrides import remark
from rclpy.parameter import PARAMETER_SEPARATOR_STRING, Parameter, parameter_value_to_python
from rclpy.validate_parameter_name import validate_parameter_name

if TYPE_CHECKING:
    from rcl_interfaces.msg import (
        FloatingPointRange,
        IntegerRange,
        ListParametersResult,
        ParameterDescriptor,
        SetParametersResult,
    )

Kind = Parameter.Type
TRUTHS = {"on": True, "yes": True, "y": True, "off": False, "no": False, "n": False}
"""Words that ROS 2 reads as booleans in parameter files, and YAML 1.2 does not."""
RESULT = "SetParametersResult(successful=True), of rcl_interfaces.msg"
"""The result that callbacks of `add_on_set_parameters_callback` return."""
RELATIVE_TOLERANCE = 1e-6
"""The greatest relative distance of a value from a step."""

OnChange = Callable[[list[Parameter], Mapping[str, Parameter]], None]
"""Called after parameters were set, with them and with their former values by name."""


class NodeParameters:
    """The parameters of one node.

    Args:
        overrides: Values from the command line, files or the constructor, by name.
        allows_undeclared: Whether undeclared parameters may be set and read.
        on_change: Called after each change.
    """

    def __init__(self, overrides: Mapping[str, Parameter], on_change: OnChange, *, allows_undeclared: bool) -> None:
        self.overrides = dict(overrides)
        self.sources: dict[str, str] = {}
        """The sources of the overrides from the command line or a file."""
        self.allows_undeclared = allows_undeclared
        self.values: dict[str, Parameter] = {}
        self.descriptors: dict[str, ParameterDescriptor] = {}
        self.names: set[str] = set()
        """All names that were ever declared, successfully or not."""
        self.examined: set[str] = set()
        """Names of those that another process has set, and that were examined for an effect."""
        self.before: list[Callable[[list[Parameter]], Iterable[Parameter]]] = []
        self.checks: list[Callable[[list[Parameter]], SetParametersResult]] = []
        self.after: list[Callable[[list[Parameter]], object]] = []
        self._on_change = on_change
        self.lock = threading.RLock()

    def _undeclared(self, names: Iterable[str] | str) -> ParameterNotDeclaredException:
        """Return the error for undeclared parameters, with the nearest declared name."""
        error = ParameterNotDeclaredException(names)
        name = names if isinstance(names, str) else next(iter(names))
        near = nearest(name, self.values)
        way = f"did you mean {near!r}?" if near is not None else f"declare it first: declare_parameter({name!r}, 1.0)"
        error.add_note(f"note: {way}")
        return error

    # declaring

    def declare(
        self, namespace: str, parameters: Sequence[Sequence[object]], *, ignore_override: bool = False
    ) -> list[Parameter]:
        """Declare parameters, each given as (name,), (name, type or value) or (name, type or value, descriptor)."""
        wanted: list[Parameter] = []
        descriptors: dict[str, ParameterDescriptor] = {}
        for index, given in enumerate(parameters):
            name, value, descriptor = self._read(given, index)
            full = f"{namespace}{PARAMETER_SEPARATOR_STRING}{name}" if namespace else name
            validate_parameter_name(full)
            # Also if the declaration fails below: an override for it is then no misspelt name.
            self.names.add(full)
            if not ignore_override and full in self.overrides:
                value = self.overrides[full].value
                if descriptor.type == Kind.BOOL.value and isinstance(value, str):
                    value = TRUTHS.get(value.lower(), value)
            if not isinstance(value, Parameter):
                # An empty list has no type of its own; the declared one counts.
                kind = Kind(descriptor.type) if _is_empty(value) and descriptor.type else None
                value = Parameter(full, kind, value) if kind is not None else Parameter(full, value=value)
            # rclpy writes into the caller's descriptor, too.
            descriptor.name = full
            wanted.append(value)
            descriptors[full] = descriptor
        known = [p.name for p in wanted if p.name in self.values]
        if known:
            raise ParameterAlreadyDeclaredException(known)
        # One by one, as in rclpy: those before a wrong one stay declared.
        for parameter in wanted:
            result = self._set([parameter], descriptors, allows_not_set=True)
            if not result.successful:
                self.descriptors.pop(parameter.name, None)
                if result.reason.startswith("Wrong parameter type"):
                    kind = Kind(descriptors[parameter.name].type)
                    wrong = InvalidParameterTypeException(parameter, kind)
                    if parameter.name in self.sources and not ignore_override:
                        source = self.sources[parameter.name]
                        wrong.add_note(f"note: {remark(parameter.name, parameter.value, source, kind)}")
                    raise wrong
                raise InvalidParameterValueException(parameter.name, parameter.value, result.reason)
        return [self.values[p.name] for p in wanted]

    @staticmethod
    def _read(given: Sequence[object], index: int) -> tuple[str, object, ParameterDescriptor]:
        from rcl_interfaces.msg import ParameterDescriptor, ParameterValue

        is_text = isinstance(given, str) and len(given) > 1
        if is_text and len(given) == 2:  # ROS 2 takes the first character for the name
            warnings.warn(
                f"{given!r} is a string, not a tuple, and declares {given[0]!r} with the value {given[1]!r}: write "
                f"({given!r}, 1.0), with its default",
                stacklevel=stack_level(),
            )
        if not 1 <= len(given) <= 3 or (is_text and len(given) == 3):
            raise TypeError(
                f"Invalid parameter tuple length at index {index} in parameters list: {given}; "
                "expecting length between 1 and 3"
            )
        name, second = given[0], given[1] if len(given) > 1 else None
        descriptor = given[2] if len(given) > 2 else ParameterDescriptor()
        if not isinstance(name, str):
            raise TypeError(f"First element {name} at index {index} in parameters list is not a str.")
        if not isinstance(descriptor, ParameterDescriptor):
            raise TypeError(
                f"Third element {descriptor} at index {index} in parameters list is not a ParameterDescriptor."
            )
        value = None
        if len(given) == 1:
            warnings.warn(
                f"when declaring parameter named '{name}', declaring a parameter only providing its name is "
                "deprecated. You have to either:\n"
                '\t- Pass a name and a default value different to "PARAMETER NOT SET" (and optionally a descriptor).\n'
                "\t- Pass a name and a parameter type.\n"
                "\t- Pass a name and a descriptor with `dynamic_typing=True",
                stacklevel=4,
            )
            descriptor.dynamic_typing = True
        elif isinstance(second, Kind):
            if second is Kind.NOT_SET:
                raise ValueError(f"Cannot declare parameter {{{name}}} as statically typed of type NOT_SET")
            if descriptor.dynamic_typing:
                raise ValueError(
                    f"When declaring parameter {{{name}}} passing a descriptor with `dynamic_typing=True`, "
                    "a parameter type must not be given"
                )
            descriptor.type = second.value
        else:
            value = parameter_value_to_python(second) if isinstance(second, ParameterValue) else second
            if not descriptor.dynamic_typing:
                if value is None:
                    raise ValueError(
                        f"Cannot declare parameter {{{name}}} as statically typed without a value: give a default, "
                        "a type, or a descriptor with `dynamic_typing=True`"
                    )
                descriptor.type = Kind.from_parameter_value(value).value
        return name, value, descriptor

    def undeclare(self, name: str) -> None:
        with self.lock:
            if name not in self.values:
                raise self._undeclared(name)
            if self.descriptors[name].read_only:
                raise ParameterImmutableException(name)
            former = {name: self.values.pop(name)}
            del self.descriptors[name]
        self._on_change([Parameter(name, Kind.NOT_SET, None)], former)

    # getting

    def get(self, name: str) -> Parameter:
        with self.lock:
            found = self.values.get(name)
            if found is None:
                if self.allows_undeclared:
                    return Parameter(name, Kind.NOT_SET, None)
                raise self._undeclared(name)
            if found.type_ is Kind.NOT_SET and not self.descriptors[name].dynamic_typing:
                raise ParameterUninitializedException(name)
            return found

    def with_prefix(self, prefix: str) -> dict[str, Parameter]:
        start = f"{prefix}{PARAMETER_SEPARATOR_STRING}" if prefix else ""
        with self.lock:
            return {n.removeprefix(start): p for n, p in self.values.items() if n.startswith(start)}

    def describe(self, name: str) -> ParameterDescriptor:
        from rcl_interfaces.msg import ParameterDescriptor

        if name in self.descriptors:
            return self.descriptors[name]
        if self.allows_undeclared:
            return ParameterDescriptor()
        raise self._undeclared(name)

    def listed(self, prefixes: Sequence[str], depth: int) -> ListParametersResult:
        from rcl_interfaces.msg import ListParametersResult

        if not isinstance(depth, int):
            raise TypeError(f"Expected int, got {type(depth)}")
        if isinstance(prefixes, str) or not all(isinstance(prefix, str) for prefix in prefixes):
            raise TypeError("Prefixes must be strings")
        if depth < 0:
            raise ValueError(f"Invalid depth {depth}: it must not be negative")
        names, found = [], set()
        with self.lock:
            known = list(self.values)
        for name in known:
            if not _is_listed(name, prefixes, depth):
                continue
            names.append(name)
            if PARAMETER_SEPARATOR_STRING in name:
                found.add(name.rpartition(PARAMETER_SEPARATOR_STRING)[0])
        return ListParametersResult(names=names, prefixes=sorted(found))

    # setting

    def refuse_undeclared(self, parameters: Iterable[Parameter]) -> None:
        missing = [p.name for p in parameters if p.name not in self.values]
        if missing and not self.allows_undeclared:
            raise self._undeclared(missing)

    def set_each(self, parameters: Sequence[Parameter]) -> list[SetParametersResult]:
        for parameter in parameters:
            _refuse_others(parameter)
        return [self.set_all([parameter]) for parameter in parameters]

    def set_all(self, parameters: Sequence[Parameter]) -> SetParametersResult:
        """Set all parameters or none."""
        from rcl_interfaces.msg import SetParametersResult

        for parameter in parameters:
            _refuse_others(parameter)
        self.refuse_undeclared(parameters)
        changed = list(parameters)
        # `before` hooks are not called at a declaration, in rclpy neither.
        for hook in list(self.before):
            changed = list(hook(changed))
            if not changed:
                reason = "parameter list cannot be empty, this might be due to pre_set_parameters_callback modifying "
                return SetParametersResult(successful=False, reason=f"{reason}the original parameters list.")
            self.refuse_undeclared(changed)
        return self._set(changed, {})

    def _set(
        self, parameters: list[Parameter], declared: Mapping[str, ParameterDescriptor], *, allows_not_set: bool = False
    ) -> SetParametersResult:
        result = self._verdict(parameters, declared, allows_not_set=allows_not_set)
        if result.successful:
            former = self._store(parameters, declared, allows_not_set=allows_not_set)
            self._on_change(parameters, former)
            for hook in list(self.after):
                hook(parameters)
        return result

    def _verdict(
        self, parameters: list[Parameter], declared: Mapping[str, ParameterDescriptor], *, allows_not_set: bool
    ) -> SetParametersResult:
        """Return whether parameters may be set, by their descriptors and by the node's callbacks."""
        from rcl_interfaces.msg import SetParametersResult

        for parameter in parameters:
            descriptor = declared.get(parameter.name) or self.descriptors.get(parameter.name)
            if descriptor is None:  # an undeclared one, which may be of any type
                continue
            reason = _fault(parameter, descriptor, is_new=parameter.name in declared, allows_not_set=allows_not_set)
            if reason:
                return SetParametersResult(successful=False, reason=reason)
        for check in list(self.checks):
            result = check(parameters)
            if not hasattr(result, "successful"):
                raise AttributeError(must_return(check, RESULT, result))
            if not result.successful:
                return SetParametersResult(successful=result.successful, reason=result.reason)
        return SetParametersResult(successful=True)

    def _store(
        self, parameters: list[Parameter], declared: Mapping[str, ParameterDescriptor], *, allows_not_set: bool
    ) -> dict[str, Parameter]:
        """Store parameters, or remove those that are not set; return their former values."""
        from rcl_interfaces.msg import ParameterDescriptor

        former: dict[str, Parameter] = {}
        with self.lock:
            for parameter in parameters:
                name = parameter.name
                if name in self.values:
                    former[name] = self.values[name]
                if parameter.type_ is Kind.NOT_SET and not allows_not_set:
                    self.values.pop(name, None)
                    self.descriptors.pop(name, None)
                    continue
                if name not in self.descriptors:
                    self.descriptors[name] = declared.get(name) or ParameterDescriptor(name=name, dynamic_typing=True)
                if self.descriptors[name].dynamic_typing:
                    self.descriptors[name].type = parameter.type_.value
                self.values[name] = parameter
        return former

    def set_descriptor(self, name: str, descriptor: ParameterDescriptor, alternative: object) -> object:
        """Change a parameter's descriptor, and its value to `alternative` if given."""
        if name not in self.values:
            if not self.allows_undeclared:
                raise self._undeclared(name)
            return self.get(name).get_parameter_value()
        current = self.values[name]
        if self.descriptors[name].read_only:
            raise ParameterImmutableException(name)
        if descriptor.dynamic_typing or descriptor.type == 0:
            descriptor.type = current.type_.value
        wanted = current
        if alternative is not None:
            from rcl_interfaces.msg import Parameter as ParameterMessage

            wanted = Parameter.from_parameter_msg(ParameterMessage(name=name, value=alternative))
        reason = _fault(wanted, descriptor, is_new=True)
        if reason:
            if reason.startswith("Wrong parameter type"):
                raise InvalidParameterTypeException(wanted, Kind(descriptor.type))
            raise InvalidParameterValueException(name, wanted.value, reason)
        descriptor.name = name
        self.descriptors[name] = descriptor
        self.values[name] = wanted
        return self.get(name).get_parameter_value()


def _refuse_others(parameter: object) -> None:
    if not isinstance(parameter, Parameter):
        raise TypeError(f"parameter must be instance of type '{Parameter!r}'")


def _is_empty(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and not value


def _is_listed(name: str, prefixes: Sequence[str], depth: int) -> bool:
    for prefix in prefixes or [""]:
        start = f"{prefix}{PARAMETER_SEPARATOR_STRING}" if prefix else ""
        if name == prefix or name.startswith(start):
            rest = name.removeprefix(start) if name != prefix else ""
            if not depth or rest.count(PARAMETER_SEPARATOR_STRING) < depth:
                return True
    return False


def _fault(parameter: Parameter, descriptor: ParameterDescriptor, *, is_new: bool, allows_not_set: bool = False) -> str:
    """Describe the mismatch of a value and its descriptor; empty if there is none."""
    name = parameter.name
    if descriptor.read_only and not is_new:
        return f"Trying to set a read-only parameter: {name}."
    if parameter.type_ is Kind.NOT_SET:
        return "" if descriptor.dynamic_typing or allows_not_set else "Static parameter cannot be undeclared"
    if not descriptor.dynamic_typing and descriptor.type != parameter.type_.value:
        return f"Wrong parameter type, expected '{Kind(descriptor.type)}' got '{parameter.type_}'"
    if parameter.type_ is Kind.INTEGER and descriptor.integer_range:
        return _integer_fault(parameter, descriptor.integer_range[0])
    if parameter.type_ is Kind.DOUBLE and descriptor.floating_point_range:
        return _double_fault(parameter, descriptor.floating_point_range[0])
    return ""


def _out_of_range(parameter: Parameter, bounds: IntegerRange | FloatingPointRange) -> str:
    return (
        f"Parameter {parameter.name} out of range. Min: {bounds.from_value}, Max: {bounds.to_value}, "
        f"value: {parameter.value}"
    )


def _integer_fault(parameter: Parameter, bounds: IntegerRange) -> str:
    low, high = sorted((bounds.from_value, bounds.to_value))
    # `to_value` is legal even if no step leads to it (rcl_interfaces/msg/IntegerRange).
    if parameter.value in (bounds.from_value, bounds.to_value):
        return ""
    if not low <= parameter.value <= high:
        return _out_of_range(parameter, bounds)
    if bounds.step and (parameter.value - bounds.from_value) % bounds.step:
        return (
            f"The parameter value for {parameter.name} is not a valid step. Min: {bounds.from_value}, "
            f"max: {bounds.to_value}, value: {parameter.value}, step: {bounds.step}"
        )
    return ""


def _double_fault(parameter: Parameter, bounds: FloatingPointRange) -> str:
    def same(a: float, b: float) -> bool:
        return math.isclose(a, b, rel_tol=RELATIVE_TOLERANCE)

    value = parameter.value
    # As for integers, and with a tolerance: 0.1 + 0.2 is not 0.3.
    if same(value, bounds.from_value) or same(value, bounds.to_value):
        return ""
    low, high = sorted((bounds.from_value, bounds.to_value))
    if not low <= value <= high:
        return _out_of_range(parameter, bounds)
    if bounds.step > 0.0:
        distance = math.fabs((value - bounds.from_value) / bounds.step)
        if not same(distance, round(distance)):
            return (
                f"The parameter value for {parameter.name} is not close enough to a valid step. "
                f"Min: {bounds.from_value}, max: {bounds.to_value}, value: {value}, step: {bounds.step}"
            )
    return ""
