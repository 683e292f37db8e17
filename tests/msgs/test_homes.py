"""Modules of types that nothing imports."""

from __future__ import annotations

import pytest

from graphflow.msgs.homes import homes, imports
from tests.cases import slow


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("Twist", ["geometry_msgs.msg"]),
        ("Pose", ["geometry_msgs.msg", "turtlesim.msg"]),
        ("Trigger", ["std_srvs.srv"]),
        ("Fibonacci", ["example_interfaces.action"]),
        ("Nothing", []),
    ],
)
def test_where_a_type_is(name: str, found: list[str]) -> None:
    """Common packages come first."""
    assert homes(name)[: len(found) or None] == found


@slow
def test_lines_that_import_one() -> None:
    """Of several packages, two are named."""
    assert imports("Twist") == "from geometry_msgs.msg import Twist"
    assert imports("Pose", "graphflow.msgs.") == (
        "from graphflow.msgs.geometry_msgs.msg import Pose or from graphflow.msgs.turtlesim.msg import Pose"
    )
    assert imports("Nothing") == ""
