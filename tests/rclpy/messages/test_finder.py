"""Importing messages under ROS's names."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import pytest

from graphflow.analysis import hiding
from graphflow.rclpy.messages import classes, finder


def test_bundled_packages_are_found() -> None:
    """Classes, all names of a module, and rosidl's modules of one class."""
    module = importlib.import_module("geometry_msgs.msg")
    assert module.Twist().linear.x == 0.0
    assert "PoseStamped" in dir(module)
    assert importlib.import_module("sensor_msgs.msg._laser_scan").LaserScan.__name__ == "LaserScan"
    assert importlib.import_module("std_srvs.srv").Empty.Request() is not None
    with pytest.raises(ImportError, match="Twits"):
        exec("from geometry_msgs.msg import Twits", {})
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("geometry_msgs.nothing")


def interfaces(folder: Path, package: str) -> Path:
    """A package of definitions, as in a workspace."""
    (folder / package / "msg").mkdir(parents=True)
    (folder / package / "msg" / "Speed.msg").write_text("float64 value\n")
    return folder / package


def forget(package: str) -> None:
    for name in [name for name in sys.modules if name.partition(".")[0] == package]:
        del sys.modules[name]


def test_a_package_that_is_known_is_found_with_the_modules_in_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Though nothing of it is on the path."""
    folder = interfaces(tmp_path, "speed_interfaces")
    (folder / "units.py").write_text("METRE = 1.0\n")
    monkeypatch.setitem(finder.KNOWN, "speed_interfaces", str(folder))
    assert importlib.import_module("speed_interfaces.msg").Speed(value=2.0).value == 2.0
    assert importlib.import_module("speed_interfaces.units").METRE == 1.0
    forget("speed_interfaces")


def test_a_source_folder_on_the_path_is_no_namespace_without_messages(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Python would take `src/drive_interfaces` for a package with an empty `msg`."""
    interfaces(tmp_path, "drive_interfaces")
    monkeypatch.syspath_prepend(str(tmp_path))
    assert importlib.import_module("drive_interfaces.msg").Speed().value == 0.0
    forget("drive_interfaces")


def test_a_package_with_code_that_python_finds_is_left_to_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As the one of a ROS that is sourced."""
    (tmp_path / "shape_msgs").mkdir()
    (tmp_path / "shape_msgs" / "__init__.py").write_text("WHOSE = 'ROS'\n")
    forget("shape_msgs")
    monkeypatch.syspath_prepend(str(tmp_path))
    assert importlib.import_module("shape_msgs").WHOSE == "ROS"
    forget("shape_msgs")


@pytest.mark.parametrize("name", ["shape_msgs", "rclpy"])
def test_a_file_that_hides_a_package(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It is told once: what imports it may fail with an error about something else, or do nothing."""
    monkeypatch.setattr(hiding, "_warned", set())
    (tmp_path / f"{name}.py").touch()
    monkeypatch.syspath_prepend(str(tmp_path))
    assert [finder.MessagePackages().find_spec(name, None) for _ in range(2)] == [None, None]
    assert capsys.readouterr().err == (
        f"note: {tmp_path}/{name}.py hides the package {name}: rename it, as in my_{name}.py\n"
    )


@pytest.mark.parametrize(("name", "module"), [("LaserScan", "laser_scan"), ("Imu", "imu"), ("MD5Sum", "md5_sum")])
def test_modules_of_one_class_have_rosidls_names(name: str, module: str) -> None:
    """Snake case."""
    assert classes.snake(name) == module


def test_installing_twice_is_installing_once() -> None:
    """The finder is asked for every import."""
    before = len(sys.meta_path)
    finder.install()
    assert len(sys.meta_path) == before


def test_a_package_with_code_and_messages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Both are found, though its code lies one folder further down; a kind of which it has none is not there."""
    folder = interfaces(tmp_path, "mixed")
    (folder / "mixed").mkdir()
    (folder / "mixed" / "__init__.py").write_text("KIND = 'both'\n")
    monkeypatch.setitem(finder.KNOWN, "mixed", str(folder))
    monkeypatch.syspath_prepend(str(folder))
    assert importlib.import_module("mixed").KIND == "both"
    assert importlib.import_module("mixed.msg").Speed().value == 0.0
    with pytest.raises(ModuleNotFoundError, match=r"mixed\.action"):
        importlib.import_module("mixed.action")
    forget("mixed")
