"""What rclpy raises."""

from __future__ import annotations

from rclpy import exceptions
from rclpy.parameter import Parameter


def test_a_wrong_name_is_shown_with_the_place() -> None:
    """Below it."""
    error = exceptions.InvalidTopicNameException("chat?er", "must not", 4)
    assert str(error) == "Invalid topic name: must not:\n  'chat?er'\n       ^"
    assert isinstance(error, exceptions.NameValidationException)


def test_parameters_are_named() -> None:
    """One, or all of several."""
    assert str(exceptions.ParameterNotDeclaredException("a")) == "Invalid access to undeclared parameter(s): 'a'"
    assert str(exceptions.ParameterAlreadyDeclaredException(["a", "b"])).endswith("declared: ['a', 'b']")
    wrong = exceptions.InvalidParameterTypeException(Parameter("a", value=1), Parameter.Type.STRING)
    assert "'a' to '1' of type 'INTEGER', expecting type 'STRING'" in str(wrong)
    assert "Reason: too much" in str(exceptions.InvalidParameterValueException("a", 1, "too much"))
    assert "read-only" in str(exceptions.ParameterImmutableException("a"))
    assert "not initialized" in str(exceptions.ParameterUninitializedException("a"))


def test_others_say_what_has_not_been_done() -> None:
    """And where."""
    assert str(exceptions.NotInitializedException("here")) == "rclpy.init() has not been called: here"
    assert "rclpy.shutdown()" in str(exceptions.ROSInterruptException())
