"""Faults of a `package.xml`."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.workspace.manifest import fault_of, leftovers, name_fault


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("<package><name>a</name></package>", None),
        ('<!DOCTYPE x [<!ENTITY a "b">]><package>', None),
        (
            "<package>\n<name>a</name>\n",
            ":3: no element found: ROS 2 does not build it; is </package> there at the end?",
        ),
        (
            "<package>\n<name>a</nam>\n</package>",
            ":2: <name> is not closed, and ROS 2 does not build it: write </name>",
        ),
        (
            "<package>\n<depend>a<depend>\n<depend>b</depend>\n</package>",
            ":2: <depend> is not closed, and ROS 2 does not build it: write </depend>",
        ),
        (
            "<package>\n<export>\n<build_type>a<build_type>\n</export>\n</package>",
            ":3: <build_type> is not closed, and ROS 2 does not build it: write </build_type>",
        ),
        ("<package>\n</packag>", ":1: <package> is not closed, and ROS 2 does not build it: write </package>"),
    ],
)
def test_what_is_no_xml(tmp_path: Path, text: str, fault: str | None) -> None:
    """Is told with its line."""
    file = tmp_path / "package.xml"
    file.write_text(text)
    assert fault_of(file) == (None if fault is None else f"{file}{fault}")


def test_a_file_that_cannot_be_read(tmp_path: Path) -> None:
    """Is told, too."""
    assert fault_of(tmp_path) is not None


@pytest.mark.parametrize(
    ("text", "called"),
    [
        ("package_name = 'lamp'\nsetup(name=package_name)", None),
        ("package_name = 'lump'\nsetup(\n    name=package_name)", (3, "lump")),
        ("setuptools.setup(name='lump')", (1, "lump")),
        ("setup(name=f'{x}')", None),
        ("setup(version='1')", None),
        ("setup(", None),
    ],
)
def test_another_name_in_setup_py(tmp_path: Path, text: str, called: tuple[int, str] | None) -> None:
    """Is told with its line."""
    assert name_fault(tmp_path, "lamp") is None
    file = tmp_path / "setup.py"
    file.write_text(text)
    told = called and f"{file}:{called[0]}: the package is called {called[1]!r} here, and 'lamp' in package.xml"
    assert name_fault(tmp_path, "lamp") == told


SETUP = """
from setuptools import setup

setup(
    name='lamp',
    packages=['lump'],
    data_files=[('share/ament_index/resource_index/packages', ['resource/' + package_name])],
)
"""


def test_names_left_from_a_copy(tmp_path: Path) -> None:
    """Each is told with its place, until it is the package's own."""
    (tmp_path / "setup.py").write_text(SETUP)
    (tmp_path / "setup.cfg").write_text(
        "[develop]\nscript_dir=$base/lib/lump\n[install]\ninstall_scripts=$base/lib/lamp\n"
    )
    (tmp_path / "resource").mkdir()
    (tmp_path / "resource" / "lump").touch()
    assert [*leftovers(tmp_path, "lamp")] == [
        f"{tmp_path}/setup.cfg:2: ROS 2 looks for the executables in lib/lamp: write $base/lib/lamp",
        f"{tmp_path}/setup.py installs resource/lamp, which is not there: touch {tmp_path}/resource/lamp",
        f"{tmp_path}/setup.py:6: there is no folder lump, which packages names: write lamp",
    ]
    (tmp_path / "setup.py").write_text(SETUP.replace("lump", "lamp"))
    (tmp_path / "setup.cfg").write_text("[develop]\nscript_dir=$base/lib/lamp\n")
    (tmp_path / "resource" / "lamp").touch()
    (tmp_path / "lamp").mkdir()
    assert [*leftovers(tmp_path, "lamp")] == []
    assert [*leftovers(tmp_path / "none", "lamp")] == []
    more = "packages=[package_name, package_name + '.parts'], data_files=[('share/lamp', ['resource/lamp.png'])]"
    (tmp_path / "resource" / "lamp").unlink()
    (tmp_path / "setup.py").write_text(f"setup(name='lamp', {more})\n")
    assert [*leftovers(tmp_path, "lamp")] == []
