"""Launch files of ROS 1's, as students find them."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.errors import GraphFileError, Place
from graphflow.launchfiles import conversion
from graphflow.markup import ros1_words, xml_source


def told(text: str, folder: Path) -> list[str]:
    """What is said of a launch file in XML, without the place's file."""
    file = folder / "a.launch.xml"
    file.write_text(f"<launch>{text}</launch>")
    found: list[str] = []

    def complain(place: Place, message: str) -> None:
        found.append(f"{place.line}:{place.column}: {message}")

    try:
        conversion.native(xml_source.read_file(file, "a"), folder, complain)
    except GraphFileError as error:
        found += [str(problem).removeprefix("a:") for problem in error.problems]
    return found


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ('<rosparam file="a.yaml"/>', '1:9: <rosparam> is ROS 1\'s: write <param from="FILE.yaml"/> in the node'),
        ("<rosparam>rate: 1</rosparam>", '1:9: <rosparam> is ROS 1\'s: write <param from="FILE.yaml"/> in the node'),
        (
            '<param name="a" value="1"/>',
            "1:9: <param> is ROS 1's: write it in the node, "
            'or <set_parameter name="..." value="..."/> before all nodes',
        ),
        ('<machine name="a"/>', "1:9: <machine> is ROS 1's: all nodes of a graph run on one machine"),
        (
            '<group ns="a"/>',
            "1:9: group: unknown attribute 'ns'; write <push_ros_namespace namespace=\"a\"/> as its first element",
        ),
        (
            '<arg name="a" value="1"/>',
            "1:9: arg: unknown attribute 'value'; write default= for one that can be given, and <let .../> in place of "
            "<arg .../> for one that cannot",
        ),
        (
            '<include file="a" pass_all_args="true"/>',
            "1:9: include: unknown attribute 'pass_all_args'; leave it out, as an included file has all arguments",
        ),
    ],
)
def test_what_is_written_in_its_place(tmp_path: Path, text: str, problem: str) -> None:
    """One sentence with the place and the words of ROS 2."""
    assert told(text, tmp_path) == [problem]


@pytest.mark.parametrize(
    ("attribute", "way"),
    [
        ('required="true"', "node: unknown attribute 'required'; write on_exit=\"shutdown\""),
        ('type="talker"', "node: unknown attribute 'type'; it is called 'exec' here"),
    ],
)
def test_attributes_of_nodes(tmp_path: Path, attribute: str, way: str) -> None:
    """The same."""
    assert f"1:9: {way}" in told(f'<node pkg="demo_nodes_py" exec="talker" {attribute}/>', tmp_path)


def test_parameters_that_a_command_makes(tmp_path: Path) -> None:
    """Told once."""
    node = '<node pkg="demo_nodes_py" exec="talker"><param name="a" command="xacro a.xacro"/></node>'
    assert told(node, tmp_path) == ["1:49: param: unknown attribute 'command'; write value=\"$(command '...')\""]


def test_what_both_have(tmp_path: Path) -> None:
    """It is left alone."""
    text = (
        '<arg name="a" default="1" description="b"/><group><push_ros_namespace namespace="a"/>'
        '<node pkg="demo_nodes_py" exec="talker" output="screen" name="a"><remap from="a" to="b"/>'
        '<param name="a" value="1"/><env name="A" value="1"/></node></group>'
    )
    assert told(text, tmp_path) == []


def test_substitutions() -> None:
    """Two have other names; a lone word is most often an argument's name."""
    assert ros1_words.substitution("arg rate") == "write $(var rate)"
    assert ros1_words.substitution("find turtlesim") == "write $(find-pkg-share turtlesim)"
    assert ros1_words.substitution("arg") == ros1_words.substitution("var rate") == ""


def test_many_attributes(tmp_path: Path) -> None:
    """They are listed, without those that the translation adds."""
    [problem] = told('<node pkg="demo_nodes_py" exec="talker" zzz="1"/>', tmp_path)
    assert problem.startswith(
        "1:9: node: unknown attribute 'zzz'; there is args, autostart, env, exec, if, launch-prefix, "
    )
    assert "number" not in problem


def test_no_words_of_its_own_are_offered(tmp_path: Path) -> None:
    """What the translation of a launch file in Python adds is no attribute that anyone writes."""
    [problem] = told('<include file="a" zzz="1"/>', tmp_path)
    assert problem == "1:9: include: unknown attribute 'zzz'; there is arg, file, if, let, unless"
