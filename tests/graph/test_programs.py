"""Programs of graph files, which must be there before anything starts."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from graphflow.errors import GraphFileError
from graphflow.graph.plan import Plan
from graphflow.graph.resolve import load, resolve
from graphflow.markup import source


def planned(root: Path, text: str) -> Plan:
    return resolve(source.read(text, "f.yaml"), root / "f.yaml", [])


@pytest.mark.parametrize(
    ("node", "said"),
    [
        ("{pkg: lamp, exec: shin}", "the package 'lamp' has no executable 'shin'; did you mean 'shine'?"),
        ("{pkg: lmp, exec: shine}", "there is no package 'lmp' in WORKSPACE, and no ROS 2 is sourced; did you mean"),
        ("{pkg: lamp, exec: glow}", "glow of the package 'lamp' is C++, which only colcon builds; graphflow runs Pyth"),
        ("{pkg: lamp, exec: b}", "WORKSPACE/src/lamp/setup.py:1: b is lamp.b:f, and there is no WORKSPACE/src/lamp/"),
        (
            "{pkg: turtlesim, exec: turtlesim_nod}",
            "the package 'turtlesim' has no executable 'turtlesim_nod' here; did you mean 'turtlesim_node'?",
        ),
        ("{pkg: lamp, exec: shine, params_file: q.yaml}", "there is no file "),
        ("{pkg: lamp, exec: shine, remap: {__ns: /x}}", "'__ns' cannot be remapped"),
        (
            "{pkg: lamp, exec: shine, lifecycle: active, keep_names: true}",
            "lifecycle: needs the node's name, which keep_names leaves to the program",
        ),
    ],
)
def test_executables_that_are_not_there(lamps: Path, node: str, said: str) -> None:
    """It is told before anything starts, with what there is."""
    with pytest.raises(GraphFileError) as caught:
        planned(lamps, f"nodes: {{a: {node}}}")
    [problem] = caught.value.problems
    assert problem.message.startswith(said.replace("WORKSPACE", str(lamps)))


def test_words_before_a_program(lamps: Path) -> None:
    """They must be there; a class has no program."""
    found = planned(lamps, "nodes: {a: {pkg: lamp, exec: shine, args: [x], prefix: env -i}}")
    assert found.nodes[0].command[:2] == ("env", "-i")
    assert found.nodes[0].command[-1] == "x"
    for node, said in (
        (
            "{pkg: lamp, exec: shine, prefix: no_such -x}",
            "there is no program 'no_such' on the PATH, which prefix: names",
        ),
        ('{pkg: lamp, exec: shine, prefix: "a \'b"}', "prefix: No closing quotation"),
        ("{class: nodes.talker:Talker, prefix: nice -n 5}", "graphflow run --prefix 'nice -n 5' nodes.talker:Talker"),
        ("{command: [ls], prefix: nice}", "prefix: is for nodes, and this is a program; it stands in the list"),
    ):
        with pytest.raises(GraphFileError, match=re.escape(said)):
            planned(lamps, f"nodes: {{a: {node}}}")


def test_what_a_launch_file_has_before_a_program(lamps: Path) -> None:
    """What is not there leaves the node out, a class goes without; both are remarked."""
    nodes = [
        "{pkg: lamp, exec: shine, launch-prefix: xterm_that_is_not_there -e}",
        "{pkg: lamp, exec: shine, name: cold, launch-prefix: nice -n 5}",
        "{pkg: demo_nodes_py, exec: talker, launch-prefix: gdb --args}",
    ]
    (lamps / "f.launch.yaml").write_text(f"launch: [{', '.join(f'{{node: {node}}}' for node in nodes)}]\n")
    found = load(lamps / "f.launch.yaml")
    assert {node.name: node.command[:3] for node in found.nodes} == {"/cold": ("nice", "-n", "5"), "/talker": ()}
    [bare, left_out] = sorted(remark.partition(": ")[2] for remark in found.remarks)
    assert bare.startswith(
        "prefix: goes with pkg: and exec:; to run this class by itself with it: graphflow run --prefix"
    )
    assert left_out == (
        "shine is left out: there is no program 'xterm_that_is_not_there' on the PATH, which prefix: names; "
        "run it by itself: graphflow run lamp shine"
    )


def test_what_nobody_here_has_is_left_out_of_launch_files(lamps: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """So the rest starts without ROS, and it is remarked. Slips are mistakes, and so is a file without a rest."""
    monkeypatch.setenv("PATH", "/nowhere")
    nodes = "{node: {pkg: lamp, exec: shine}}, {node: {pkg: rviz2, exec: rviz2}}, {node: {pkg: lamp, exec: glow}}"
    (lamps / "f.launch.yaml").write_text(f"launch: [{nodes}]\n")
    found = load(lamps / "f.launch.yaml")
    assert [node.name for node in found.nodes] == ["/shine"]
    assert [remark.partition(": ")[2] for remark in found.remarks] == [
        f"rviz2 is left out: there is no package 'rviz2' in {lamps}, and no ROS 2 is sourced",
        "glow is left out: glow of the package 'lamp' is C++, which only colcon builds; graphflow runs Python",
    ]
    assert set(found.remarks) <= set(found.lines())
    for node in ("{pkg: lamp, exec: shin}", "{pkg: lmp, exec: shine}", "{pkg: rviz2, exec: rviz2}"):
        (lamps / "f.launch.yaml").write_text(f"launch: [{{node: {node}}}]\n")
        with pytest.raises(GraphFileError):
            load(lamps / "f.launch.yaml")


def test_an_executable_may_be_a_file(lamps: Path) -> None:
    """By its path from the graph file: a script in Python, or whatever can be run; it gets what others get."""
    (lamps / "shine.py").touch()
    (lamps / "bin").mkdir()
    (lamps / "bin/run").touch(mode=0o755)
    (lamps / "bin/not").touch(mode=0o644)
    found = planned(lamps, "nodes: {a: {exec: shine.py, args: [x], params: {rate: 2}}, b: {exec: bin/run}}")
    assert [node.command for node in found.nodes] == [
        ("graphflow", "run", str(lamps / "shine.py"), "x"),
        (str(lamps / "bin/run"),),
    ]
    assert [node.executable for node in found.nodes] == ["shine.py", "bin/run"]
    for node, said in (
        ("{exec: gone.py}", "exec: there is no file"),
        ("{exec: ~/gone.py}", r"~ is not expanded: write \$\(env HOME\)/gone\.py"),
        ("{exec: bin/not}", "to make it one: chmod \\+x"),
        ("{exec: shine}", "or exec: is a file"),
    ):
        with pytest.raises(GraphFileError, match=said):
            planned(lamps, f"nodes: {{a: {node}}}")
    (lamps / "f.launch.yaml").write_text(f"launch: [{{node: {{exec: {lamps}/shine.py}}}}]")
    assert [node.name for node in load(lamps / "f.launch.yaml").nodes] == ["/shine"]


def test_programs_that_nobody_here_has_are_left_out_of_launch_files(lamps: Path) -> None:
    """Of several of a name only nodes are remarked: a program's name is only that of its process."""
    absent = "{executable: {cmd: no_such_simulator}}"
    text = f"launch: [{absent}, {absent}, {{executable: {{cmd: ls}}}}, {{executable: {{cmd: ls}}}}]\n"
    (lamps / "f.launch.yaml").write_text(text)
    found = load(lamps / "f.launch.yaml")
    assert [node.name for node in found.nodes] == ["/ls_1", "/ls_2"]
    said = "no_such_simulator is left out: there is no program of that name on the PATH"
    assert {remark.partition(": ")[2] for remark in found.remarks} == {said}
