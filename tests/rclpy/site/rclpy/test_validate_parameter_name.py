"""Names of parameters."""

import pytest

from rclpy.exceptions import InvalidParameterException
from rclpy.validate_parameter_name import validate_parameter_name


def test_a_name_is_not_empty() -> None:
    """That is all there is to it."""
    assert validate_parameter_name("a.b/c")
    with pytest.raises(InvalidParameterException):
        validate_parameter_name("")
