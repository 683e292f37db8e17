"""Where the files of packages are."""

from __future__ import annotations

from pathlib import Path

import ament_index_python
import pytest
from ament_index_python.packages import (
    PackageNotFoundError,
    get_package_prefix,
    get_package_share_directory,
    get_package_share_path,
    get_packages_with_prefixes,
)


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two packages that nobody has built, and a program of one of them that runs in another folder."""
    for name in ("lamp", "lamp_bringup"):
        (tmp_path / "src" / name / "launch").mkdir(parents=True)
        (tmp_path / "src" / name / "package.xml").write_text(f"<package><name>{name}</name></package>")
    program = tmp_path / "src" / "lamp" / "node.py"
    program.write_text("")
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    monkeypatch.setattr("sys.argv", [str(program)])
    return tmp_path


def test_a_package_of_the_workspace_is_its_folder(workspace: Path) -> None:
    """Nothing is built, so its launch files and parameters lie there."""
    folder = workspace / "src" / "lamp_bringup"
    assert get_package_share_directory("lamp_bringup") == str(folder)
    assert get_package_share_path("lamp_bringup") / "launch" == folder / "launch"
    assert get_package_prefix("lamp_bringup") == str(folder)
    assert get_packages_with_prefixes() == {p: str(workspace / "src" / p) for p in ("lamp", "lamp_bringup")}


def test_installed_packages_are_found_too(workspace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those of a ROS 2 that is sourced, and of Python."""
    marker = workspace / "ros" / "share" / "ament_index" / "resource_index" / "packages" / "nav"
    marker.parent.mkdir(parents=True)
    marker.write_text("")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(workspace / "ros"))
    assert get_package_share_directory("nav") == str(workspace / "ros" / "share" / "nav")
    assert get_package_prefix("nav") == str(workspace / "ros")
    assert get_package_share_directory("pytest") == str(Path(pytest.__file__).parent)


def test_what_is_not_there_is_told(workspace: Path) -> None:
    """With what may have been meant."""
    with pytest.raises(ament_index_python.PackageNotFoundError, match=r"'lmap' not found.*did you mean 'lamp'"):
        get_package_share_directory("lmap")
    with pytest.raises(PackageNotFoundError):
        get_package_prefix("no_such_package")
    with pytest.raises(ValueError, match="not a valid package name"):
        get_package_share_directory("../lamp")
    with pytest.raises(ValueError, match="must not be empty"):
        get_package_share_directory("")
