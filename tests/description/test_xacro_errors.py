"""Errors of xacro at the lines that they are about."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from graphflow.description import read_robot
from graphflow.errors import GraphFileError

pytest.importorskip("xacro")
HEAD = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">\n'
WHEEL = '<xacro:macro name="wheel" params="side r:=1"><link name="${side}"/></xacro:macro>\n'


@pytest.mark.parametrize(
    ("body", "place", "text"),
    [
        ('<xacro:property name="size" value="1"/>\n<link name="${szie}"/>', "3:13", "no property 'szie'; did you mean"),
        (f'{WHEEL}<xacro:wheel sid="left"/>', "3:1", "'wheel' has no parameter 'sid'; did you mean 'side'?"),
        (f'{WHEEL}<xacro:wheel side="a"/>\n<xacro:wheel r="2"/>', "4:1", "'wheel' needs side, which is not given"),
        (f'{WHEEL}<xacro:whel side="left"/>', "3:1", "there is no macro 'whel'; did you mean 'wheel'?"),
        ('<link name="$(arg foo)"/>', "2:13", 'no argument \'foo\': declare <xacro:arg name="foo" default="..."/>'),
        ('<link name="a${1/0}"/>', "2:14", "the expression '1/0' fails: division by zero"),
        ('<xacro:include filename="nope.xacro"/>', "2:16", "there is no file "),
        ('<xacro:include filename="$(find nopkg)/x.xacro"/>', "2:26", "there is no package 'nopkg' in this workspace"),
        ('<xacro:if value="maybe"><link name="a"/></xacro:if>', "2:18", "which is not a boolean expression"),
        ('<xacro:property name="2x" value="1"/>', "2:23", "Property names must be valid python identifiers: 2x"),
        ("<link name='a'>", "3:3", "not valid XML: mismatched tag"),
    ],
)
def test_places(tmp_path: Path, body: str, place: str, text: str) -> None:
    """The place is that of the expression, macro or file, though xacro knows no lines."""
    file = tmp_path / "r.xacro"
    file.write_text(f"{HEAD}{body}\n</robot>")
    with pytest.raises(GraphFileError, match=re.escape(text)) as caught:
        read_robot(file)
    assert str(caught.value.problems[0].place) == f"{file}:{place}"


def test_included_files(tmp_path: Path) -> None:
    """A mistake in an included file has that file's place; one without the namespace is told what to write."""
    outer, inner = tmp_path / "outer.xacro", tmp_path / "inner.xacro"
    outer.write_text(f'{HEAD}<xacro:include filename="inner.xacro"/>\n</robot>')
    inner.write_text(f'{HEAD}\n<link name="${{nme}}"/>\n</robot>')
    with pytest.raises(GraphFileError, match=rf"^{inner}:3:13: there is no property 'nme'$"):
        read_robot(outer)
    inner.write_text('<robot>\n<xacro:property name="a" value="1"/>\n</robot>')
    with pytest.raises(
        GraphFileError, match=rf"^{inner}:2:1: not valid XML: unbound prefix: write <robot xmlns:xacro="
    ):
        read_robot(outer)
