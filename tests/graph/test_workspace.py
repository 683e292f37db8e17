"""Workspaces that nobody has built."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from graphflow.graph.executables import package_folder
from graphflow.graph.share import share_folder
from graphflow.graph.workspace import EntryPoint, find_workspace, uses_ros


def package(folder: Path, name: str, **files: str) -> Path:
    """A package with files; `__` in their names stands for a slash, and `_dot_` for a dot."""
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text(f"<package><name>{name}</name></package>")
    for path, text in files.items():
        file = folder / path.replace("__", "/").replace("_dot_", ".")
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    return folder


SETUP = """
from setuptools import setup
package_name = 'my_robot'
run_this = open('/never').read()
setup(
    name=package_name,
    entry_points={'console_scripts': [
        'talker = my_robot.talker:main',
        f'listener = {package_name}.listener:main',
        'third = ' + package_name + '.third:Node.main',
        'not one',
    ]},
)
"""
CMAKE = """
install(PROGRAMS
  scripts/drive.py   # install(PROGRAMS scripts/never.py DESTINATION lib/x)
  "${CMAKE_CURRENT_SOURCE_DIR}/tools/look"
  DESTINATION lib/${PROJECT_NAME})
install(PROGRAMS tools/other.py DESTINATION lib/${PROJECT_NAME} RENAME renamed)
install(PROGRAMS tools/shared.py DESTINATION share/${PROJECT_NAME})
install(FILES tools/missing.py DESTINATION lib/x)
"""


def test_executables_are_read_from_setup_py_and_setup_cfg(tmp_path: Path) -> None:
    """Without running anything."""
    cfg = "[options.entry_points]\nconsole_scripts =\n    extra = my_robot.extra:main\n"
    package(
        tmp_path / "ws/src/my_robot", "my_robot", setup_dot_py=SETUP, setup_dot_cfg=cfg, my_robot____init___dot_py=""
    )
    workspace = find_workspace(tmp_path / "ws")
    found = workspace.packages["my_robot"]
    assert found.entry_points == {
        "talker": EntryPoint("my_robot.talker", "main"),
        "listener": EntryPoint("my_robot.listener", "main"),
        "third": EntryPoint("my_robot.third", "Node.main"),
        "extra": EntryPoint("my_robot.extra", "main"),
    }
    assert found.executables == ["extra", "listener", "talker", "third"]


def test_programs_are_those_that_cmake_installs_and_scripts(tmp_path: Path) -> None:
    """Below `lib`, under their names there."""
    files = dict.fromkeys(("scripts__drive_dot_py", "scripts__more", "tools__look", "tools__other_dot_py"), "")
    package(tmp_path / "ws/src/arm", "arm", CMakeLists_dot_txt=CMAKE, tools__shared_dot_py="", **files)
    assert find_workspace(tmp_path / "ws").packages["arm"].executables == ["drive.py", "look", "more", "renamed"]


def test_an_executable_has_a_place_in_the_project(tmp_path: Path) -> None:
    """As `graphflow pkg executables` tells it; programs are known with or without their ending."""
    folder = package(tmp_path / "src" / "p", "my_robot", setup_dot_py=SETUP, scripts__drive_dot_py="")
    found = find_workspace(folder).packages["my_robot"]
    assert found.path_of("talker", tmp_path) == "src.p.my_robot.talker:main"
    assert found.path_of("drive.py", tmp_path) == "src.p.scripts.drive"
    assert [found.known_as(name) for name in ("talker", "drive", "dive")] == ["talker", "drive.py", None]


@pytest.mark.parametrize("inside", ["", "src", "src/group/arm", "src/group/arm/arm/node.py", "build"])
def test_a_workspace_is_found_from_anywhere_in_it(tmp_path: Path, inside: str) -> None:
    """What colcon has made is no part of it, and neither is what is marked so."""
    package(tmp_path / "ws/src/group/arm", "arm", arm____init___dot_py="", arm__node_dot_py="")
    package(tmp_path / "ws/src/arm_interfaces", "arm_interfaces", msg__Grip_dot_msg="bool closed\n")
    package(tmp_path / "ws/build/old", "old")
    package(tmp_path / "ws/src/ignored/one", "one")
    (tmp_path / "ws/src/ignored/COLCON_IGNORE").touch()
    workspace = find_workspace(tmp_path / "ws" / inside)
    assert workspace.root == tmp_path / "ws"
    assert set(workspace.packages) == {"arm", "arm_interfaces"}
    assert workspace.interfaces == {"arm_interfaces": tmp_path / "ws/src/arm_interfaces"}


def test_modules_that_cmake_installs_are_imported_from_their_package(tmp_path: Path) -> None:
    """By whatever name; and where nobody installs any, from nowhere."""
    cmake = "# ament_python_install_package(never)\nament_python_install_package(python_lib)"
    one = package(tmp_path / "src" / "one", "one", CMakeLists_dot_txt=cmake, python_lib__a_dot_py="")
    package(tmp_path / "src" / "two", "two", never__a_dot_py="")
    three = package(
        tmp_path / "src" / "three",
        "three",
        CMakeLists_dot_txt="ament_python_install_package(${PROJECT_NAME})",
        three__a_dot_py="",
    )
    assert set(find_workspace(tmp_path).import_roots) == {one, three}


def test_a_shell_may_stand_where_there_are_more_folders_than_are_looked_into(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The nearest are."""
    monkeypatch.setattr("graphflow.graph.workspace.FOLDERS_BOUND", 4)
    for name in "abcdef":
        (tmp_path / name / "deep").mkdir(parents=True)
    package(tmp_path / "a" / "near", "near")
    package(tmp_path / "f" / "far", "far")
    assert set(find_workspace(tmp_path).packages) == set()
    monkeypatch.setattr("graphflow.graph.workspace.FOLDERS_BOUND", 9)
    assert set(find_workspace(tmp_path).packages) == {"near"}


def test_packages_side_by_side_are_a_workspace_too(tmp_path: Path) -> None:
    """As in a repository; where nothing is, there is none."""
    for name in ("one", "two"):
        package(tmp_path / "repo" / name, name)
    assert set(find_workspace(tmp_path / "repo" / "one").packages) == {"one", "two"}
    assert set(find_workspace(tmp_path / "repo").packages) == {"one", "two"}
    (tmp_path / "empty").mkdir()
    assert not find_workspace(tmp_path / "empty").packages


@pytest.mark.parametrize(
    ("text", "verdict"),
    [
        ("import rclpy", True),
        ("import os, rclpy.node as n", True),
        ("def f():\n    from rclpy.node import Node", True),
        ("from graphflow import Node", False),
        ("from .rclpy import x", False),
        ("'import rclpy'", False),
        ("import (", False),
    ],
)
def test_files_that_use_rclpy_are_told_from_others(tmp_path: Path, text: str, verdict: bool) -> None:
    """By their imports."""
    (tmp_path / "a.py").write_text(text)
    assert uses_ros(tmp_path / "a.py") is verdict


def test_other_entry_points_are_no_executables(tmp_path: Path) -> None:
    """Those of extensions look the same. A list of `console_scripts` may stand elsewhere in the file."""
    groups = "{'ros2cli.command': ['x = a.x:X'], 'console_scripts': ['go = ' + 'a.go:main']}"
    folder = package(tmp_path / "a", "a", setup_dot_py=f"setup(entry_points={groups})")
    assert find_workspace(folder).packages["a"].executables == ["go"]
    (folder / "setup.py").write_text("setup(entry_points={'ros2cli.command': ['x = a.x:X']})")
    assert find_workspace(folder).packages["a"].executables == []
    (folder / "setup.py").write_text("s = ['go = a.go:main']\nsetup(entry_points={'console_scripts': s})")
    assert find_workspace(folder).packages["a"].executables == ["go"]


def test_a_module_beside_setup_py(tmp_path: Path) -> None:
    """It is imported from the package's folder, in which there is no other."""
    groups = "{'console_scripts': ['teleop = teleop:main']}"
    folder = package(tmp_path / "teleop", "teleop", setup_dot_py=f"setup(py_modules=['teleop'], entry_points={groups})")
    assert find_workspace(folder).import_roots == []
    (folder / "teleop.py").touch()
    assert find_workspace(folder).import_roots == [folder]


def test_modules_that_cmake_installs_from_elsewhere(tmp_path: Path) -> None:
    """They are imported from the folder that theirs lies in."""
    cmake = "ament_python_install_package(${PROJECT_NAME} PACKAGE_DIR src/${PROJECT_NAME})"
    folder = package(tmp_path / "a", "filters", CMakeLists_dot_txt=cmake)
    (folder / "src" / "filters").mkdir(parents=True)
    (folder / "src" / "filters" / "__init__.py").touch()
    assert find_workspace(folder).import_roots == [folder / "src"]


def test_modules_below_a_folder_of_their_own(tmp_path: Path) -> None:
    """As `setup.py` says."""
    setup = "src = 'src'\nsetup(package_dir={'': src}, entry_points={'console_scripts': ['go = a_lib.go:main']})"
    folder = package(tmp_path / "a", "a", setup_dot_py=setup, src__a_lib__go_dot_py="")
    found = find_workspace(folder).packages["a"]
    assert found.file_of(found.entry_points["go"]) == folder / "src" / "a_lib" / "go.py"
    assert (found.faults, found.import_roots) == ([], [folder / "src"])


def test_variables_of_cmake(tmp_path: Path) -> None:
    """Those that plainly stand for something, and those that are always there."""
    cmake = """
        project(arm)
        set(EXE "${PROJECT_NAME}_node")
        set(SCRIPTS ${PROJECT_NAME}/one.py ${PROJECT_SOURCE_DIR}/tools/two.py)
        add_executable(${EXE} main.cpp)
        install(PROGRAMS ${SCRIPTS} ${UNKNOWN}/three.py DESTINATION lib/${PROJECT_NAME})
    """
    files = {"arm__one_dot_py": "", "tools__two_dot_py": ""}
    package(tmp_path / "arm", "arm", CMakeLists_dot_txt=cmake, **files)
    found = find_workspace(tmp_path).packages["arm"]
    assert (found.executables, found.compiled) == (["one.py", "two.py"], {"arm_node"})


def test_two_packages_of_one_name(tmp_path: Path) -> None:
    """The first that is met counts, and the other is known."""
    first, second = package(tmp_path / "a" / "x", "lamp"), package(tmp_path / "b" / "x", "lamp")
    found = find_workspace(tmp_path)
    assert found.packages["lamp"].folder == first
    assert [double.folder for double in found.doubles] == [second]


def test_packages_beside_the_ones_around_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """They are found from the folder that the shell is in."""
    package(tmp_path / "repo" / "interfaces", "interfaces")
    deep = package(tmp_path / "repo" / "part" / "demo", "demo")
    assert set(find_workspace(deep).packages) == {"demo"}
    monkeypatch.chdir(tmp_path / "repo")
    assert set(find_workspace(deep).packages) == {"demo", "interfaces"}


def test_names_that_setup_py_computes(tmp_path: Path) -> None:
    """Are not known, since it is only read; that is told, and what stands there plainly is known."""
    made = "entry_points={'console_scripts': [f'{n} = a.{n}:main' for n in names] + ['plain = a.plain:main']}"
    folder = package(tmp_path / "a", "a", setup_dot_py=f"names = ['x']\nsetup({made})\n", a__plain_dot_py="")
    [found] = find_workspace(tmp_path).packages.values()
    assert found.executables == ["plain"]
    [fault] = found.faults
    assert fault.startswith(f"{folder / 'setup.py'}: it computes some executables")


def test_definitions_in_folders_of_their_own(tmp_path: Path) -> None:
    """A package that sorts its messages into folders has interfaces all the same."""
    package(tmp_path / "a", "a", msg__inner__Ball_dot_msg="int32 x\n")
    assert list(find_workspace(tmp_path).interfaces) == ["a"]


@pytest.mark.timeout(20)
@pytest.mark.parametrize("name", ["package.xml", "setup.py", "setup.cfg", "CMakeLists.txt", "lamp/blink.py"])
def test_files_that_are_none(tmp_path: Path, name: str) -> None:
    """A FIFO, or a device without an end, in the place of a file is as one that cannot be read; nobody waits for it."""
    for kind in ("fifo", "device"):
        root = tmp_path / kind
        lamp = package(root / "src" / "lamp", "lamp", setup_dot_py=SETUP, lamp__blink_dot_py="import rclpy")
        package(root / "src" / "other", "other")
        (lamp / name).unlink(missing_ok=True)
        if kind == "fifo":
            os.mkfifo(lamp / name)
        else:
            (lamp / name).symlink_to("/dev/zero")
        found = find_workspace(root)
        assert set(found.packages) == ({"other"} if name == "package.xml" else {"lamp", "other"})
        for one in found.packages.values():
            assert set(one.executables) <= {"talker", "listener", "third"}
            assert (one.faults, one.import_roots, one.compiled) is not None
            assert share_folder(one)
        assert package_folder("other", root) == root / "src" / "other"
        assert not uses_ros(lamp / name)
