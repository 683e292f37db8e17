"""Where a project begins, and what graphflow brings along."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.workspace import project
from graphflow.workspace.project import bundled_graphs, demos_root, module_of, no_file, project_root, shown


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A project with graphs and nodes, and a graph file deep inside."""
    for name in ("a/graphs/deep", "a/nodes", "b"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "a/pyproject.toml").touch()
    (tmp_path / "a/graphs/deep/g.yaml").touch()
    return tmp_path


def test_the_root_has_a_pyproject_and_graphs_or_nodes(folder: Path) -> None:
    """The nearest folder above the file that looks like a project is where classes are imported from."""
    assert project_root(folder / "a/graphs/deep/g.yaml") == folder / "a"
    assert project_root(folder / "a/graphs") == folder / "a"
    assert project_root(folder / "a") == folder / "a"
    (folder / "a/nodes").rmdir()
    assert project_root(folder / "a/graphs/deep/g.yaml") == folder / "a"


def test_without_a_project_it_is_the_files_own_folder(folder: Path) -> None:
    """A file that stands alone finds the modules beside it."""
    (folder / "b/g.yaml").touch()
    assert project_root(folder / "b/g.yaml") == folder / "b"
    assert project_root(folder / "b") == folder / "b"
    (folder / "b/pyproject.toml").touch()  # a package of something else
    assert project_root(folder / "b/g.yaml") == folder / "b"


def test_the_nearest_project_counts(folder: Path) -> None:
    """A project inside another is its own."""
    (folder / "a/graphs/deep/nodes").mkdir()
    (folder / "a/graphs/deep/pyproject.toml").touch()
    assert project_root(folder / "a/graphs/deep/g.yaml") == folder / "a/graphs/deep"


def test_a_link_leads_to_its_project(folder: Path) -> None:
    """A link to a graph file belongs to the project the file is in."""
    (folder / "b/link.yaml").symlink_to(folder / "a/graphs/deep/g.yaml")
    assert project_root(folder / "b/link.yaml") == folder / "a"


def test_bundled_graphs_are_in_the_clone_or_in_the_package(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In a clone they are the project's own; an installed package has them under `demos`."""
    assert "talker_listener" in bundled_graphs()
    assert bundled_graphs()["talker_listener"].is_file()
    demos = folder / "a/graphflow/demos"
    (demos / "graphs").mkdir(parents=True)
    (demos / "graphs/one.yaml").touch()
    monkeypatch.setattr(project, "INSTALLED_DEMOS", demos)
    assert demos_root() == demos
    assert bundled_graphs() == {"one": demos / "graphs/one.yaml"}
    assert project_root(demos / "graphs/one.yaml") == demos  # even when installed inside somebody's project
    assert project_root(folder / "a/graphs/deep/g.yaml") == folder / "a"


def test_paths_are_shown_short(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Below the working directory a path is relative, elsewhere it stays as it was given."""
    monkeypatch.chdir(folder / "a")
    assert shown(Path("graphs/deep/g.yaml")) == "graphs/deep/g.yaml"
    assert shown(folder / "a/graphs/deep/g.yaml") == "graphs/deep/g.yaml"
    assert shown(folder / "b/g.yaml") == str(folder / "b/g.yaml")
    assert shown(Path("../b/g.yaml")) == "../b/g.yaml"


def test_graphs_beside_nodes(folder: Path) -> None:
    """Make a project of the folder above them, without a `pyproject.toml` too."""
    (folder / "a/pyproject.toml").unlink()
    (folder / "a/graphs/g.yaml").touch()
    assert project_root(folder / "a/graphs/g.yaml") == folder / "a"
    (folder / "a/nodes").rmdir()
    assert project_root(folder / "a/graphs/g.yaml") == folder / "a/graphs"


def test_a_file_is_imported_from_its_project(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The working directory counts for a file without one: above a project it is not what its modules are named by."""
    (folder / "a/nodes/n.py").touch()
    (folder / "b/nodes").mkdir()
    (folder / "b/nodes/n.py").touch()
    monkeypatch.chdir(folder)
    assert module_of(Path("a/nodes/n.py")) == (folder / "a", "nodes.n")
    assert module_of(Path("b/nodes/n.py")) == (folder, "b.nodes.n")
    monkeypatch.chdir(folder / "b")
    assert module_of(Path("nodes/n.py")) == (folder / "b", "nodes.n")
    assert module_of(folder / "a/nodes/n.py") == (folder / "a", "nodes.n")


def test_a_path_from_the_root(tmp_path: Path) -> None:
    """The right one begins at the file that has it; for any other missing file a similar name is suggested."""
    for name in ("graphs/slow.yaml", "graphs/fast.yaml", "params/goal.yaml", "pyproject.toml"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).touch()
    begins = "; a path begins at the file that has it: write "
    assert no_file(tmp_path / "graphs/params/goal.yaml").endswith(f"{begins}../params/goal.yaml")
    assert no_file(tmp_path / "graphs/graphs/slow.yaml").endswith(f"{begins}slow.yaml")
    assert no_file(tmp_path / "graphs/slw.yaml").endswith("did you mean 'slow.yaml'?")


def test_a_home_folder_that_is_not_expanded(tmp_path: Path) -> None:
    """The message has the substitution for it."""
    assert no_file(Path("~", "maps", "a.yaml")).endswith("; ~ is not expanded: write $(env HOME)/maps/a.yaml")
    assert "~ is not" not in no_file(tmp_path / "a~" / "b.yaml")
