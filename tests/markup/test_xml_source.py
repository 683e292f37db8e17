"""Launch files in XML, read as the YAML dialect has them."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.errors import GraphFileError, Place
from graphflow.markup.xml_source import read_file

BOMB = '<!DOCTYPE launch [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;">]><launch><arg name="&b;"/></launch>'


def written(tmp_path: Path, text: str) -> Path:
    (tmp_path / "f.xml").write_text(text)
    return tmp_path / "f.xml"


def test_elements(tmp_path: Path) -> None:
    """What belongs to an action are its attributes, as lists; what is inside of groups and timers are actions."""
    text = """<launch>
  <group if="a">
    <node pkg="p" exec="e"><param name="x" value="1"/><param name="y" value="2"/><remap from="a" to="b"/></node>
    <timer period="1.0"><log message="hi"/></timer>
  </group>
</launch>"""
    top = read_file(written(tmp_path, text), "f.xml")
    node = {
        "pkg": "p",
        "exec": "e",
        "param": [{"name": "x", "value": 1}, {"name": "y", "value": 2}],
        "remap": [{"from": "a", "to": "b"}],
    }
    timer = {"period": "1.0", "children": [{"log": {"message": "hi"}}]}
    assert top.plain() == {"launch": [{"group": {"if": "a", "children": [{"node": node}, {"timer": timer}]}}]}
    group = top.entries["launch"].items[0].entries["group"]
    assert group.place == Place("f.xml", 2, 3)


@pytest.mark.parametrize(
    ("attributes", "value"),
    [
        ('value="1e3"', 1000.0),
        ('value="1e3" type="str"', "1e3"),
        ("value=\"'2'\"", "2"),
        (r'value="\'2\'"', r"\'2\'"),
        ('value="[1, 2]"', [1, 2]),
        ('value="1, 2" value-sep=", "', [1, 2]),
        ('value="1, 2" value-sep=", " type="list_of_str"', ["1", "2"]),
        ('value="$(var a): b"', "$(var a): b"),
        ("value=\"['$(var a)1', b]\"", ["$(var a)1", "b"]),
    ],
)
def test_values_of_parameters(tmp_path: Path, attributes: str, value: object) -> None:
    """They read as in YAML, unless their type is given; with `value-sep` they are lists."""
    top = read_file(written(tmp_path, f'<launch><node><param name="x" {attributes}/></node></launch>'), "f.xml")
    [param] = top.entries["launch"].items[0].entries["node"].entries["param"].items
    assert (param.entries["value"].plain(), "value-sep" in param.entries) == (value, False)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("<launch>", "f.xml:1:9: not valid XML: no element found"),
        ("", "f.xml:1:1: not valid XML: no element found"),
        ("<launch><a></b></launch>", "f.xml:1:14: not valid XML: mismatched tag; <a> of line 1 is not closed: end it"),
        (
            "<launch>\n<node pkg=a />\n</launch>",
            'not well-formed (invalid token); write quotes: pkg="a"',
        ),
        (
            "<launch>\n<node pkg=“a”/>\n</launch>",
            'not well-formed (invalid token); write the quotes of the keyboard: <node pkg="a"/>',
        ),
        ("<robot/>", "f.xml:1:1: a launch file's outermost element is <launch>, not <robot>"),
        ("<launch>\n hello</launch>", "'hello': text between elements means nothing; use an attribute"),
        (
            '<launch>\n<node pkg="a" exec="b">\n<param name="rate">5.0</param></node></launch>',
            'f.xml:3:1: <param> has no text inside: write <param name="rate" value="5.0"/>',
        ),
        ("<launch>" + "<group>" * 50, "nested more than 40 deep"),
        (BOMB, "<!DOCTYPE> is not used here; remove it"),
        ('<launch a="&undefined;"/>', "not valid XML: undefined entity"),
        ("x" * 1_000_001, "f.xml: cannot be read: it has more than 1,000,000 bytes"),
    ],
)
def test_what_is_refused(tmp_path: Path, text: str, said: str) -> None:
    """With its place; entities that grow are not even read."""
    with pytest.raises(GraphFileError) as caught:
        read_file(written(tmp_path, text), "f.xml")
    assert said in str(caught.value)


def test_no_file(tmp_path: Path) -> None:
    """It is said why it cannot be read."""
    with pytest.raises(GraphFileError, match=r"f.xml: cannot be read: No such file"):
        read_file(tmp_path / "f.xml", "f.xml")
