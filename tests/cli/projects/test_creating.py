"""`graphflow pkg create`."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from click.testing import CliRunner

from graphflow.cli.main import cli
from graphflow.errors import UsageFault
from tests.cases import slow
from tests.conftest import Machine

PYTHON = [
    "LICENSE",
    "my_pkg/__init__.py",
    "my_pkg/first.py",
    "my_pkg/tools/__init__.py",
    "package.xml",
    "resource/my_pkg",
    "setup.cfg",
    "setup.py",
    "test/test_copyright.py",
    "test/test_flake8.py",
    "test/test_pep257.py",
]
TALK = """\
import rclpy


def main():
    rclpy.init()
    rclpy.create_node("talk").get_logger().info("it talks")
    rclpy.shutdown()
"""
LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([Node(package="my_pkg", executable="talk")])
"""


def files_of(folder: Path) -> list[str]:
    return sorted(str(file.relative_to(folder)) for file in folder.rglob("*") if file.is_file())


@pytest.fixture
def source(tmp_path: Path) -> Path:
    """The `src` folder of a workspace."""
    folder = tmp_path / "ws" / "src"
    folder.mkdir(parents=True)
    return folder


def test_a_python_package(machine: Machine, source: Path) -> None:
    """A Python package has the same files as ROS 2's, and the output has the same lines."""
    words = ["my_pkg", "--build-type", "ament_python", "--dependencies", "rclpy", "std_msgs", "--node-name", "first"]
    more = ["--library-name", "tools", "--license", "MIT", "--maintainer-name", "Ann O'Hara"]
    email = ["--maintainer-email", "ann@example.org", "--description", "It is <first>."]
    told = machine.look("pkg", "create", *words, *more, *email, cwd=source)
    assert told.splitlines()[:14] == [
        "going to create a new package",
        "package name: my_pkg",
        f"destination directory: {source}",
        "package format: 3",
        "version: 0.0.0",
        "description: It is <first>.",
        """maintainer: ["Ann O'Hara <ann@example.org>"]""",
        "licenses: ['MIT']",
        "build type: ament_python",
        "dependencies: ['rclpy', 'std_msgs']",
        "node_name: first",
        "library_name: tools",
        "creating folder ./my_pkg",
        "creating ./my_pkg/package.xml",
    ]
    assert files_of(source / "my_pkg") == PYTHON
    assert machine.look("pkg", "xml", "my_pkg", "-t", "depend", cwd=source) == "rclpy\nstd_msgs\n"


@slow
def test_it_runs_at_once(machine: Machine, source: Path) -> None:
    """Its first node, and what a student adds: a module, an entry point and a launch file."""
    words = ["--build-type", "ament_python", "my_pkg", "--node-name", "first", "--dependencies", "rclpy"]
    machine.look("pkg", "create", *words, cwd=source)
    assert machine.run("run", "my_pkg", "first", cwd=source.parent) == "Hi from my_pkg.\n"
    (source / "my_pkg/my_pkg/talk.py").write_text(TALK)
    setup = source / "my_pkg/setup.py"
    line = "'console_scripts': ["
    setup.write_text(setup.read_text().replace(line, f'{line}\n            "talk = my_pkg.talk:main",'))
    assert "first, talk" in machine.look("ws", cwd=source)
    assert "it talks" in machine.run("run", "my_pkg", "talk", cwd=source / "my_pkg")
    (source / "my_pkg/launch").mkdir()
    (source / "my_pkg/launch/talk.launch.py").write_text(LAUNCH)
    assert "my_pkg talk" in machine.look("launch", "--print", "my_pkg", "talk.launch.py", cwd=source.parent)


def test_a_package_for_cmake(machine: Machine, source: Path) -> None:
    """A program and a library; also one that has Python modules."""
    words = ["my_pkg", "--build-type", "ament_cmake", "--node-name", "one", "--library-name", "two"]
    machine.look("pkg", "create", *words, cwd=source)
    assert files_of(source / "my_pkg") == [
        "CMakeLists.txt",
        "include/my_pkg/two.hpp",
        "include/my_pkg/visibility_control.h",
        "package.xml",
        "src/one.cpp",
        "src/two.cpp",
    ]
    assert "one is C++, which only colcon builds" in machine.look("run", "my_pkg", "one", cwd=source, code=2)
    machine.look("pkg", "create", "both", "--template", "ament_cmake_python", cwd=source)
    assert "ament_python_install_package(${PROJECT_NAME})" in (source / "both/CMakeLists.txt").read_text()
    tools = machine.look("pkg", "xml", "both", "-t", "buildtool_depend", cwd=source)
    assert tools == "ament_cmake\nament_cmake_python\n"


def test_without_a_build_type(machine: Machine, tmp_path: Path) -> None:
    """Without a build type, a graphflow project is written, with a note on unused options."""
    words = ["my_pkg", "--node-name", "first", "--destination-directory", "src"]
    told = machine.look("pkg", "create", *words, cwd=tmp_path)
    assert "creating src/my_pkg/pyproject.toml" in told
    assert "note: --node-name: not used by a graphflow project; for a ROS 2 package, remove" in told
    assert not (tmp_path / "src/my_pkg/package.xml").exists()
    told = machine.look("pkg", "create", "other", cwd=tmp_path)
    assert "note: this is a graphflow project; for a ROS 2 package, remove other and add --build-type ament_pyt" in told
    program = tmp_path / "other/other/talker.py"
    program.write_text("import rclpy\nrclpy.init()\nrclpy.spin(rclpy.create_node('talker'))\n")
    for folder, file in ((tmp_path, "other/other/talker.py"), (tmp_path / "other", "other/talker.py")):
        told = machine.look("run", "other", "talker", cwd=folder, code=2)
        assert f"other is a project of graphflow's; to run its program for rclpy: graphflow run {file}\n" in told
    program.rename(tmp_path / "other/talker.py")
    told = machine.look("run", "other", "talker", cwd=tmp_path / "other", code=2)
    assert "to run its program for rclpy: graphflow run talker.py\n" in told


def test_a_list_of_dependencies_takes_the_words_behind_it(machine: Machine, tmp_path: Path) -> None:
    """As in ROS 2: the last of them is not the name of the package."""
    words = ["--build-type", "ament_python", "--dependencies", "rclpy", "std_msgs", "my_pkg"]
    assert "the package's name is missing" in machine.look("pkg", "create", *words, cwd=tmp_path, code=2)
    assert not any(path.is_dir() for path in tmp_path.iterdir() if path.name in ("std_msgs", "my_pkg"))


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("my_pkg rclpy std_msgs", "write graphflow pkg create my_pkg --dependencies rclpy std_msgs"),
        ("my robott", "a name is one word, such as my_robott; list the packages that it needs after --dependencies"),
        ("my_pkg ament_python", "write graphflow pkg create --build-type ament_python my_pkg"),
        ("ament_cmake my_pkg", "write graphflow pkg create --build-type ament_cmake my_pkg"),
        ("--node-name talker", "the package's name is missing; write it first: graphflow pkg create NAME"),
    ],
)
def test_words_without_an_option(words: str, told: str) -> None:
    """Arguments of `catkin_create_pkg` are corrected, as are a name in two words and a missing one."""
    done = CliRunner().invoke(cli, ["pkg", "create", *words.split()])
    text = str(done.exception) if isinstance(done.exception, UsageFault) else done.output
    assert told in " ".join(text.split())


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["my-pkg"], "did you mean 'my_pkg'?"),
        (["3pkg"], "begin with a letter, and avoid Python's keywords; did you mean 'my_3pkg'?"),
        (["class"], "did you mean 'my_class'?"),
        (["../pkg"], "'../pkg' cannot be the name of a package"),
        (["class"], "'class' cannot be the name of a package"),
        (["test"], "a Python package cannot be called 'test'"),
        (["my_pkg", "--node-name", "first.py"], "did you mean 'first'?"),
        (["my_pkg", "--template", "ament_cmake_python"], "is for --build-type ament_cmake"),
    ],
)
def test_what_cannot_be(machine: Machine, tmp_path: Path, words: list[str], told: str) -> None:
    """Names that Python cannot import, and a template of another build type."""
    said = machine.look("pkg", "create", *words, "--build-type", "ament_python", cwd=tmp_path, code=2)
    assert told in said
    assert not list(tmp_path.rglob("package.xml"))


def test_nothing_is_overwritten(machine: Machine, source: Path) -> None:
    """An existing folder is not changed, even if it is empty."""
    (source / "my_pkg").mkdir()
    told = machine.look("pkg", "create", "my_pkg", "--build-type", "ament_python", cwd=source, code=2)
    assert "my_pkg already exists" in told
    assert not files_of(source / "my_pkg")


def test_licenses(machine: Machine, source: Path) -> None:
    """The text of a known license is written; another one is only named in package.xml."""
    assert "Apache-2.0" in machine.look("pkg", "create", "--license", "?", cwd=source).splitlines()
    told = machine.look("pkg", "create", "a", "--build-type", "cmake", "--license", "mine", cwd=source)
    assert "note: no LICENSE file is written for 'mine'" in told
    assert not (source / "a/LICENSE").exists()


def test_node_and_library_of_one_name(machine: Machine, source: Path) -> None:
    """The node becomes another one, as in ROS 2."""
    words = ["a", "--build-type", "ament_cmake", "--node-name", "b", "--library-name", "b"]
    assert "the node is called 'b_node'" in machine.look("pkg", "create", *words, cwd=source)
    assert (source / "a/src/b_node.cpp").is_file()


def test_who_maintains_it(machine: Machine, source: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The address is the one that git has; without git, and for a user without a name, there is still one."""
    subprocess.run(["git", "init", "-q", str(source)], check=True)
    subprocess.run(["git", "-C", str(source), "config", "user.email", "ann@example.org"], check=True)
    assert "<ann@example.org>" in machine.look("pkg", "create", "a", "--build-type", "cmake", cwd=source)
    for variable in ("LOGNAME", "USER", "LNAME", "USERNAME"):
        machine.env.pop(variable, None)
    machine.env["PATH"] = str(source)
    monkeypatch.setattr("pwd.getpwuid", lambda _: (_ for _ in ()).throw(KeyError("no entry")))
    told = machine.look("pkg", "create", "b", "--build-type", "cmake", cwd=source)
    assert "maintainer: ['user <user@todo.todo>']" in told
