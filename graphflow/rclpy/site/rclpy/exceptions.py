"""rclpy's exceptions."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from graphflow.rclpy.hints import tracebacks
from rclpy._rclpy_pybind11 import InvalidHandle

if TYPE_CHECKING:
    from rclpy.parameter import Parameter

__all__ = [
    "InvalidHandle",
    "InvalidNamespaceException",
    "InvalidNodeNameException",
    "InvalidParameterException",
    "InvalidParameterTypeException",
    "InvalidParameterValueException",
    "InvalidServiceNameException",
    "InvalidTopicNameException",
    "NameValidationException",
    "NoTypeSupportImportedException",
    "NotInitializedException",
    "ParameterAlreadyDeclaredException",
    "ParameterException",
    "ParameterImmutableException",
    "ParameterNotDeclaredException",
    "ParameterUninitializedException",
    "ROSInterruptException",
]


class NotInitializedException(Exception):
    """`rclpy.init` has not been called, or the context was shut down."""

    def __init__(self, message: str | None = None) -> None:
        tracebacks.install()  # as `rclpy.init` would have
        text = "rclpy.init() has not been called"
        super().__init__(f"{text}: {message}" if message is not None else text)


class NoTypeSupportImportedException(Exception):
    """A class has no type support."""

    def __init__(self) -> None:
        super().__init__("no type_support imported")


class NameValidationException(Exception):
    """A name is illegal.

    Attributes:
        invalid_index: The position in `name` at which the fault begins.
    """

    def __init__(self, name_type: str, name: str, error_msg: str, invalid_index: int) -> None:
        self.name_type, self.name, self.error_msg, self.invalid_index = name_type, name, error_msg, invalid_index
        pointer = " " * (len(f"  '{name[:invalid_index]}")) + "^"
        super().__init__(f"Invalid {name_type}: {error_msg}:\n  '{name}'\n{pointer}")


class InvalidNamespaceException(NameValidationException):
    """A namespace is illegal."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("namespace", name, error_msg, invalid_index)


class InvalidNodeNameException(NameValidationException):
    """A node's name is illegal."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("node name", name, error_msg, invalid_index)


class InvalidTopicNameException(NameValidationException):
    """A topic's name is illegal."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("topic name", name, error_msg, invalid_index)


class InvalidServiceNameException(NameValidationException):
    """A service's name is illegal."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("service name", name, error_msg, invalid_index)


class ParameterException(Exception):
    """An error about parameters.

    Args:
        parameters: The name of one parameter, or several.
    """

    def __init__(self, error_msg: str, parameters: str | Iterable[str], *args: object) -> None:
        shown = f"'{parameters}'" if isinstance(parameters, str) else str(list(parameters))
        super().__init__(f"{error_msg}: {shown}", *args)


class ParameterNotDeclaredException(ParameterException):
    """A parameter was not declared."""

    def __init__(self, parameters: str | Iterable[str], *args: object) -> None:
        super().__init__("Invalid access to undeclared parameter(s)", parameters, *args)


class ParameterAlreadyDeclaredException(ParameterException):
    """A parameter was declared twice."""

    def __init__(self, parameters: str | Iterable[str], *args: object) -> None:
        super().__init__("Parameter(s) already declared", parameters, *args)


class InvalidParameterException(ParameterException):
    """A parameter's name is illegal."""

    def __init__(self, parameter: str, *args: object) -> None:
        super().__init__("Invalid parameter name", parameter, *args)


class InvalidParameterTypeException(ParameterException):
    """A value's type differs from its parameter's."""

    def __init__(self, parameter: Parameter, expected_type: object, *args: object) -> None:
        name = getattr(expected_type, "name", expected_type)
        super().__init__(
            f"Trying to set parameter '{parameter.name}' to '{parameter.value}' of type '{parameter.type_.name}', "
            f"expecting type '{name}'",
            parameter.name,
            *args,
        )


class InvalidParameterValueException(ParameterException):
    """A value was rejected."""

    def __init__(self, parameter: str, value: object, reason: str, *args: object) -> None:
        super().__init__(
            f"Invalid parameter value ({value}) for parameter. Reason: {reason}"
            if reason
            else f"Invalid parameter value ({value}) for parameter",
            parameter,
            *args,
        )


class ParameterImmutableException(ParameterException):
    """A read-only parameter cannot be changed."""

    def __init__(self, parameter: str, *args: object) -> None:
        super().__init__("Attempted to modify read-only parameter", parameter, *args)


class ParameterUninitializedException(ParameterException):
    """A parameter was declared with only a type, and has no value yet."""

    def __init__(self, parameter: str, *args: object) -> None:
        super().__init__("The parameter is not initialized", parameter, *args)


class ROSInterruptException(Exception):
    """A wait was interrupted by a shutdown."""

    def __init__(self) -> None:
        super().__init__("rclpy.shutdown() has been called")
