"""The files of a new ROS 2 package."""

from __future__ import annotations

import ast
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from graphflow.cli.projects.ros_package import BUILD_TYPES, TEMPLATES, Description, known_licenses, license_text, parts
from graphflow.workspace.packages import read_workspace

NEW = Description(name="pkg", template="ament_python", maintainer_name="Ann O'Hara", maintainer_email="ann@example.org")


def described(template: str, **more: object) -> dict[str, str]:
    """The files of a package, by path."""
    values = {**NEW.__dict__, "template": template, **more}
    return {path: text for path, text in parts(Description(**values)) if text is not None}


@pytest.mark.parametrize("template", TEMPLATES)
def test_the_manifest(template: str) -> None:
    """The manifest is valid XML, whatever the settings contain."""
    text = described(template, description='a <b> & "c"', dependencies=("rclpy", "std_msgs"))["package.xml"]
    root = ElementTree.fromstring(text.partition("?>\n")[2].partition("?>\n")[2])
    assert root.get("format") == "3"
    assert [root.findtext(tag) for tag in ("name", "version", "description")] == ["pkg", "0.0.0", 'a <b> & "c"']
    assert root.findtext("maintainer") == "Ann O'Hara"
    assert [one.text for one in root.findall("depend")] == ["rclpy", "std_msgs"]
    assert root.findtext("export/build_type") == TEMPLATES[template]


def test_setup_py() -> None:
    """setup.py is valid Python, whatever the settings contain, and a workspace finds its executable."""
    text = described("ament_python", node_name="first", description='it\'s "this"')["setup.py"]
    keywords = {one.arg: one.value for one in ast.walk(ast.parse(text)) if isinstance(one, ast.keyword)}
    assert ast.literal_eval(keywords["description"]) == 'it\'s "this"'
    assert ast.literal_eval(keywords["maintainer"]) == "Ann O'Hara"
    assert ast.literal_eval(keywords["entry_points"]) == {"console_scripts": ["first = pkg.first:main"]}


@pytest.mark.parametrize("build_type", BUILD_TYPES)
@pytest.mark.parametrize("node", [None, "one"])
@pytest.mark.parametrize("library", [None, "two"])
def test_all_is_filled_in(tmp_path: Path, build_type: str, node: str | None, library: str | None) -> None:
    """No placeholder is left in any file, and the workspace finds the package."""
    files = described(build_type, node_name=node, library_name=library, dependencies=("a", "b"))
    for path, text in files.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text)
        assert not [word for word in ("@name", "@NAME", "@target", "@include", "@links", "@export") if word in text]
    found = read_workspace(tmp_path, tmp_path).packages["pkg"]
    assert found.faults == []
    assert (found.compiled, set(found.entry_points)) == (
        (set(), {node} - {None}) if build_type == "ament_python" else ({node} - {None}, set())
    )


def test_licenses() -> None:
    """Each has its text; what is not an identifier has none."""
    assert all(license_text(one) for one in known_licenses())
    assert license_text("../ros_package") is None
