"""Why a package is not found."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.workspace.packages import Workspace, find_workspace
from graphflow.workspace.unfound import (
    inner_workspaces,
    launching,
    no_packages,
    outer_workspace,
    owners,
    starts_of,
    uninstalled_files,
    why_no_package,
    without_executables,
)

SETUP = "from setuptools import setup\nsetup(entry_points={'console_scripts': ['shine = lamp.node:main']})\n"


def manifest(name: str) -> str:
    return f"<package><name>{name}</name></package>"


def write(folder: Path, **files: str) -> Path:
    folder.mkdir(parents=True)
    for name, text in files.items():
        (folder / name.replace("_", ".", 1)).write_text(text)
    return folder


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Workspace:
    """A workspace with one package, and folders that are none."""
    source = tmp_path / "ws" / "src"
    write(source / "lamp", package_xml=manifest("lamp"), setup_py=SETUP)
    write(source / "dark", setup_py=SETUP)
    (source / "dark" / "resource").mkdir()
    (source / "dark" / "resource" / "dark").touch()
    write(source / "vendored", setup_py="")
    write(source / "cut", package_xml="<package")
    write(source / "open", package_xml="<package><name>open<name></package>")
    write(source / "nameless", package_xml="<package></package>")
    write(source / "folder", package_xml=manifest("other"))
    write(source / "ignored", package_xml=manifest("ignored"), setup_py=SETUP)
    (source / "ignored" / "COLCON_IGNORE").touch()
    write(source / "project", pyproject_toml="")
    (source / "project" / "nodes").mkdir()
    monkeypatch.chdir(tmp_path / "ws")
    return find_workspace(tmp_path / "ws")


def test_launch_files_of_packages(workspace: Workspace) -> None:
    """Are started by their package, however deep they lie in its `launch/`."""
    file = workspace.packages["lamp"].folder / "launch" / "robot" / "lamp.launch.py"
    file.parent.mkdir(parents=True)
    file.touch()
    told = "; to start it: graphflow launch lamp lamp.launch.py"
    assert launching("lamp.launch.py", workspace.packages.values()) == told
    assert launching("src/lamp.launch.py", workspace.packages.values()) == told
    assert launching("other.launch.py", workspace.packages.values()) == ""


def test_what_starts_a_package(workspace: Workspace) -> None:
    """Its first launch file and its first executable."""
    lamp = workspace.packages["lamp"]
    assert starts_of(lamp) == "; to start it: graphflow run lamp shine"
    (lamp.folder / "launch").mkdir()
    (lamp.folder / "launch" / "lamp.launch.py").touch()
    (lamp.folder / "launch" / "README").touch()
    assert starts_of(lamp) == "; to start it: graphflow launch lamp lamp.launch.py, or graphflow run lamp shine"


@pytest.mark.parametrize(
    ("file", "text", "told"),
    [
        ("setup.py", "setup()", "src/lamp/setup.py does not install launch/, so that ROS 2 would not find it; add to"),
        ("setup.py", "glob('launch/*')", ""),
        ("CMakeLists.txt", "install(DIRECTORY msg)", "src/lamp/CMakeLists.txt does not install launch/, so that ROS 2"),
        ("CMakeLists.txt", "install(DIRECTORY launch)", ""),
        ("README", "", ""),
    ],
)
def test_launch_files_that_are_not_installed(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch, file: str, text: str, told: str
) -> None:
    """ROS 2 would not find them."""
    monkeypatch.chdir(workspace.root)
    folder = workspace.packages["lamp"].folder
    (folder / "setup.py").unlink()
    (folder / file).write_text(text)
    package = find_workspace(workspace.root).packages["lamp"]
    assert uninstalled_files(package) == ""
    (folder / "launch").mkdir()
    assert uninstalled_files(package) == ""  # an empty folder
    (folder / "launch" / "lamp.launch.py").touch()
    found = uninstalled_files(package)
    assert found.startswith(told) if told else found == ""


@pytest.mark.parametrize(
    ("count", "line"),
    [
        (1, "('share/lamp/config', ['config/p0.yaml']),"),
        (5, "('share/lamp/config', glob('config/*')),"),
    ],
)
def test_files_that_are_not_installed(workspace: Workspace, count: int, line: str) -> None:
    """The line that is missing can be pasted as it is."""
    folder = workspace.packages["lamp"].folder
    (folder / "config").mkdir()
    files = [f"config/p{number}.yaml" for number in range(count)]
    for file in files:
        (folder / file).touch()
    package = find_workspace(workspace.root).packages["lamp"]
    way = "add from glob import glob at the top, and to data_files: " if count > 1 else "add to data_files: "
    assert uninstalled_files(package).endswith(f"{way}{line}")
    setup = folder / "setup.py"
    setup.write_text(f"{setup.read_text()}\nfound = os.walk('.')\n")
    assert uninstalled_files(find_workspace(workspace.root).packages["lamp"]) == ""


def test_workspaces_within_another(workspace: Workspace) -> None:
    """A workspace within another has its packages in a folder `src` of its own."""
    assert inner_workspaces(workspace) == []
    write(workspace.root / "src" / "mine" / "src" / "bulb", package_xml=manifest("bulb"))
    assert inner_workspaces(find_workspace(workspace.root)) == [workspace.root / "src" / "mine"]


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("dark", "src/dark has setup.py but no package.xml; to make it a package, write in it: <package"),
        ("vendored", "src/vendored has setup.py but no package.xml"),
        ("cut", "src/cut/package.xml:1: it is not valid XML: unclosed token; is a tag not closed by </...>?"),
        ("open", "src/open/package.xml:1: it is not valid XML: mismatched tag; is a tag not closed by </...>?"),
        ("nameless", "src/nameless/package.xml has no <name>; to make it a package, write in it: <package"),
        ("folder", "src/folder is the package 'other', by the name in its package.xml"),
        ("ignored", "src/ignored is left out of the workspace, as it has a file COLCON_IGNORE"),
        ("project", "src/project is a project of graphflow's, not a package of ROS 2's; to use it: cd src/project"),
    ],
)
def test_a_folder_of_that_name(workspace: Workspace, name: str, why: str) -> None:
    """Its state is told."""
    said = why_no_package(name, workspace)
    assert said is not None
    assert said.startswith(why)


def test_a_copied_package_whose_manifest_was_forgotten(workspace: Workspace) -> None:
    """The folder and its setup.py have the new name, so that of the manifest is left from before."""
    folder = write(workspace.root / "src" / "copied", package_xml=manifest("lamp"))
    (folder / "setup.py").write_text("from setuptools import setup\nsetup(name='copied')\n")
    assert why_no_package("copied", find_workspace(workspace.root)) == (
        "src/copied/package.xml has the name 'lamp', and setup.py beside it 'copied': write <name>copied</name>"
    )
    (folder / "setup.py").write_text("from setuptools import setup\nsetup(name='lamp')\n")
    assert str(why_no_package("copied", find_workspace(workspace.root))).endswith("package.xml; use that name")


def test_the_folder_that_the_user_is_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also from within, where there is no workspace."""
    inner = write(tmp_path / "dark" / "dark")
    (tmp_path / "dark" / "setup.py").touch()
    monkeypatch.chdir(inner)
    assert "has setup.py but no package.xml" in str(why_no_package("dark", find_workspace(inner)))


def test_a_package_beside_the_others(workspace: Workspace) -> None:
    """It is told where it belongs."""
    write(workspace.root / "new", package_xml=manifest("new"))
    said = why_no_package("new", workspace)
    assert said == "new lies beside src, where packages are looked for: mv new src"


def test_a_package_beside_an_empty_src(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """From within `src`, too, it is told where it belongs; it is no workspace within another."""
    (tmp_path / "src").mkdir()
    folder = write(tmp_path / "lamp", package_xml=manifest("lamp"))
    assert inner_workspaces(find_workspace(tmp_path)) == []
    monkeypatch.chdir(tmp_path / "src")
    said = why_no_package("lamp", find_workspace(tmp_path / "src"))
    assert said == f"{folder} lies beside {tmp_path}/src, where packages are looked for: mv {folder} {tmp_path}/src"


def test_a_package_without_executables(workspace: Workspace) -> None:
    """How it gets one is told."""
    folder = write(workspace.root / "src" / "empty", package_xml=manifest("empty"), setup_py="")
    package = find_workspace(workspace.root).packages["empty"]
    assert without_executables(package) == (
        f"; write a module in {folder}/empty, and name its function in console_scripts of {folder}/setup.py"
    )


def test_nothing_of_that_name(workspace: Workspace) -> None:
    """There is nothing to say of it, nor of a package that is there."""
    assert why_no_package("nowhere", workspace) is None
    assert why_no_package("lamp", workspace) is None


def test_a_workspace_in_a_workspace(workspace: Workspace) -> None:
    """The packages around it are told of, and where they are."""
    root = workspace.root
    write(root / "src" / "inner" / "src" / "deep", package_xml=manifest("deep"))
    inner = find_workspace(root / "src" / "inner")
    assert list(inner.packages) == ["deep"]
    around = outer_workspace(inner)
    assert around is not None
    assert around.root == root
    assert str(why_no_package("lamp", inner)).endswith(f": cd {root}")
    assert outer_workspace(workspace) is None


def test_folders_that_were_meant(workspace: Workspace) -> None:
    """A `package.xml` or the marker of ament says so; other code may have a `setup.py`, too."""
    told = [said.split()[0].rstrip(":1") for said in no_packages(workspace)]
    assert sorted(told) == [
        "src/cut/package.xml",
        "src/dark",
        "src/nameless/package.xml",
        "src/open/package.xml",
    ]


def test_an_executable(workspace: Workspace) -> None:
    """The packages that have it."""
    assert owners("shine", workspace) == ["lamp"]
    assert owners("lamp", workspace) == []
