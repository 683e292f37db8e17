"""Validation of parameter names."""

from rclpy.exceptions import InvalidParameterException


def validate_parameter_name(name: str) -> bool:
    """Return True for a legal name; raise InvalidParameterException otherwise."""
    if not name:
        raise InvalidParameterException(name)
    return True
