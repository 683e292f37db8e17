"""Files that hide packages."""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path

import pytest

from graphflow.analysis import hiding


def beside(folder: Path, name: str, source: str, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A file that is imported in the place of a package."""
    file = folder / f"{name}.py"
    file.write_text(source)
    monkeypatch.syspath_prepend(str(folder))
    monkeypatch.delitem(sys.modules, name, raising=False)
    return file


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("psutil", "import psutil\npsutil.cpu_count()"),
        ("psutil", "from psutil import cpu_count"),
        ("psutil", "import psutil.cpu"),
        ("sched", "import sched\nsched.scheduler"),
        ("shape_msgs", "from shape_msgs.msg import Plane"),
    ],
)
def test_an_error_about_a_hidden_package(name: str, line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The file is named that was imported in its place."""
    file = beside(tmp_path, name, "", monkeypatch)
    with pytest.raises((ImportError, AttributeError)) as caught:
        exec(line, {})
    assert hiding.hidden(caught.value) == f"{file} hides the package {name}: rename it, as in my_{name}.py"
    sys.modules.pop(name, None)  # not by monkeypatch, which would put it back


@pytest.mark.parametrize(
    ("name", "line", "is_hiding"),
    [
        ("shape_msgs", "from shape_msgs.msg import Plane", True),
        ("shape_msgs", "import shape_msgs.plane", False),
        ("psutil", "import psutil._common", True),
        ("psutil", "import psutil.lamps", False),
        ("lampshade", "import lampshade.msg", False),
    ],
)
def test_a_folder_that_hides_a_package(
    name: str, line: str, is_hiding: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is named where the package has the module; a module that neither has is another mistake."""
    (tmp_path / name).mkdir()
    beside(tmp_path, f"{name}/__init__", "", monkeypatch)
    for module in [m for m in sys.modules if m == name or m.startswith(f"{name}.")]:
        monkeypatch.delitem(sys.modules, module)
    with pytest.raises(ModuleNotFoundError) as caught:
        exec(line, {})
    text = f"{tmp_path / name} hides the package {name}: rename it, as in my_{name}"
    assert hiding.hidden(caught.value) == (text if is_hiding else "")
    (tmp_path / "package.xml").touch()
    text = f"your package {tmp_path} hides ROS 2's {name}; rename yours, there and in its files"
    assert hiding.hidden(caught.value).startswith(text) is (is_hiding and name == "shape_msgs")
    sys.modules.pop(name, None)  # not by monkeypatch, which would put it back


@pytest.mark.parametrize("line", ["import lampshade\nlampshade.cpu", "import json\njson.cpu", "from json import cpu"])
def test_errors_about_modules_that_hide_nothing(line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is told of a module of the user's own, or of a package that is the right one."""
    beside(tmp_path, "lampshade", "", monkeypatch)
    with pytest.raises((ImportError, AttributeError)) as caught:
        exec(line, {})
    assert hiding.hidden(caught.value) == ""


@pytest.mark.parametrize(
    ("name", "source", "hides"),
    [
        ("std_msgs", "from std_msgs.msg import String", True),
        ("rclpy", "import rclpy", True),
        ("psutil", "import psutil.cpu", True),
        ("psutil", "import rclpy", False),
        ("lampshade", "import lampshade", False),
        ("std_msgs", "def def", False),
    ],
)
def test_a_program_with_the_name_of_a_package(name: str, source: str, hides: bool, tmp_path: Path) -> None:
    """It hides that only if it imports it."""
    file = tmp_path / f"{name}.py"
    file.write_text(source)
    assert hiding.hides_what_it_imports(file) is hides


def test_it_is_told_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """By a note."""
    monkeypatch.setattr(hiding, "_warned", set())
    file = beside(tmp_path, "lampshade", "", monkeypatch)
    assert import_module("lampshade")
    hiding.warn(file)
    hiding.warn(file)
    assert capsys.readouterr().err.count("note: ") == 1
