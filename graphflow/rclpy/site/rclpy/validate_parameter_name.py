"""Whether a name will do for a parameter."""

from rclpy.exceptions import InvalidParameterException


def validate_parameter_name(name: str) -> bool:
    """Whether a name will do: True, or else InvalidParameterException is raised."""
    if not name:
        raise InvalidParameterException(name)
    return True
