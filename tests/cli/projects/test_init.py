"""A new project works as it is written."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from graphflow.introspect.installation import requirement
from tests.cases import slow
from tests.conftest import LIMIT, PROGRAMS, Machine

pytestmark = pytest.mark.real


@slow
def test_a_new_project_runs_and_passes_its_test(machine: Machine, tmp_path: Path) -> None:
    """Its own node is the one that runs, with its own interface; pytest is content; the check finds nothing."""
    text = machine.run("init", "mylab", cwd=tmp_path)
    assert "graphflow up graphs/mylab.yaml" in text
    project = tmp_path / "mylab"
    assert f"    pip install {requirement()} -e '.[dev]'\n" in (project / "README.md").read_text()
    assert "no problems" in machine.run("check", "graphs/mylab.yaml", cwd=project)
    up = machine.start("up", "graphs/mylab.yaml", "text:=moin", cwd=project)
    up.wait_for("mylab/greeter.py")
    up.wait_for("moin, time 2")
    assert "text: moin" in machine.run("topic", "echo", "/greeting", "--once", cwd=project)
    assert up.end() == 0
    words = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    tests = subprocess.run(words, cwd=project, capture_output=True, text=True, timeout=LIMIT * 3, check=False)
    assert tests.returncode == 0, tests.stdout
    assert "1 passed" in tests.stdout
    alone = subprocess.Popen(
        [sys.executable, "mylab/greeter.py"], cwd=project, env=machine.env, stderr=subprocess.PIPE, text=True
    )
    try:
        assert alone.stderr is not None
        assert "hello, time 1" in alone.stderr.readline()
    finally:
        alone.terminate()
        alone.communicate(timeout=LIMIT)


@slow
def test_its_nodes_are_never_shadowed_by_ours(machine: Machine, tmp_path: Path) -> None:
    """A node that is called like one that comes with graphflow is the project's own."""
    machine.run("init", "mylab", cwd=tmp_path)
    project = tmp_path / "mylab"
    shutil.copytree(PROGRAMS / "run", project / "nodes", ignore=lambda _, names: {*names} - {"talker.py"})
    node = machine.start("run", "nodes.talker:Talker", cwd=project)
    node.wait_for("this is mine")
    assert node.end() == 0


@slow
def test_its_nodes_have_names(machine: Machine, tmp_path: Path) -> None:
    """Nodes have the names of `pyproject.toml`, even before installation; the wheel has no package `nodes`."""
    machine.look("init", "mylab", cwd=tmp_path)
    project = tmp_path / "mylab"
    assert machine.look("pkg", "executables", "mylab", cwd=project) == "mylab greeter\n"
    wheel = tomllib.loads((project / "pyproject.toml").read_text())["tool"]["hatch"]["build"]["targets"]["wheel"]
    assert wheel == {
        "packages": ["mylab"],
        "force-include": {"graphs": "mylab/graphs", "interfaces": "mylab/interfaces"},
    }
    node = machine.start("run", "greeter", cwd=project)
    node.wait_for("hello, time 1")
    assert node.end() == 0


def test_its_graph_can_be_included_under_namespaces(machine: Machine, tmp_path: Path) -> None:
    """Its names are relative: two of it are two robots."""
    machine.look("init", "mylab", cwd=tmp_path)
    twice = tmp_path / "mylab" / "graphs" / "twice.yaml"
    twice.write_text("include: [{file: mylab.yaml, namespace: left}, {file: mylab.yaml, namespace: right}]")
    plan = machine.look("plan", str(twice), cwd=tmp_path)
    assert "/left/greeter" in plan
    assert "/right/greeter" in plan


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("My-Lab", "a project's name has only lower-case letters, digits and single _, and begins with a letter; did"),
        ("My-Lab", "did you mean 'my_lab'?"),
        ("1lab", "did you mean 'my_1lab'?"),
        ("lab__a", "did you mean 'lab_a'?"),
        ("..lab", "did you mean 'lab'?"),
        ("class", "'class' is a module or keyword of Python's, which yours would hide; did you mean 'my_class'?"),
        ("random", "did you mean 'my_random'?"),
    ],
)
def test_a_name_must_be_a_packages(machine: Machine, tmp_path: Path, name: str, told: str) -> None:
    """A name must be valid for a package, since Python imports it; a valid one is suggested."""
    assert told in machine.run("init", name, cwd=tmp_path, code=2)
    assert not (tmp_path / name).exists()


@slow
def test_nothing_is_overwritten(machine: Machine, tmp_path: Path) -> None:
    """A folder with something in it stays as it is; an empty one is filled."""
    (tmp_path / "lab").mkdir()
    machine.run("init", "lab", cwd=tmp_path)
    (tmp_path / "lab" / "README.md").write_text("mine")
    assert "lab already exists" in machine.run("init", "lab", cwd=tmp_path, code=2)
    assert (tmp_path / "lab" / "README.md").read_text() == "mine"


@slow
def test_the_folder_itself(machine: Machine, tmp_path: Path) -> None:
    """The current folder is filled if it is empty; otherwise the error says how to create a new one."""
    (tmp_path / "lab").mkdir()
    assert machine.run("init", ".", cwd=tmp_path / "lab").endswith("next:\n  graphflow up graphs/lab.yaml\n")
    assert (tmp_path / "lab" / "lab" / "greeter.py").is_file()
    told = machine.run("init", ".", cwd=tmp_path / "lab", code=2)
    assert told == "error: this folder is not empty; graphflow init NAME creates a new one\n"
