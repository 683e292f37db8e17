"""ROS's launch files, in YAML and XML, as graph files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from graphflow.errors import GraphFileError
from graphflow.graph.resolve import load
from graphflow.launchfiles import conversion
from graphflow.launchfiles.conversion import FROM_LAUNCH
from graphflow.markup import source
from graphflow.markup.source import Data
from graphflow.markup.tree import tree

CANONICAL = """\
launch:
- arg: {name: "background_r", default: "0"}
- arg: {name: "ns", default: "turtlesim1", description: Where., choice: [{value: turtlesim1}, {value: b}]}
- group:
    - push_ros_namespace: {namespace: "$(var ns)"}
    - include: {file: "$(dirname)/talker.launch.xml", arg: [{name: rate, value: "4.0"}]}
- node:
    pkg: "turtlesim"
    exec: "turtlesim_node"
    name: "sim"
    namespace: "turtlesim2"
    param:
    - {name: "background_r", value: "$(var background_r)"}
"""
TALKER = """\
<?xml version="1.0"?>
<!-- a talker and its listener -->
<launch>
  <arg name="rate" default="1.0" description="How often."/>
  <let name="who" value="world"/>
  <set_parameter name="use_sim_time" value="false"/>
  <node pkg="demo_nodes_py" exec="talker" respawn="true" respawn_delay="2" ros_args="--ros-args --log-level DEBUG">
    <param name="greeting" value="hello $(var who)"/>
    <param name="number" value="7" type="str"/>
    <param name="limits"><param name="speed" value="1.5"/></param>
    <param from="$(dirname)/params.yaml"/>
    <remap from="chatter" to="news"/>
    <env name="A" value="1"/>
  </node>
  <group if="$(eval rate &gt; 2.0)">
    <push-ros-namespace namespace="inner"/>
    <node pkg="demo_nodes_cpp" exec="listener" name="ear" output="screen"/>
  </group>
</launch>
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A project's folder of launch files."""
    (tmp_path / "talker.launch.xml").write_text(TALKER)
    (tmp_path / "multi.launch.yaml").write_text(CANONICAL)
    (tmp_path / "params.yaml").write_text("/**: {ros__parameters: {gain: 3.0}}\n")
    return tmp_path


def test_a_file_of_each_kind(folder: Path) -> None:
    """One includes the other; arguments, namespaces, conditions, typed parameters, and the names that nodes have."""
    found = load(folder / "multi.launch.yaml", ["background_r:=7"], {})
    assert (found.name, found.args) == ("multi", {"background_r": "7", "ns": "turtlesim1"})
    nodes = {node.name: node for node in found.nodes}
    assert list(nodes) == ["/turtlesim1/talker", "/turtlesim1/inner/ear", "/turtlesim2/sim"]
    talker, sim = nodes["/turtlesim1/talker"], nodes["/turtlesim2/sim"]
    assert (talker.class_path, sim.class_path) == ("nodes.talker:Talker", "nodes.turtlesim:TurtleSim")
    assert {name: setting.value for name, setting in talker.params.items()} == {
        "gain": 3.0,
        "use_sim_time": False,
        "greeting": "hello world",
        "number": "7",
        "limits.speed": 1.5,
    }
    assert [(rule.match, rule.replacement) for rule in talker.remaps] == [("chatter", "news")]
    assert (talker.env, talker.log_level) == ({"A": "1"}, "debug")
    assert (talker.restart.policy, talker.restart.delay) == ("always", 2.0)
    assert sim.params["background_r"].value == 7
    assert str(talker.params["greeting"].place).endswith("talker.launch.xml:8:5")
    alone = load(folder / "talker.launch.xml", [], {})
    assert [node.name for node in alone.nodes] == ["/talker"]


def native(text: str, root: Path = Path("/nowhere")) -> tuple[Any, list[str], list[str]]:
    """A launch file in our words, what has none, and what is worth a note."""
    complaints: list[str] = []
    notes: list[str] = []
    top = tree(source.read(text, "f.yaml"))
    assert conversion.is_launch_file(top)
    made = conversion.native(
        top, root, lambda at, said: complaints.append(f"{at}: {said}"), lambda at, said: notes.append(said)
    )
    assert FROM_LAUNCH in made.entries
    return made.without(FROM_LAUNCH).plain(), complaints, notes


TURTLE = "node: {pkg: turtlesim, exec: turtlesim_node}"
SIM = {"sim": {"class": "nodes.turtlesim:TurtleSim"}}


@pytest.mark.parametrize(
    ("actions", "expected"),
    [
        (f"[{{{TURTLE}}}]", {"nodes": {"turtlesim": {"class": "nodes.turtlesim:TurtleSim"}}}),
        (
            "[{set_env: {name: A, value: b}}, {set_remap: {from: x, to: y}}, {node: {pkg: turtlesim, exec: "
            "turtlesim_node, name: sim}}]",
            {"group": {"env": {"A": "b"}, "remap": {"x": "y"}, "nodes": SIM}},
        ),
        (
            "[{let: {name: n, value: '3'}}, {group: [{set_use_sim_time: {value: 'true'}}, {node: {pkg: turtlesim, "
            "exec: turtlesim_node, name: sim}}]}]",
            {"group": {"for": {"var": "n", "in": ["3"], "group": {"params": {"use_sim_time": True}, "nodes": SIM}}}},
        ),
        (
            "[{executable: {cmd: rviz2 -d 'a b.rviz', on_exit: shutdown}}, {executable: {cmd: rviz2, cwd: /tmp}}]",
            {
                "nodes": {
                    "rviz2_1": {"command": ["rviz2", "-d", "a b.rviz"], "on_exit": "shutdown"},
                    "env_1": {"command": ["env", "-C", "/tmp", "rviz2"]},
                }
            },
        ),
        (
            "[{executable: {cmd: 'echo $HOME | cat', shell: 'true'}}, {executable: {cmd: ros2 topic list}}]",
            {
                "nodes": {
                    "sh_1": {"command": ["sh", "-c", "echo $HOME | cat"]},
                    "graphflow_1": {"command": ["graphflow", "topic", "list"]},
                }
            },
        ),
        (
            "[{executable: {cmd: ['ros2 service call /a b/srv/C \"{x: 1}\"'], shell: 'true'}}, "
            "{executable: {cmd: 'sleep 1; ros2 topic list', shell: 'true'}}]",
            {
                "steps": {"call_1": {"call": "/a", "type": "b/srv/C", "request": {"x": 1}, "timeout": 60.0}},
                "nodes": {"sh_1": {"command": ["sh", "-c", "sleep 1; ros2 topic list"]}},
            },
        ),
        (
            "[{executable: {cmd: \"ros2 service call /spawn turtlesim/srv/Spawn '{x: 2.0, name: leo}'\"}}, "
            "{executable: {cmd: ros2 param set /sim background_r 150}}, "
            "{executable: {cmd: \"ros2 action send_goal /turn turtlesim/action/RotateAbsolute '{theta: 1.5}' -f\"}}]",
            {
                "steps": {
                    "call_1": {
                        "call": "/spawn",
                        "type": "turtlesim/srv/Spawn",
                        "request": {"x": 2.0, "name": "leo"},
                        "timeout": 60.0,
                    },
                    "set_1": {
                        "set": "/sim",
                        "params": {"background_r": 150},
                        "type": "rcl_interfaces/srv/SetParametersAtomically",
                        "timeout": 60.0,
                    },
                    "send_goal_1": {
                        "goal": "/turn",
                        "type": "turtlesim/action/RotateAbsolute",
                        "request": {"theta": 1.5},
                        "timeout": 60.0,
                    },
                }
            },
        ),
        (
            "[{timer: {period: 2.5, children: [{node: {pkg: turtlesim, exec: turtlesim_node, name: sim}}]}}]",
            {
                "steps": {"timer_1": {"delay": 2.5}},
                "nodes": {"sim": {"after": "timer_1", **SIM["sim"]}},
            },
        ),
        (
            "[{include: {file: a.yaml, if: $(var x)}}, {include: {file: b.yaml, arg: [{name: n, value: '1'}]}}]",
            {"include": [{"file": "a.yaml", "if": "$(var x)"}, {"file": "b.yaml", "args": {"n": "1"}}]},
        ),
        ("[{log: {message: hello}}, {log: {message: ''}}, {group: []}]", {"steps": {"log_1": {"log": "hello"}}}),
        (
            "[{executable: {cmd: '$(find-exec ros2) service call $(var ns)/reset std_srvs/srv/Empty', shell: true}}]",
            {"steps": {"call_1": {"call": "$(var ns)/reset", "type": "std_srvs/srv/Empty", "timeout": 60.0}}},
        ),
        (
            "[{executable: {cmd: ls, number: 1}}, {log: {message: a, number: 2, after_number: 1, after_what: exited}}, "
            "{timer: {period: 1, after_number: 2, after_what: exited, children: [{log: {message: b}}]}}]",
            {
                "nodes": {"ls_1": {"command": ["ls"]}},
                "steps": {
                    "log_1": {"log": "a", "after": {"ls_1": "exited"}},
                    "timer_1": {"delay": 1, "after": {"log_1": "done"}},
                    "log_2": {"log": "b", "after": "timer_1"},
                },
            },
        ),
        (
            "[{append_env: {name: P, value: /a}}, {append_env: {name: Q, value: b, prepend: 'true', separator: ' '}}, "
            "{node: {pkg: turtlesim, exec: turtlesim_node, name: sim}}]",
            {
                "group": {
                    "env": {"P": "$(optenv P)$(if $(not-equals '$(optenv P)' '') : '')/a"},
                    "group": {
                        "env": {"Q": "b$(if $(not-equals '$(optenv Q)' '') ' ' '')$(optenv Q)"},
                        "nodes": SIM,
                    },
                }
            },
        ),
        (
            "[{node: {pkg: turtlesim, exec: turtlesim_node, name: a, namespace: n}}, {node: {pkg: turtlesim, exec: "
            "turtlesim_node, name: a, namespace: m}}]",
            {
                "nodes": {"a": {"class": "nodes.turtlesim:TurtleSim", "namespace": "n"}},
                "group": {"nodes": {"a": {"class": "nodes.turtlesim:TurtleSim", "namespace": "m"}}},
            },
        ),
    ],
)
def test_actions(actions: str, expected: dict[str, Any]) -> None:
    """Each in our words; what sets something for those after it becomes a group around them."""
    assert native(f"launch: {actions}\n") == (expected, [], [])


def test_components() -> None:
    """Nodes of a container share a process, and so do those that are loaded into it."""
    talker = "{pkg: composition, plugin: 'composition::Talker', name: t, param: [{name: rate, value: 2.0}]}"
    listener = "{pkg: composition, plugin: 'composition::Listener', remap: [{from: chatter, to: news}]}"
    container = "{name: c, namespace: '', pkg: rclcpp_components, exec: component_container"
    made, complaints, _ = native(
        f"launch: [{{node_container: {container}, composable_node: [{talker}]}}}}, "
        f"{{load_composable_node: {{target: /c, if: $(var x), composable_node: [{listener}]}}}}]\n"
    )
    assert complaints == []
    assert made["nodes"] == {
        "t": {"class": "nodes.talker:Talker", "params": {"rate": 2.0}, "process": "c"},
        "listener": {
            "class": "nodes.listener:Listener",
            "remap": {"chatter": "news"},
            "process": "c",
            "if": "$(var x)",
        },
    }


def test_lifecycle_nodes() -> None:
    """One that ROS would bring to work by itself is brought there, a program, too."""
    made, complaints, _ = native(
        "launch: [{lifecycle_node: {pkg: lifecycle, exec: lifecycle_talker, name: t, autostart: 'true'}}, "
        "{lifecycle_node: {pkg: nav2, exec: planner, name: p, autostart: 'True'}}]\n"
    )
    assert made["nodes"]["t"] == {"class": "nodes.lifecycle_talker:LifecycleTalker", "lifecycle": "active"}
    assert made["nodes"]["p"] == {"pkg": "nav2", "exec": "planner", "lifecycle": "active"}
    assert complaints == []


@pytest.mark.parametrize(
    ("action", "complaint"),
    [
        ("nod: {pkg: a}", "f.yaml:1:11: the action 'nod' has no equivalent in a graph file; did you mean 'node'?"),
        ("node: {pkg: a, exe: b}", "f.yaml:1:26: node: unknown attribute 'exe'; did you mean 'exec'?"),
        ("node: {pkg: a, type: b}", "f.yaml:1:26: node: unknown attribute 'type'; it is called 'exec' here"),
        (
            "node: {pkg: a, exec: b, param: {rate: 2.0}}",
            "f.yaml:1:42: param: expected a list of names and values, such as - {name: rate, value: 2.0}",
        ),
        ("node: {pkg: a}", "f.yaml:1:11: node: the attributes 'pkg' and 'exec' are needed"),
        ("node: 3", "f.yaml:1:17: node: expected a mapping of its attributes, got 3"),
        (
            "a: 1, b: 2",
            "f.yaml:1:10: expected an action, for example node: {pkg: turtlesim, exec: turtlesim_node}, got",
        ),
        ("node: , pkg: a", "f.yaml:1:10: the attributes of node: stand below it: indent them further than node:"),
        (
            "node: {pkg: a, exec: b, remap: [{c: d}]}",
            "f.yaml:1:43: the attribute 'from' is missing; write {from: c, to: d}",
        ),
        ("node_container: {}", "f.yaml:1:11: the attribute 'name' or 'target' is missing"),
        (
            "node_container: {name: c, composable_node: [{pkg: composition, plugin: 'a::Talkr'}]}",
            "f.yaml:1:82: composable_node: no node here is the component a::Talkr of the package composition; did you",
        ),
        (
            "load_composable_node: {target: c, composable_node: [{pkg: a}]}",
            "f.yaml:1:63: composable_node: the attributes 'pkg' and 'plugin' are needed",
        ),
        (
            "unset_env: {name: A}",
            "f.yaml:1:11: the action 'unset_env' has no equivalent in a graph file: write env: in",
        ),
        ("arg: {default: '1'}", "f.yaml:1:11: arg: the attribute 'name' is missing"),
        ("set_remap: {to: a}", "f.yaml:1:11: the attribute 'from' is missing"),
        ("set_remap: {from: a, to: b, if: 'true'}", "f.yaml:1:11: set_remap: a condition here has no equivalent"),
        ("executable: {}", "f.yaml:1:11: executable: the attribute 'cmd' is missing"),
        ("executable: {cmd: ['ls -l']}", "f.yaml:1:29: cmd is one word with spaces: add shell=True, or give a list of"),
        ('executable: {cmd: "a \'b"}', "f.yaml:1:29: cmd: No closing quotation"),
        ("executable: {cmd: 'ros2 service call /a b/srv/C {d'}", "f.yaml:1:29: the request '{d'"),
        (
            "executable: {cmd: a, output: scren}",
            "f.yaml:1:40: executable: output: 'scren' is not one of launch's; did you",
        ),
        (
            "node: {pkg: turtlesim, exec: mimic, remap: {from: a, to: b}}",
            "f.yaml:1:54: node: remap is a list: write [ ] around { }",
        ),
        (
            "include: {file: a.launch.py, arg:\n      {name: a, value: b}}",
            "f.yaml:2:7: include: arg is a list: put '- ' before 'name:'",
        ),
        ("timer: {children: []}", "f.yaml:1:11: timer: the attribute 'period' is missing"),
    ],
)
def test_what_has_no_words(action: str, complaint: str) -> None:
    """It is told with its line, and what to do."""
    _, complaints, _ = native(f"launch: [{{{action}}}]\n")
    assert complaints
    assert complaints[0].startswith(complaint)


@pytest.mark.parametrize(
    ("numbers", "restart"),
    [
        ("respawn_delay: 0.5", {"policy": "always", "delay": 0.5}),
        ("respawn_delay: 0.0, respawn_max_retries: -1", {"policy": "always"}),
        ("respawn_max_retries: 3", {"policy": "always", "max_restarts": 3}),
        ("respawn_delay: $(var pause)", {"policy": "always", "delay": "$(var pause)"}),
        ("respawn_max_retries: 0", None),
    ],
)
def test_restarts(numbers: str, restart: object) -> None:
    """Delays below a second count; no retries are no restarts, and a negative number is no limit."""
    made, complaints, _ = native(
        f"launch: [{{node: {{pkg: turtlesim, exec: turtlesim_node, name: s, respawn: 'true', {numbers}}}}}]\n"
    )
    assert complaints == []
    assert made["nodes"]["s"].get("restart") == restart


def test_a_node_that_only_ros_has() -> None:
    """It is run by ros2; the reader of a converted file is told so."""
    made, complaints, notes = native(
        "launch: [{node: {pkg: nav2, exec: planner, name: p, namespace: n, args: -x 1, remap: [{from: a, to: b}], "
        "param: [{name: rate, value: 2.5}, {from: f.yaml}], respawn: 'true'}}]\n"
    )
    assert complaints == []
    assert notes == ["nav2 planner: no node of that name is here; ros2 runs it, which must be installed"]
    assert made["nodes"]["p"] == {
        "pkg": "nav2",
        "exec": "planner",
        "args": ["-x", "1"],
        "namespace": "n",
        "remap": {"a": "b"},
        "params_file": ["f.yaml"],
        "params": {"rate": 2.5},
        "restart": {"policy": "always"},
    }


def test_a_program_of_the_workspace(tmp_path: Path) -> None:
    """It is run as it lies there; nobody needs ROS for it."""
    folder = tmp_path / "src" / "lamp"
    (folder / "scripts").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>lamp</name></package>")
    (folder / "scripts" / "shine.py").write_text("import rclpy\n")
    made, complaints, notes = native("launch: [{node: {pkg: lamp, exec: shine.py, name: big}}]", tmp_path)
    assert (complaints, notes) == ([], [])
    assert made["nodes"]["big"] == {"pkg": "lamp", "exec": "shine.py"}


def test_words_of_a_node() -> None:
    """Those of ROS 2 are its remaps, parameters and level; others are left out, as a node of ROS's would."""
    words = "[--ros-args, -r, a:=b, -p, background_r:=3, --param, name:=leo, --log-level, WARN, --fast]"
    made, complaints, notes = native(f"launch: [{{node: {{pkg: turtlesim, exec: turtlesim_node, ros_args: {words}}}}}]")
    assert made["nodes"]["turtlesim"] == {
        "class": "nodes.turtlesim:TurtleSim",
        "remap": {"a": "b"},
        "params": {"background_r": 3, "name": "leo"},
        "log_level": "warn",
    }
    assert (complaints, notes) == ([], ["ros_args: the node here does not know --fast; it is left out"])


def test_what_several_programs_may_be_called() -> None:
    """The name of a program is a label."""
    echo = "{executable: {cmd: echo, name: e}}"
    made, _, _ = native(f"launch: [{echo}, {echo}]")
    assert list(made["nodes"]) == ["e", "e_2"]


def test_a_timer_of_no_time() -> None:
    """Its actions are there at once, under its condition."""
    timer = f"{{timer: {{period: 0.0, children: [{{{TURTLE}}}]}}}}"
    made, complaints, _ = native(f"launch: [{timer}]\n")
    node = {"nodes": {"turtlesim": {"class": "nodes.turtlesim:TurtleSim"}}}
    assert (made, complaints) == ({"group": node}, [])


LENIENT = """\
launch:
- include: {file: inner.launch.yaml, arg: [{name: nobodys, value: '3'}]}
- node: {pkg: turtlesim, exec: turtlesim_node, name: sim, param: [{from: none.yaml}, {from: others.yaml}]}
- node: {pkg: turtlesim, exec: turtlesim_node, name: sim}
"""


def test_what_ros_lets_pass(tmp_path: Path) -> None:
    """It is remarked, with its place; in a graph file it is a mistake."""
    (tmp_path / "inner.launch.yaml").write_text(f"launch: [{{{TURTLE}}}]\n")
    (tmp_path / "others.yaml").write_text("/other: {ros__parameters: {a: 1}}\n")
    (tmp_path / "outer.launch.yaml").write_text(LENIENT)
    found = load(tmp_path / "outer.launch.yaml", [], {})
    assert [node.name for node in found.nodes] == ["/turtlesim", "/sim", "/sim_2"]
    assert [remark.rpartition("yaml:")[2] for remark in found.remarks] == [
        "2:51: the included file has no argument 'nobodys'; it declares none of that name under args:",
        "4:54: there is a node /sim already; this one is called /sim_2",
        "3:74: there is no file none.yaml",
        "3:93: others.yaml has nothing for /sim; there is /other",
    ]
    (tmp_path / "strict.yaml").write_text(
        "nodes: {sim: {class: nodes.turtlesim:TurtleSim, params_file: [none.yaml, others.yaml]}}\n"
        "include: {file: inner.launch.yaml, args: {nobodys: 3}}\n"
    )
    with pytest.raises(GraphFileError) as caught:
        load(tmp_path / "strict.yaml", [], {})
    assert len(caught.value.problems) == 4


def test_a_program_without_a_name(tmp_path: Path) -> None:
    """Its nodes are called as its code has it; the file's name for it is one that a node could have."""
    made, _, _ = native("launch: [{node: {pkg: nav2, exec: a-b.py, ros_args: --ros-args --log-level debug}}]", tmp_path)
    words = ["--ros-args", "--log-level", "debug", "--"]
    assert made["nodes"] == {"a_b": {"pkg": "nav2", "exec": "a-b.py", "args": words, "keep_names": True}}


def test_a_group_without_a_scope() -> None:
    """What it sets holds for what comes after it, too; a parameter with a condition has no words."""
    inner = "children: [{push_ros_namespace: {namespace: a}}]"
    made, complaints, _ = native(f"launch: [{{{TURTLE}}}, {{group: {{scoped: 'false', {inner}}}}}, {{{TURTLE}}}]\n")
    turtle = {"nodes": {"turtlesim": {"class": "nodes.turtlesim:TurtleSim"}}}
    assert (made, complaints) == ({**turtle, "group": {"namespace": "a", **turtle}}, [])
    made, complaints, _ = native(f"launch: [{{group: {{scoped: False, if: $(var x), {inner}}}}}, {{{TURTLE}}}]\n")
    assert (made, complaints) == ({"group": {"namespace": "$(if $(var x) a '')", **turtle}}, [])
    inner = "children: [{set_parameter: {name: a, value: 1}}]"
    _, complaints, _ = native(f"launch: [{{group: {{scoped: False, if: 'true', {inner}}}}}, {{{TURTLE}}}]\n")
    assert complaints == [
        "f.yaml:1:58: set_parameter: a condition here has no equivalent in a graph file; put it on a group"
    ]


def test_variables_that_are_set_under_conditions(tmp_path: Path) -> None:
    """By an action of their own, or in a group that opens no scope; else they stay what they are."""
    text = """
    - arg: {name: fast, default: 'true'}
    - let: {name: way, value: it's a walk, unless: $(var fast)}
    - let: {name: way, value: a run, if: $(var fast)}
    - group: {scoped: false, unless: $(var fast), children: [{let: {name: why, value: none}}]}
    - group:
        scoped: false
        unless: $(var fast)
        children: [{let: {name: how, value: slowly, if: 'yes'}}, {group: [{log: {message: slow}}]}]
    - executable: {cmd: [echo, $(var way), $(var why), $(var how)]}
    """
    (tmp_path / "a.launch.yaml").write_text(f"launch:{text}")
    for fast, said in (("true", ("a run", "", "")), ("false", ("it's a walk", "none", "slowly"))):
        plan = load(tmp_path / "a.launch.yaml", [f"fast:={fast}"], {})
        assert plan.nodes[0].command == ("echo", *said)
        assert len(plan.steps) == (fast == "false")


def test_what_is_delayed_as_a_whole(tmp_path: Path) -> None:
    """A group, or another file: all that is in it comes after the timer, and after what it comes after itself."""
    run = "{executable: {cmd: ls, number: 1}}, {log: {message: listed, after_number: 1, after_what: exited}}"
    (tmp_path / "inner.launch.yaml").write_text(f"launch: [{run}]\n")
    inner = "{include: {file: $(dirname)/inner.launch.yaml}}, {group: {children: [{log: {message: a}}]}}"
    (tmp_path / "a.launch.yaml").write_text(f"launch: [{{timer: {{period: 1.5, children: [{inner}]}}}}]\n")
    plan = load(tmp_path / "a.launch.yaml", [], {})
    assert [node.after for node in plan.nodes] == [{"timer_1": "done"}]
    after = {step.name: step.after for step in plan.steps}
    assert after["log_1"] == {"timer_1": "done"}
    assert after["log_1_of_2"] == {"/ls_1": "exited", "timer_1": "done"}


def test_what_is_delayed_replaces_nothing() -> None:
    """A node of the same key that is there at once stays."""
    made, _, _ = native(f"launch: [{{{TURTLE}}}, {{timer: {{period: 1.0, children: [{{{TURTLE}}}]}}}}]\n")
    assert made["nodes"] == {"turtlesim": {"class": "nodes.turtlesim:TurtleSim"}}
    assert made["group"]["nodes"]["turtlesim"]["after"] == "timer_1"


def test_what_was_recorded_of_python() -> None:
    """Actions with their lines; those that come after a process know it by its number."""
    actions: list[dict[str, Data]] = [
        {"node": {"line": 3, "pkg": "turtlesim", "exec": "turtlesim_node", "name": "sim", "number": 1}},
        {"executable": {"line": 5, "cmd": ["echo", "$(var x)"], "after_number": 1, "after_what": "exited"}},
        {"group": {"line": 7, "children": [{"reset_env": {"line": 8}}]}},
    ]
    complaints: list[str] = []
    top = conversion.recorded(actions, "f.launch.py")
    made = conversion.native(top, Path("/nowhere"), lambda at, said: complaints.append(str(at)))
    assert made.entries["nodes"].plain() == {
        **SIM,
        "echo_1": {"command": ["echo", "$(var x)"], "after": {"sim": "exited"}},
    }
    assert complaints == ["f.launch.py:8:1"]


def test_python_is_converted_first(tmp_path: Path) -> None:
    """To start one is answered with how."""
    (tmp_path / "a.launch.py").touch()
    with pytest.raises(GraphFileError, match=r"first: graphflow launch convert .*a.launch.py -o a.launch.yaml"):
        load(tmp_path / "a.launch.py")


TEXTS = """\
launch:
- arg: {name: flag, default: 'True'}
- arg: {name: id, default: '007'}
- arg: {name: any, default: '0'}
- arg: {name: plain, default: true}
- executable:
    cmd: echo $(var flag) v$(var id) --any=$(var any) '$(var any) $(var id)'
    name: $(eval '"$(var flag)"[:1]')
- executable: {cmd: 'true', name: same, if: $(equals $(var id) 007)}
- executable: {cmd: 'true', name: on, if: $(var flag)}
- executable: {cmd: echo $(var plain), name: word}
"""


def test_arguments_are_texts(tmp_path: Path) -> None:
    """As they are written; where a value is wanted, they are read."""
    (tmp_path / "a.launch.yaml").write_text(TEXTS)
    plan = load(tmp_path / "a.launch.yaml", ["any:=auto"])
    assert [node.name for node in plan.nodes] == ["/T", "/same", "/on", "/word"]
    assert plan.nodes[3].command == ("echo", "true")
    assert plan.nodes[0].command == ("echo", "True", "v007", "--any=auto", "auto 007")
    assert plan.args == {"flag": "True", "id": "007", "any": "auto", "plain": "true"}


def test_values_that_stay_texts(tmp_path: Path) -> None:
    """The environment, messages and other arguments keep texts; a parameter is read by YAML 1.1."""
    (tmp_path / "a.launch.xml").write_text(
        """<launch>
        <arg name="id" default="0042"/><arg name="on" default="off"/><arg name="same" default="$(var id)"/>
        <set_env name="ID" value="$(var id)"/>
        <log message="$(var id)"/><log message="$(eval '1 == 1')"/><log message="$(eval 'None')" if="$(eval '1 == 1')"/>
        <node pkg="turtlesim" exec="turtlesim_node">
          <env name="SAME" value="$(var same)"/><param name="id" value="$(var id)"/><param name="on" value="$(var on)"/>
          <param name="text" value="$(var id)" type="str"/><param name="is" value="$(eval '1 == 1')"/>
        </node></launch>"""
    )
    plan = load(tmp_path / "a.launch.xml", [], {})
    assert [step.target for step in plan.steps] == ["0042", "True", "None"]
    [node] = plan.nodes
    assert node.env == {"ID": "0042", "SAME": "0042"}
    assert {name: setting.value for name, setting in node.params.items()} == {
        "id": 0o42,
        "on": False,
        "text": "0042",
        "is": True,
    }


def test_what_belongs_to_a_node_that_is_left_out(tmp_path: Path) -> None:
    """It is not worked out, and so nothing in it is wrong; a slip in a name is, and one that is not like it is none."""
    node = "{pkg: robot_localization, exec: ekf, args: '$(env NO_SUCH_VARIABLE)', param: [{from: $(var nothing)}]}"
    file = tmp_path / "a.launch.yaml"
    (tmp_path / "my_localization").mkdir()
    (tmp_path / "my_localization" / "package.xml").write_text("<package><name>my_localization</name></package>")
    file.write_text(f"launch: [{{node: {node}}}, {{{TURTLE}}}]\n")
    plan = load(file, [], {})
    assert [node.name for node in plan.nodes] == ["/turtlesim"]
    [remark] = [text for text in plan.remarks if "left out" in text]
    assert "ekf is left out: there is no package 'robot_localization'" in remark
    file.write_text(f"launch: [{{node: {node.replace('robot_loc', 'mi_loc')}}}, {{{TURTLE}}}]\n")
    with pytest.raises(GraphFileError, match="did you mean 'my_localization'"):
        load(file, [], {})


def test_a_file_may_be_included_twice(tmp_path: Path) -> None:
    """The steps that it does not name are told apart, and each comes after those of its own inclusion."""
    call = "{executable: {cmd: ros2 service call /clear std_srvs/srv/Empty, number: 1}}"
    inner = f"launch: [{call}, {{log: {{message: cleared, after_number: 1, after_what: exited}}}}]\n"
    (tmp_path / "inner.launch.yaml").write_text(inner)
    include = "{include: {file: $(dirname)/inner.launch.yaml}}"
    (tmp_path / "a.launch.yaml").write_text(f"launch: [{include}, {include}, {call}, {{{TURTLE}}}]\n")
    plan = load(tmp_path / "a.launch.yaml", [], {})
    assert {step.name: step.after for step in plan.steps} == {
        "call_1": {},
        "call_1_of_2": {},
        "log_1_of_2": {"call_1_of_2": "done"},
        "call_1_of_3": {},
        "log_1_of_3": {"call_1_of_3": "done"},
    }


def test_an_empty_argument_is_an_empty_text(tmp_path: Path) -> None:
    """Also as the value of a parameter."""
    node = "{pkg: turtlesim, exec: turtlesim_node, param: [{name: a, value: $(var uri)}]}"
    (tmp_path / "a.launch.yaml").write_text(f"launch: [{{arg: {{name: uri, default: ''}}}}, {{node: {node}}}]\n")
    assert load(tmp_path / "a.launch.yaml", [], {}).nodes[0].params["a"].value == ""
