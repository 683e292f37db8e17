"""Workspaces that nobody has built."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from graphflow.workspace import packages
from graphflow.workspace.executables import package_folder
from graphflow.workspace.package_share import share_folder
from graphflow.workspace.packages import find_workspace
from graphflow.workspace.setup_file import EntryPoint
from graphflow.workspace.source_kinds import uses_ros


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
    monkeypatch.setattr("graphflow.workspace.packages.FOLDERS_BOUND", 4)
    for name in "abcdef":
        (tmp_path / name / "deep").mkdir(parents=True)
    package(tmp_path / "a" / "near", "near")
    package(tmp_path / "f" / "far", "far")
    assert set(find_workspace(tmp_path).packages) == set()
    monkeypatch.setattr("graphflow.workspace.packages.FOLDERS_BOUND", 9)
    assert set(find_workspace(tmp_path).packages) == {"near"}


def test_packages_side_by_side_are_a_workspace_too(tmp_path: Path) -> None:
    """As in a repository; where nothing is, there is none."""
    for name in ("one", "two"):
        package(tmp_path / "repo" / name, name)
    assert set(find_workspace(tmp_path / "repo" / "one").packages) == {"one", "two"}
    assert set(find_workspace(tmp_path / "repo").packages) == {"one", "two"}
    (tmp_path / "empty").mkdir()
    assert not find_workspace(tmp_path / "empty").packages


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
    folder = package(tmp_path / "a", "a", setup_dot_py=setup, src__a_lib__go_dot_py="def main(): ...")
    found = find_workspace(folder).packages["a"]
    assert found.file_of(found.entry_points["go"]) == folder / "src" / "a_lib" / "go.py"
    assert (found.faults, found.import_roots) == ([], [folder / "src"])


@pytest.mark.parametrize(
    ("text", "executables", "told"),
    [
        ("[options.entry_points]\nconsole_scripts =\n  go = a.go:main\n", ["go"], None),
        (
            "[options.entry_points]\nconsole_scripts =\n  go = a.go:main\n  ho = a.go.main\n",
            ["go"],
            "setup.cfg:4: 'ho = a.go.main' names no function; write 'NAME = PACKAGE.MODULE:FUNCTION'",
        ),
        ("[metadata]\nname = a\noptions.entry_points]\n", [], "setup.cfg:3: it is neither [section] nor KEY = VALUE"),
        ("name = a\n", [], "setup.cfg:1: it is neither [section] nor KEY = VALUE, so the file has no exec"),
        ("[a]\n[a]\n", [], "setup.cfg: While reading from "),
    ],
)
def test_lines_of_setup_cfg(text: str, executables: list[str], told: str | None, tmp_path: Path) -> None:
    """Those that name no executable are told, as the lines that nobody can read are."""
    folder = package(tmp_path / "a", "a", setup_dot_cfg=text, a__go_dot_py="def main(): ...")
    found = find_workspace(folder).packages["a"]
    assert found.executables == executables
    assert found.faults == [] if told is None else found.faults[-1].startswith(f"{folder}/{told}")
    assert (told is None) == (found.why_no_executable == "")


@pytest.mark.parametrize(
    ("entry", "folders", "told"),
    [
        ("b.go:main", "", None),
        ("timeit:main", "", None),
        ("nowhere.go:main", "", "there is no {folder}/nowhere/go.py; did you mean a.go:main?"),
        ("a.go:main [camera]", "", None),
        ("a.other:main", "{'a': 'lib'}", "package_dir has a in lib, which cannot be run from source; call it a"),
        ("a.deep:main", "{'a': 'src/a'}", None),
    ],
)
def test_modules_that_are_elsewhere(entry: str, folders: str, told: str | None, tmp_path: Path) -> None:
    """Those of other packages, and of what is installed, are left to the import."""
    setup = f"setup(package_dir={folders or None}, entry_points={{'console_scripts': ['go = {entry}']}})"
    files = {"a__go_dot_py": "def main(): ...", "src__a__deep_dot_py": "def main(): ..."}
    folder = package(tmp_path / "a", "a", setup_dot_py=setup, **files)
    package(tmp_path / "b", "b")
    fault = find_workspace(tmp_path).packages["a"].fault_of("go")
    assert fault is None if told is None else fault is not None and fault.endswith(told.format(folder=folder))


def test_a_folder_that_was_not_renamed(tmp_path: Path) -> None:
    """It has the module under the package's former name."""
    setup = "setup(entry_points={'console_scripts': ['go = b.go:main']})"
    folder = package(tmp_path / "b", "b", setup_dot_py=setup, a__go_dot_py="def main(): ...")
    fault = find_workspace(tmp_path).packages["b"].fault_of("go")
    assert fault is not None
    assert fault.endswith(f"there is no folder {folder}/b; {folder}/a/go.py is there: rename its folder to b")


def test_a_module_that_another_entry_names(tmp_path: Path) -> None:
    """It is that one's, and not meant by an entry whose module is missing."""
    setup = "setup(entry_points={'console_scripts': ['arm = a.arm:main', 'art = a.art:main']})"
    package(tmp_path / "a", "a", setup_dot_py=setup, a__arm_dot_py="def main(): ...")
    fault = find_workspace(tmp_path).packages["a"].fault_of("art")
    assert fault is not None
    assert "did you mean" not in fault


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
    name = found.doubles[0].name
    assert found.way_to_double(name) == f"; to use {second} instead: cd {second}"
    assert found.way_to_double("another") == ""


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
    folder = package(
        tmp_path / "a", "a", setup_dot_py=f"names = ['x']\nsetup({made})\n", a__plain_dot_py="def main(): ..."
    )
    [found] = find_workspace(tmp_path).packages.values()
    assert found.executables == ["plain"]
    [fault] = found.faults
    assert fault.startswith(f"{folder / 'setup.py'}: it computes some executables")


def test_definitions_in_folders_of_other_names(tmp_path: Path) -> None:
    """Are told, as nothing reads them; folders of other files are not."""
    files = dict.fromkeys(("msgs__Light_dot_msg", "Srv__Get_dot_srv", "msg__Go_dot_action", "test__A_dot_msg"), "")
    folder = package(tmp_path / "ws/src/lamp", "lamp", **files)
    workspace = find_workspace(tmp_path / "ws")
    assert workspace.packages["lamp"].faults == [
        f"{folder}/msgs/Light.msg must be {folder}/msg/Light.msg",
        f"{folder}/Srv/Get.srv must be {folder}/srv/Get.srv",
        f"{folder}/msg/Go.action must be {folder}/action/Go.action",
    ]
    assert [*workspace.interfaces] == ["lamp"]


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


def test_a_folder_that_a_build_would_leave_out(tmp_path: Path) -> None:
    """`find_packages` sees no folder without `__init__.py`; a list of packages names it all the same."""
    groups = "entry_points={'console_scripts': ['go = a.inner.go:main']}"
    folder = package(tmp_path / "a", "a", setup_dot_py=f"setup(packages=find_packages(), {groups})")
    (folder / "a" / "inner").mkdir(parents=True)
    (folder / "a" / "inner" / "go.py").write_text("def main(): ...")
    outer, inner = find_workspace(tmp_path).packages["a"].faults
    assert outer.startswith(f"{folder / 'a'} has no __init__.py: find_packages() in {folder / 'setup.py'}:1 leaves")
    assert inner.endswith(f"make an empty one: touch {folder / 'a' / 'inner' / '__init__.py'}")
    (folder / "a" / "__init__.py").touch()
    (folder / "a" / "inner" / "__init__.py").touch()
    assert find_workspace(tmp_path).packages["a"].faults == []
    (folder / "a" / "__init__.py").unlink()
    (folder / "setup.py").write_text(f"setup(packages=['a', 'a.inner'], {groups})")
    assert find_workspace(tmp_path).packages["a"].faults == []


def test_a_package_without_setup_py(tmp_path: Path) -> None:
    """Has modules, and nothing that says which of them is run."""
    folder = package(
        tmp_path / "ws/src/lamp", "lamp", lamp__node_dot_py="", setup_dot_cfg="[develop]\nscript_dir = lib"
    )
    lamp = find_workspace(tmp_path / "ws").packages["lamp"]
    assert lamp.faults == [f"{folder} has no setup.py, whose console_scripts name the executables"]
    assert lamp.why_no_executable == f"; {lamp.faults[0]}"
    (folder / "CMakeLists.txt").touch()
    assert find_workspace(tmp_path / "ws").packages["lamp"].faults == []


def test_a_package_whose_setup_py_names_no_executable(tmp_path: Path) -> None:
    """The line to add is told, if a module has a main()."""
    folder = package(
        tmp_path / "ws/src/lamp",
        "lamp",
        lamp__node_dot_py="def main(): ...\n",
        setup_dot_py="setup(name='lamp', entry_points={'console_scripts': []})",
    )
    line = f"{folder / 'setup.py'} names no executable: add 'node = lamp.node:main', to its console_scripts"
    assert find_workspace(tmp_path / "ws").packages["lamp"].why_no_executable == f"; {line}"
    (folder / "setup.py").write_text("setup(name='lamp', entry_points={'console_scripts': names()})")
    assert find_workspace(tmp_path / "ws").packages["lamp"].why_no_executable == ""
    (folder / "setup.py").write_text("setup(name='lamp')")
    (folder / "lamp" / "node.py").write_text("class Lamp: ...\n")
    assert find_workspace(tmp_path / "ws").packages["lamp"].why_no_executable == ""


@pytest.mark.parametrize(
    ("entry", "told"),
    [
        ("lamp.node:main", ""),
        ("lamp.sub:main", ""),
        ("node:main", "there is no {}/node.py; did you mean lamp.node:main?"),
        ("lamp.ndoe:main", "there is no {}/lamp/ndoe.py; did you mean lamp.node:main?"),
        ("quite.other:main", "there is no {}/quite/other.py; write that module, or name another one there"),
        ("lamp.node:mian", "{}/lamp/node.py has no function 'mian'; did you mean 'main'?"),
        ("lamp.node:Lamp", "Lamp is a class: name a function that makes one and spins it, such as main"),
        ("lamp.native:Lamp", ""),
    ],
)
def test_entry_points_that_start_nothing(tmp_path: Path, entry: str, told: str) -> None:
    """Are told with what may be meant; classes are right where a module is graphflow's."""
    module = "import rclpy\nclass Lamp: ...\ndef main(): ...\n"
    native = "from graphflow import Node\nclass Lamp(Node): ...\n"
    setup = f"setup(entry_points={{'console_scripts': ['go = {entry}']}})"
    files = {"lamp__node_dot_py": module, "lamp__native_dot_py": native}
    folder = package(tmp_path / "ws/src/lamp", "lamp", setup_dot_py=setup, **files)
    (folder / "lamp" / "sub").mkdir()
    (folder / "lamp" / "sub" / "__init__.py").write_text(module)
    fault = find_workspace(tmp_path / "ws").packages["lamp"].fault_of("go")
    assert fault == (f"{folder}/setup.py:1: go is {entry}, and {told.format(folder)}" if told else None)


def test_a_module_that_is_one_folder_too_high(tmp_path: Path) -> None:
    """It is found, with the folder that it belongs in."""
    setup = "setup(entry_points={'console_scripts': ['go = lamp.drive:main']})"
    folder = package(tmp_path / "ws/src/lamp", "lamp", setup_dot_py=setup, lamp__node_dot_py="")
    (folder / "drive.py").touch()
    fault = find_workspace(tmp_path / "ws").packages["lamp"].fault_of("go")
    told = f"there is no {folder}/lamp/drive.py; {folder}/drive.py is one folder too high: move it into {folder}/lamp"
    assert fault is not None
    assert fault.endswith(told)


COPIED = "setup(entry_points={{'console_scripts': [\n{}\n]}})"


def copied(folder: Path, lines: list[str], **files: str) -> list[str]:
    """The faults of executables of a package `arm` whose lines may be copies."""
    for name in ("one", "two"):
        files.setdefault(f"arm__{name}_dot_py", "def main():\n    rclpy.init()\n")
    setup = COPIED.format("\n".join(f"'{line}'," for line in lines))
    package(folder, "arm", setup_dot_py=setup, arm____init___dot_py="", **files)
    return find_workspace(folder).packages["arm"].faults


def test_a_line_that_was_copied_and_has_the_function_of_another(tmp_path: Path) -> None:
    """Told with its line where a module has the name of the executable, and nothing starts it."""
    assert copied(tmp_path / "arm", ["one = arm.one:main", "two = arm.one:main"]) == [
        f"{tmp_path}/arm/setup.py:3: two starts arm.one:main, as one does, and arm/two.py has a main() that nothing "
        "starts; write two = arm.two:main"
    ]


@pytest.mark.parametrize(
    ("lines", "files"),
    [
        (["one = arm.one:main", "other = arm.one:main"], {}),
        (["one = arm.one:main", "two = arm.one:main", "three = arm.two:main"], {}),
        (["two = arm.one:main"], {}),
        (["one = arm.one:main", "two = arm.one:main"], {"arm__two_dot_py": "def other():\n    print()\n"}),
        (["one = arm.one:main", "two = arm.one:main"], {"arm__two_dot_py": "def main():\n    pass\n"}),
        (["one = arm.one:main", "two = arm.one:main"], {"arm__one_dot_py": "from arm.two import main\n"}),
        (
            ["one = arm.one:main", "two = arm.one:main"],
            {"arm__one_dot_py": "from . import two\ndef main(): two.main()"},
        ),
    ],
)
def test_lines_that_have_one_function_by_right(tmp_path: Path, lines: list[str], files: dict[str, str]) -> None:
    """An alias, a module that another starts or imports, and one that has nothing to start."""
    assert copied(tmp_path / "arm", lines, **files) == []


def test_too_many_packages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only so many are read: any folder may be taken for a workspace."""
    monkeypatch.setattr(packages, "PACKAGES_BOUND", 2)
    for name in "abc":
        package(tmp_path / name, name)
    assert sorted(packages.read_workspace(tmp_path, tmp_path).packages) == ["a", "b"]


def test_variables_that_multiply(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Their values are cut, so that ten lines cannot fill the memory."""
    monkeypatch.setattr(packages, "_VALUE_BOUND", 10)
    folder = package(tmp_path / "a", "a")
    (folder / "CMakeLists.txt").write_text("set(x 12345678)\nset(y ${x}${x}${x})\n${y}")
    assert packages.cmake_text(packages.Package("a", folder)).endswith("\n1234567812")


@pytest.mark.parametrize(
    ("name", "module"), [("tf2_ros_py", "tf2_ros"), ("message_filters", "src/message_filters"), ("rclpy", "rclpy")]
)
def test_source_trees_of_what_graphflow_has(tmp_path: Path, name: str, module: str) -> None:
    """They are known, whatever their package is called, and wherever its modules are."""
    package(tmp_path / name, name)
    folder = tmp_path / name / module
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "__init__.py").touch()
    assert find_workspace(tmp_path).replaced == {folder.name: folder}


def test_a_module_that_no_entry_names(tmp_path: Path) -> None:
    """The entry is written out; other names have none."""
    setup = "setup(entry_points={'console_scripts': ['arm = a.arm:main']})"
    folder = package(tmp_path / "a", "a", setup_dot_py=setup, a__arm_dot_py="def main(): ...", a__leg_dot_py="")
    found = find_workspace(tmp_path).packages["a"]
    assert found.missing_entry("leg") == (
        f"; leg.py is there: add 'leg = a.leg:main', to the console_scripts of {folder}/setup.py"
    )
    assert found.missing_entry("head") == ""
