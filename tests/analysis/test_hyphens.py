"""Imports of names with a hyphen."""

from __future__ import annotations

import pytest

from graphflow.analysis.hyphens import hyphen_hint

WHY = "; Python imports no name with a hyphen: rename"


@pytest.mark.parametrize(
    ("line", "hint"),
    [
        ("from graphflow.msgs.my-msgs.msg import Foo", f"{WHY} my-msgs to my_msgs, here and as a folder"),
        ("    import my-pkg.a-b", f"{WHY} my-pkg to my_pkg, a-b to a_b, here and as a folder"),
        ("from my_msgs.msg import Foo", ""),
        ("from a import b - c", ""),
        ("x = import-export", ""),
        ("", ""),
    ],
)
def test_hints(line: str, hint: str) -> None:
    """Each such name has the one that Python could import."""
    assert hyphen_hint(line) == hint
