"""The arguments of nodes."""

from __future__ import annotations

import pytest

from graphflow.rclpy.context_state import ContextState
from rclpy._rclpy_pybind11 import RCLInvalidROSArgsError, UnknownROSArgsError
from rclpy.exceptions import InvalidNamespaceException, InvalidNodeNameException
from rclpy.impl.node_arguments import read_arguments

GLOBAL = ["--ros-args", "-r", "a:=global", "-p", "x:=1", "-p", "y:=1"]
OWN = ["--ros-args", "-r", "a:=own", "-p", "x:=2", "--disable-rosout-logs"]


def test_own_arguments_have_precedence() -> None:
    """Of remaps the first counts, of values the last."""
    given = read_arguments(ContextState(GLOBAL, 0), "n", "ns", OWN, use_global=True)
    assert given.namespace == "/ns"
    assert [rule.replacement for rule in given.remaps] == ["own", "global"]
    assert {name: value for name, (value, _) in given.values.items()} == {"x": 2, "y": 1}
    assert not given.has_rosout


def test_the_programs_arguments_are_left_out_if_so_asked() -> None:
    """But for its logs, which all nodes publish or none."""
    given = read_arguments(ContextState(GLOBAL, 0), "n", None, [], use_global=False)
    assert given == ("/", [], {}, True)
    quiet = ContextState(["--ros-args", "--disable-rosout-logs"], 0)
    assert not read_arguments(quiet, "n", None, [], use_global=False).has_rosout


@pytest.mark.parametrize(
    ("name", "namespace", "cli_args", "error"),
    [
        ("n", None, ["--ros-args", "-r", "::"], RCLInvalidROSArgsError),
        ("n", None, ["--ros-args", "--nonsense"], (RCLInvalidROSArgsError, UnknownROSArgsError)),
        ("n", None, ["--ros-args", "-r", "__ns:=turtle1"], RCLInvalidROSArgsError),
        ("n/m", None, [], InvalidNodeNameException),
        ("n", "a b", [], InvalidNamespaceException),
    ],
)
def test_wrong_arguments(
    name: str, namespace: str | None, cli_args: list[str], error: type[Exception] | tuple[type[Exception], ...]
) -> None:
    """Each with rclpy's error."""
    with pytest.raises(error):
        read_arguments(ContextState([], 0), name, namespace, cli_args, use_global=True)
