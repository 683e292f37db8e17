"""The `share` folders of packages that nobody has installed."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from graphflow.workspace import package_share
from graphflow.workspace.package_share import share_folder
from graphflow.workspace.packages import Package
from tests.parser import disturb

SETUP = """\
import os
from glob import glob
from setuptools import setup

package_name = "robot"
share = os.path.join("share", package_name)
setup(
    name=package_name,
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/" + package_name]),
        (share, ["package.xml"] + glob("launch/*.launch.py")),
        (os.path.join(share, "config"), glob(os.path.join("config", "*.yaml")) + ["params/a.yaml"]),
        (f"share/{package_name}/meshes/visual", glob("meshes/**/*.stl", recursive=True)),
        ("share/elsewhere", ["params/a.yaml"]),
        ("share/robot/../../up", ["params/a.yaml"]),
        ("lib/robot", ["params/a.yaml"]),
    ],
)
"""


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Package:
    """A package with files in several folders, and a place for what is kept."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    folder = tmp_path / "robot"
    for name in ("package.xml", "launch/a.launch.py", "config/b.yaml", "params/a.yaml", "meshes/left/arm.stl"):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(name)
    return Package("robot", folder)


def contents(folder: Path) -> dict[str, str]:
    """The files of a folder, those behind links too, and what is in them."""
    return {str(f.relative_to(folder)): f.read_text() for f in sorted(folder.glob("**/*")) if f.is_file()}


def test_files_that_are_put_elsewhere(package: Package) -> None:
    """They are there, and all others as well; a change in the package is one in the folder."""
    (package.folder / "setup.py").write_text(SETUP)
    share = share_folder(package)
    assert share.name == "robot"
    assert share != package.folder
    there = {
        path: text
        for path in ("a.launch.py", "config/b.yaml", "config/a.yaml", "meshes/visual/arm.stl")
        if (text := (share / path).read_text())
    }
    assert there == {
        "a.launch.py": "launch/a.launch.py",
        "config/b.yaml": "config/b.yaml",
        "config/a.yaml": "params/a.yaml",
        "meshes/visual/arm.stl": "meshes/left/arm.stl",
    }
    assert (share / "launch" / "a.launch.py").read_text() == "launch/a.launch.py"
    assert (share / "meshes" / "left" / "arm.stl").is_file()
    assert not (share.parent / "up").exists()
    assert not [there for there, _ in package_share._installed(package) if ".." in there.parts]
    (package.folder / "launch" / "a.launch.py").write_text("changed")
    assert (share / "a.launch.py").read_text() == "changed"


def test_it_is_made_anew_each_time(package: Package) -> None:
    """What has come is there, and what has gone is not."""
    (package.folder / "setup.py").write_text(SETUP)
    share_folder(package)
    (package.folder / "launch" / "a.launch.py").rename(package.folder / "launch" / "b.launch.py")
    (package.folder / "config" / "c.yaml").touch()
    share = share_folder(package)
    assert not (share / "a.launch.py").is_symlink()
    assert (share / "b.launch.py").is_file()
    assert (share / "config" / "c.yaml").is_file()


@pytest.mark.parametrize(
    "setup",
    [
        "",
        "setup(data_files=[('share/robot', ['package.xml']), ('share/robot/launch', glob('launch/*'))])",
        "setup(data_files=[('share/robot', ['gone.yaml'])])",
        "setup(data_files=files_of(here))",
        "setup(",
    ],
)
def test_the_package_itself(package: Package, setup: str) -> None:
    """Where every file keeps its place, or nothing can be seen."""
    (package.folder / "setup.py").write_text(setup)
    assert share_folder(package) == package.folder


@pytest.mark.parametrize(
    ("cmake", "files"),
    [
        ("install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME}/)", None),
        ("install(DIRECTORY launch/ DESTINATION share/${PROJECT_NAME} PATTERN x EXCLUDE)", ["a.launch.py"]),
        ("install(DIRECTORY meshes DESTINATION share/${PROJECT_NAME}/3d)", ["3d/meshes/left/arm.stl"]),
        ("install(FILES params/a.yaml\n  config/b.yaml DESTINATION share/robot)", ["a.yaml", "b.yaml"]),
        (
            "install(FILES params/a.yaml DESTINATION lib/robot) # install(FILES config/b.yaml DESTINATION share/robot)",
            None,
        ),
    ],
)
def test_what_cmake_installs(package: Package, cmake: str, files: list[str] | None) -> None:
    """Files, and folders with or without their own names."""
    (package.folder / "CMakeLists.txt").write_text(cmake)
    share = share_folder(package)
    assert (share == package.folder) == (files is None)
    assert all((share / file).is_file() for file in files or [])


def test_where_there_is_no_place_for_links(package: Package, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is the package itself."""
    (package.folder / "setup.py").write_text(SETUP)
    monkeypatch.setenv("XDG_STATE_HOME", "/proc/nowhere")
    assert share_folder(package) == package.folder


def test_several_processes_make_it_at_once(package: Package) -> None:
    """As the nodes of a launch file do; and a layout that changes leaves nothing behind that is wrong."""
    (package.folder / "setup.py").write_text(SETUP)
    with ThreadPoolExecutor(8) as pool:
        shares = set(pool.map(lambda _: share_folder(package), range(40)))
    assert len(shares) == 1
    assert (shares.pop() / "config" / "a.yaml").read_text() == "params/a.yaml"
    (package.folder / "setup.py").write_text("setup(data_files=[('share/robot', ['params/a.yaml'])])")
    share = share_folder(package)
    assert (share / "a.yaml").read_text() == "params/a.yaml"
    assert not (share / "config" / "a.yaml").exists()


def test_too_many_files(package: Package, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only the first are found at their installed places."""
    (package.folder / "setup.py").write_text(SETUP)
    found = [*package_share._installed(package)]
    assert len(found) > 2
    monkeypatch.setattr(package_share, "FILES_BOUND", 3)
    assert [*package_share._installed(package)] == found[:2]


@pytest.mark.parametrize("failures", [1, 5])
def test_a_parser_that_other_threads_disturb(package: Package, monkeypatch: pytest.MonkeyPatch, failures: int) -> None:
    """Nothing is installed of a `setup.py` that cannot be parsed."""
    (package.folder / "setup.py").write_text(SETUP)
    disturb(monkeypatch, failures)
    assert bool([*package_share._installed(package)]) is (failures == 1)
