"""Names that would be a mistake."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.cli.projects.new_names import (
    check_dependencies,
    check_package,
    hidden_module,
    near_name,
    warn_of_name,
    warn_of_place,
)
from graphflow.errors import UsageFault


@pytest.fixture
def source(tmp_path: Path) -> Path:
    """The folder `src` of a workspace with a package `lamp`."""
    folder = tmp_path / "src"
    (folder / "lamp").mkdir(parents=True)
    (folder / "lamp" / "package.xml").write_text("<package><name>lamp</name></package>")
    return folder


@pytest.mark.parametrize("name", ["std_msgs", "rclpy", "turtlesim", "tf2_tools"])
def test_names_of_ros(source: Path, name: str) -> None:
    """Names of ROS 2 packages are refused, since the new package would hide them."""
    with pytest.raises(UsageFault, match=f"'{name}' is a package of ROS 2, which yours would hide; choose another"):
        check_package(name, source / name)


def test_a_name_of_the_workspace(source: Path) -> None:
    """A name of another package of the workspace is refused in every folder."""
    for folder in (source / "tools" / "lamp", source.parent / "lamp"):
        with pytest.raises(UsageFault, match=f"{source / 'lamp'} already is the package 'lamp'"):
            check_package("lamp", folder)
    check_package("lamp", source / "lamp")
    check_package("light", source / "light")


def test_dependencies(source: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Dependencies must be names of packages; one that resembles a known one is reported as misspelt."""
    with pytest.raises(UsageFault, match="write spaces between them: --dependencies rclpy std_msgs"):
        check_dependencies(["lamp", "rclpy,std_msgs"], source / "new")
    with pytest.raises(UsageFault, match=r"'<x>' cannot be the name of a package$"):
        check_dependencies(["<x>"], source / "new")
    check_dependencies(["rclpy", "rclcpp", "turtlebot4_msgs", "lamp"], source / "new")
    assert capsys.readouterr().err == ""
    check_dependencies(["rclpi"], source / "new")
    assert capsys.readouterr().err == "note: the dependency 'rclpi' is not known here; did you mean 'rclpy'?\n"


def test_a_name_that_ros_warns_of(capsys: pytest.CaptureFixture[str]) -> None:
    """A name that breaks ROS's convention gets a note with a valid one; other names do not."""
    for name in ("lamp", "lamp_2"):
        warn_of_name(name)
    assert capsys.readouterr().err == ""
    warn_of_name("TurtleCtl")
    told = "note: names of packages consist of lower-case letters, digits and _, such as 'turtle_ctl'\n"
    assert capsys.readouterr().err == told


def test_a_place_where_it_is_not_found(source: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A package beside `src` gets a note with the command that moves it."""
    warn_of_place(source / "new")
    assert capsys.readouterr().err == ""
    warn_of_place(source.parent / "new")
    told = f"in src/: mv {source.parent / 'new'} {source}\n"
    assert capsys.readouterr().err == f"note: packages of this workspace are looked for {told}"


@pytest.mark.parametrize(
    ("word", "near"),
    [("My-Robot", "my_robot"), ("3pkg", "my_3pkg"), ("first.py", "first"), ("class", "my_class"), ("--", "my_lab")],
)
def test_a_name_that_can_be(word: str, near: str) -> None:
    """An invalid name becomes a valid, similar one."""
    assert near_name(word) == near
    assert near.isidentifier()
    assert near_name(near) == near


def test_modules_that_would_be_hidden(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Modules of Python and of installed packages would be hidden; the user's own folder would not."""
    (tmp_path / "own_lamp").mkdir()
    (tmp_path / "own_lamp" / "__init__.py").touch()
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    assert [hidden_module(word) for word in ("class", "queue")] == ["a module or keyword of Python's"] * 2
    assert [hidden_module(word) for word in ("graphflow", "yaml", "numpy")] == ["an installed module"] * 3
    assert [hidden_module(word) for word in ("own_lamp", "nothing_of_that_name")] == ["", ""]
