"""Parameters, and the conversion of their values to and from messages."""

from __future__ import annotations

import array
from collections.abc import Iterable, Sequence
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic

from graphflow.errors import GraphflowError
from graphflow.graph import params_file
from graphflow.markup.source import parse_value
from rclpy.impl.mistakes.value_fields import FIELDS, check
from rclpy.impl.reexports import passed_on

if TYPE_CHECKING:
    from rcl_interfaces.msg import Parameter as ParameterMessage
    from rcl_interfaces.msg import ParameterValue

if TYPE_CHECKING:
    from typing_extensions import TypeVar

    T = TypeVar("T", default=Any)  # as in ROS 2; at run time, Python 3.11 knows no defaults
else:
    from typing import TypeVar

    T = TypeVar("T")

PARAMETER_SEPARATOR_STRING = "."
AllowableParameterValue = Any

_ARRAYS = {bool: "BOOL_ARRAY", int: "INTEGER_ARRAY", float: "DOUBLE_ARRAY", str: "STRING_ARRAY", bytes: "BYTE_ARRAY"}
_CODES = {"b": "INTEGER_ARRAY", "q": "INTEGER_ARRAY", "i": "INTEGER_ARRAY", "l": "INTEGER_ARRAY", "d": "DOUBLE_ARRAY"}


class Parameter(Generic[T]):
    """A parameter: its name, type and value.

    Args:
        type_: None for the type of the value.

    Raises:
        TypeError: `type_` is not a parameter type.
        ValueError: The value is not of the type.
    """

    class Type(Enum):
        """The types, with the numbers of rcl_interfaces/msg/ParameterType."""

        NOT_SET = 0
        BOOL = 1
        INTEGER = 2
        DOUBLE = 3
        STRING = 4
        BYTE_ARRAY = 5
        BOOL_ARRAY = 6
        INTEGER_ARRAY = 7
        DOUBLE_ARRAY = 8
        STRING_ARRAY = 9

        @classmethod
        def from_parameter_value(cls, parameter_value: object) -> Parameter.Type:
            """Return the type of a value. Raises TypeError for a value that no parameter can have."""
            if parameter_value is None:
                return cls.NOT_SET
            # bool first: True is an int, too.
            for kind, name in ((bool, "BOOL"), (int, "INTEGER"), (float, "DOUBLE"), (str, "STRING")):
                if isinstance(parameter_value, kind):
                    return cls[name]
            if isinstance(parameter_value, array.array):
                if parameter_value.typecode in _CODES:
                    return cls[_CODES[parameter_value.typecode]]
            elif isinstance(parameter_value, (list, tuple)):
                # As in rclpy, whose first test, that all elements are bytes, is true of an empty list.
                if not parameter_value:
                    return cls.BYTE_ARRAY
                for element, name in _ARRAYS.items():
                    if all(
                        isinstance(v, element) and (element is not int or not isinstance(v, bool))
                        for v in parameter_value
                    ):
                        return cls[name]
                raise TypeError(f"The given value is not a list of one of the allowed types '{parameter_value}'.")
            raise TypeError(f"The given value is not one of the allowed types '{parameter_value}'.")

        def check(self, parameter_value: object) -> bool:
            """Whether a value is of the type."""
            match self.name:
                case "NOT_SET":
                    return parameter_value is None
                case "BOOL":
                    return isinstance(parameter_value, bool)
                case "INTEGER":
                    return isinstance(parameter_value, int) and not isinstance(parameter_value, bool)
                case "DOUBLE":
                    return isinstance(parameter_value, float)
                case "STRING":
                    return isinstance(parameter_value, str)
            element = next(kind for kind, name in _ARRAYS.items() if name == self.name)
            if isinstance(parameter_value, array.array):
                return _CODES.get(parameter_value.typecode) == self.name
            if self.name == "INTEGER_ARRAY" and any(isinstance(v, bool) for v in _items(parameter_value)):
                return False
            return isinstance(parameter_value, (list, tuple)) and all(isinstance(v, element) for v in parameter_value)

    def __init__(self, name: str, type_: Type | None = None, value: Any = None) -> None:
        if type_ is None:
            type_ = Parameter.Type.from_parameter_value(value)
        if not isinstance(type_, Parameter.Type):
            raise TypeError(f"type must be an instance of '{Parameter.Type!r}'")
        if not type_.check(value):
            raise ValueError(f"Type '{type_}' and value '{value}' do not agree")
        self._name, self._type_, self._value = name, type_, value

    @classmethod
    def from_parameter_msg(cls, param_msg: ParameterMessage) -> Parameter:
        """Convert a message to a parameter."""
        type_ = Parameter.Type(value=param_msg.value.type)
        return cls(param_msg.name, type_, parameter_value_to_python(param_msg.value))

    @property
    def name(self) -> str:
        return self._name

    @property
    def type_(self) -> Type:
        return self._type_

    @property
    def value(self) -> Any:
        return self._value

    def __repr__(self) -> str:
        return f"Parameter(name={self._name!r}, type={self._type_}, value={self._value!r})"

    def get_parameter_value(self) -> ParameterValue:
        """Return the value as rcl_interfaces/msg/ParameterValue."""
        message = self._message()
        check(self, message)
        return message

    def _message(self) -> ParameterValue:
        from rcl_interfaces.msg import ParameterValue

        if self._type_ is Parameter.Type.NOT_SET:
            return ParameterValue()
        value = self._value
        if self._type_.value > 4:
            value = value if isinstance(value, array.array) else list(value)
        return ParameterValue(**{"type": self._type_.value, FIELDS[self._type_.value]: value})

    def to_parameter_msg(self) -> ParameterMessage:
        """Return the parameter as rcl_interfaces/msg/Parameter."""
        from rcl_interfaces.msg import Parameter as ParameterMessage

        return ParameterMessage(name=self.name, value=self.get_parameter_value())


def _items(value: Any) -> Iterable[object]:
    return value if isinstance(value, (list, tuple)) else ()


def get_parameter_value(string_value: str) -> ParameterValue:
    """Parse a text as YAML to a message."""
    try:
        value = parse_value(string_value)
    except GraphflowError:
        value = string_value
    if isinstance(value, list) and any(isinstance(v, float) for v in value):
        value = [float(v) if isinstance(v, int) and not isinstance(v, bool) else v for v in value]
    try:
        return Parameter("", None, value if value is not None else string_value).get_parameter_value()
    except TypeError:
        return Parameter("", None, string_value).get_parameter_value()


def parameter_value_to_python(parameter_value: ParameterValue) -> Any:
    """Return a message's value, arrays as lists. Raises RuntimeError for an unknown type."""
    if not 0 <= parameter_value.type < len(FIELDS):
        raise RuntimeError(f"unexpected parameter type {parameter_value.type}")
    if not parameter_value.type:
        return None
    value = getattr(parameter_value, FIELDS[parameter_value.type])
    return list(value) if parameter_value.type > 4 else value


def parameter_dict_from_yaml_file(
    parameter_file: str,
    use_wildcard: bool = False,
    target_nodes: Sequence[str] | None = None,
    namespace: str = "",
) -> dict[str, ParameterMessage]:
    """Return the parameters of a file as messages, by name.

    Args:
        use_wildcard: Whether to include sections for all nodes.
        target_nodes: The full names of the nodes; None for all.
        namespace: The prefix of the names.

    Raises:
        FileNotFoundError: There is no such file.
        RuntimeError: The file has no parameters for these nodes, or cannot be parsed.
    """
    if not Path(parameter_file).is_file():
        raise FileNotFoundError(f"there is no file {parameter_file}")
    try:
        sections = params_file.read(Path(parameter_file), str(parameter_file))
    except GraphflowError as error:
        raise RuntimeError(str(error)) from None
    wanted = None if target_nodes is None else {"/" + name.strip("/") for name in target_nodes}
    found: dict[str, Any] = {}
    names: set[str] = set()
    for section in sections:
        if not section.is_exact and use_wildcard:
            found |= {name: setting.value for name, setting in section.params.items()}
        elif section.is_exact and (wanted is None or section.pattern in wanted):
            names.add(section.pattern)
            found |= {name: setting.value for name, setting in section.params.items()}
    missing = (wanted or set()) - names
    if missing and not (use_wildcard and found):
        raise RuntimeError(
            f"Param file does not contain parameters for {', '.join(sorted(missing))},only for nodes: "
            f"{sorted(section.pattern for section in sections)}"
        )
    prefix = f"{namespace}{PARAMETER_SEPARATOR_STRING}" if namespace else ""
    return {prefix + name: Parameter(prefix + name, None, value).to_parameter_msg() for name, value in found.items()}


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)
