"""Finding the node to run: by class, file, module, name, or as in ROS 2."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from graphflow.cli.projects.node_lookup import find_class
from graphflow.errors import GraphflowError, UsageFault
from graphflow.workspace.executables import EXECUTABLES
from graphflow.workspace.project import demos_root
from tests.conftest import PROJECT

ONE = "from graphflow import Node, timer\nclass Plain: ...\nclass {0}(Node):\n    pass\n"


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A project with nodes; whatever is imported from it is forgotten."""
    monkeypatch.setattr(sys, "path", [p for p in sys.path if Path(p).resolve() != PROJECT])
    for name in [n for n in sys.modules if n.partition(".")[0] == "nodes"]:  # this project's own
        monkeypatch.delitem(sys.modules, name)
    known = set(sys.modules)
    folder = tmp_path / "own_nodes"
    folder.mkdir()
    (tmp_path / "nodes").mkdir()
    (tmp_path / "pyproject.toml").touch()
    (folder / "slide.py").write_text(ONE.format("Slide"))
    (folder / "two.py").write_text(ONE.format("Left") + ONE.format("Right") + "from own_nodes.slide import Slide\n")
    (folder / "none.py").write_text("x = 1\n")
    (tmp_path / "lamp").mkdir()
    (tmp_path / "lamp" / "package.xml").write_text("<package><name>lamp</name></package>")
    (tmp_path / "lamp" / "setup.py").write_text(
        "setup(entry_points={'console_scripts': ['drive = lamp.drive:main', 'lift = lamp.lift:main']})\n"
    )
    (tmp_path / "lamp" / "launch").mkdir()
    (tmp_path / "lamp" / "launch" / "lamp.launch.py").touch()
    monkeypatch.chdir(tmp_path)
    yield tmp_path
    for name in set(sys.modules) - known:
        if name.startswith("own_nodes"):
            del sys.modules[name]


@pytest.mark.parametrize(
    "what", ["own_nodes.slide:Slide", "own_nodes/slide.py:Slide", "own_nodes/slide.py", "own_nodes.slide"]
)
def test_the_only_class(what: str, project: Path) -> None:
    """The only class of a module is found by path, file or module; the remaining words are the node's."""
    cls, rest = find_class(what, ["2", "--fast"])
    assert (cls.__module__, cls.__name__) == ("own_nodes.slide", "Slide")
    assert rest == ["2", "--fast"]


@pytest.mark.parametrize(
    ("what", "words", "text"),
    [
        (
            "own_nodes.two",
            [],
            "own_nodes.two has several node classes; run one of own_nodes.two:Left, own_nodes.two:Right",
        ),
        ("own_nodes/none.py", [], "own_nodes.none has no node class"),
        (
            "own_nodes.left-lamp:Lamp",
            [],
            "'own_nodes.left-lamp:Lamp' is not a class; Python imports no name with a hyphen; rename left-lamp to "
            "left_lamp; or run its file: graphflow run own_nodes/left-lamp.py",
        ),
        ("slide.py", [], "slide.py: there is no such file; did you mean 'own_nodes/slide.py'?"),
        ("slide", [], "there is no node 'slide'; did you mean 'own_nodes/slide.py'?"),
        ("own_nodes", ["slide"], "'own_nodes' is a folder, and no package: graphflow run own_nodes/slide.py"),
        ("nodes/talker.py", [], "there is no such file; talker.py comes with graphflow: graphflow run talker"),
        ("turtlesim/turtlesim_node", [], "is not a node; write a space: graphflow run turtlesim turtlesim_node"),
        ("graphs/lamps.yaml", [], "graphs/lamps.yaml is a graph file: graphflow up graphs/lamps.yaml"),
        ("own_nodes/slid.py:Slide", [], "own_nodes/slid.py: there is no such file; did you mean 'own_nodes/slide.py'?"),
        ("own_nodes/slide.py:Slid", [], "module own_nodes.slide has no class 'Slid'; did you mean 'Slide'?"),
        ("own_nodes/slid.py", [], "there is no such file; did you mean 'own_nodes/slide.py'?"),
        ("own_nodes.slid", [], "did you mean 'own_nodes.slide'?"),
        ("Slide", [], "'Slide': write MODULE:CLASS, own_nodes.slide:Slide"),
        ("slid.Slide", [], "'slid.Slide': write MODULE:CLASS, own_nodes.slide:Slide"),
        ("turtlesin", [], "there is no node 'turtlesin', here or with graphflow; did you mean 'turtlesim'?"),
        ("nodes.nothing.at_all", [], "there is no module 'nodes.nothing'"),
        ("own_nodes.slide.Slide", [], "write MODULE:CLASS, own_nodes.slide:Slide"),
        ("turtlesim_node", ["turtlesim"], "which comes first: graphflow run turtlesim turtlesim_node"),
        ("talker", ["demo_nodes_py"], "which comes first: graphflow run demo_nodes_py talker"),
        ("turtlesim.turtlesim_node", [], "turtlesim is a package: graphflow run turtlesim turtlesim_node"),
        ("lamp.driv", [], "'lamp.driv': lamp is a package: graphflow run lamp drive"),
        ("lamp.x", [], "'lamp.x': lamp is a package: graphflow run lamp drive|lift"),
        ("own_nodes/slide", [], "there is no node 'own_nodes/slide'; did you mean 'own_nodes/slide.py'?"),
        ("lamp.launch.py", [], "no such file; to start it: graphflow launch lamp/launch/lamp.launch.py"),
        ("drive", ["lamp"], "'drive' is an executable of the package 'lamp', which comes first"),
        ("turtlesim", ["turtlesim_nod"], "has no executable 'turtlesim_nod' here; did you mean 'turtlesim_node'?"),
    ],
)
def test_what_is_not_there(what: str, words: list[str], text: str, project: Path) -> None:
    """The nearest is named."""
    with pytest.raises(UsageFault) as caught:
        find_class(what, words)
    assert text in str(caught.value)


def test_a_file_that_is_no_python(project: Path) -> None:
    """A syntax error is shown with its line and a caret, as by Python."""
    (project / "own_nodes" / "cut.py").write_text("import rclpy\nfrom std_msgs/msg import Int32\n")
    with pytest.raises(UsageFault) as caught:
        find_class("own_nodes/cut.py", [])
    told, line, caret = str(caught.value).splitlines()
    assert told.endswith("own_nodes/cut.py:2: invalid syntax")
    assert line == "    from std_msgs/msg import Int32"
    assert caret == f"{line.index('/') * ' '}^"


def test_bundled_nodes(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """By their names, under an import name of their own, though the project has a `nodes/` too."""
    for what, words in (("turtlesim", []), ("turtlesim", ["turtlesim_node"]), ("nodes.turtlesim:TurtleSim", [])):
        cls, rest = find_class(what, words)
        assert (cls.__module__, rest) == ("graphflow.nodes.turtlesim", [])
        assert "comes with graphflow" in capsys.readouterr().err


@pytest.mark.parametrize("class_path", sorted(set(EXECUTABLES.values())))
def test_executables_of_ros(class_path: str) -> None:
    """Each executable of ROS's packages exists."""
    module, _, name = class_path.partition(":")
    file = demos_root() / f"{module.replace('.', '/')}.py"
    assert f"class {name}(" in file.read_text(encoding="utf-8")


def test_the_project_that_one_is_in(project: Path) -> None:
    """The project's own name is not a package; its nodes are run by name."""
    names = 'slide = "own_nodes.slide:Slide"\nleft = "own_nodes.two:Left"\n'
    (project / "pyproject.toml").write_text(f'[project]\nname = "x"\n[project.entry-points."graphflow.nodes"]\n{names}')
    others = (["two"], "own_nodes.two:Left"), (["right"], "own_nodes.two:Right"), (["nobody"], "left")
    for words, node in (([], "left"), (["slid"], "slide"), *others):
        with pytest.raises(UsageFault, match=f"'{project.name}' is the project that you are in: graphflow run {node}"):
            find_class(project.name, words)


@pytest.mark.parametrize(
    ("path", "told"),
    [
        ("own_nodes.slide:Slid", "module own_nodes.slide has no class 'Slid'; did you mean 'Slide'"),
        ("own_nodes.slid:Slide", "own_nodes.slid"),
    ],
)
def test_a_name_of_a_class_that_was_renamed(path: str, told: str, project: Path) -> None:
    """The error has the line in which the old name still stands."""
    (project / "pyproject.toml").write_text(
        f'[project]\nname = "x"\n[project.entry-points."graphflow.nodes"]\na = "{path}"'
    )
    with pytest.raises(GraphflowError, match=f'{told}.*; pyproject.toml has a = "{path}"$'):
        find_class("a", [])


@pytest.mark.parametrize(
    ("name", "owner"),
    [("logging", "Python's module logging"), ("graphflow", "the package graphflow"), ("yaml", "the package yaml")],
)
def test_a_file_that_hides_a_module(name: str, owner: str, project: Path) -> None:
    """Would not be imported, or not be the only one that is hidden: it needs another name."""
    importlib.import_module(name)  # as most verbs have
    (project / f"{name}.py").write_text("from graphflow import Node\n\n\nclass N(Node): ...\n")
    with pytest.raises(UsageFault, match=f"a file of this name hides {owner}, .* rename it: my_{name}.py"):
        find_class(str(project / f"{name}.py"), [])
