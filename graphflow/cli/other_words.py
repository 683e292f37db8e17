"""Commands of ROS 1 and misremembered ones of ROS 2, with the command to type or the reason that there is none."""

from __future__ import annotations

import re
import shlex
from collections.abc import Sequence

from graphflow.cli.substitutes import ROBOT_VIEWS

_INIT = "graphflow init NAME creates a project, and graphflow pkg create NAME a package"
_LINES = {
    "action call": "action send_goal",
    "action feedback": "action echo",
    "action goal": "action send_goal",
    "action send": "action send_goal",
    "action show": "interface show",
    "action status": "topic echo {0}/_action/status",
    "bag compress": "bag convert --compression zstd",
    "bag decompress": "bag convert --compression none",
    "bag fix": "bag recover",
    "bag list": "bag info",
    "bag show": "bag info",
    "bw": "topic bw",
    "call": "service call",
    "catkin_create_pkg": "pkg create",
    "create": "init",
    "delay": "topic delay",
    "echo": "topic echo",
    "hz": "topic hz",
    "interface describe": "interface show",
    "interface print": "interface show",
    "interface type": "interface show",
    **{f"lifecycle {way}": f"lifecycle set {{0}} {way}" for way in ("configure", "activate", "deactivate", "cleanup")},
    "lifecycle shutdown": "lifecycle set {0} shutdown",
    "lifecycle change": "lifecycle set",
    "lifecycle state": "lifecycle get",
    "message": "interface",
    "msg": "interface",
    "msg info": "interface show",
    "msg list": "interface list -m",
    "new": "init",
    "node describe": "node info",
    "node machine": "node list",
    "node ping": "node info",
    "node show": "node info",
    "param show": "param describe",
    "param info": "param describe",
    "pkg executable": "pkg executables",
    "pkg find": "pkg prefix",
    "pkg new": "pkg create",
    "pkg init": "pkg create",
    "play": "bag play",
    "plot": "topic plot",
    "pub": "topic pub",
    "publish": "topic pub",
    "record": "bag record",
    "rosaction": "action",
    "rosbag": "bag",
    "roscreate-pkg": "pkg create",
    "roslaunch": "launch",
    "rosmsg": "interface",
    "rosmsg info": "interface show",
    "rosmsg list": "interface list -m",
    "rosmsg packages": "interface packages",
    "rosnode": "node",
    "rosnode ping": "node info",
    "rosnode kill": "stop",
    "rospack": "pkg",
    "rospack find": "pkg prefix",
    "rosparam": "param",
    "rosrun": "run",
    "rosservice": "service",
    "rosservice info": "service type",
    "rossrv": "interface",
    "rossrv info": "interface show",
    "rossrv list": "interface list -s",
    "rostopic": "topic",
    "rosversion": "--version",
    "roswtf": "doctor",
    "rqt": "console",
    "rqt_console": "console",
    "rqt_graph": "graph",
    "rqt_plot": "topic plot",
    "rqt_bag": "bag info",
    "send_goal": "action send_goal",
    "service show": "interface show",
    "service request": "service call",
    "service send": "service call",
    "srv": "interface",
    "srv info": "interface show",
    "srv list": "interface list -s",
    "topic describe": "topic info",
    "topic freq": "topic hz",
    "topic frequency": "topic hz",
    "topic rate": "topic hz",
    "topic listen": "topic echo",
    "topic monitor": "topic echo",
    "topic show": "topic echo",
    "topic sub": "topic echo",
    "topic subscribe": "topic echo",
    "topic publish": "topic pub",
    "topic send": "topic pub",
    "version": "--version",
}
"""Our verb, which the remaining words follow; or a whole command, in which `{0}` is the first of them."""
_NO_CORE = "none is needed: nodes find each other, and each machine starts its own rendezvous"
_TOPICS = "a topic exists as soon as a node publishes or subscribes to it"
_RENAMED = "names are changed when a node is started: graphflow run NODE -r OLD:=NEW"
_SENTENCES = {
    **dict.fromkeys(("core", "roscore", "master", "rosmaster"), _NO_CORE),
    **dict.fromkeys(("topic create", "topic add", "topic delete", "topic remove"), _TOPICS),
    **dict.fromkeys(("topic remap", "remap", "topic rename", "node rename"), _RENAMED),
    "action cancel": (
        "Ctrl-C in graphflow action send_goal cancels its goal; to cancel all goals of an action: graphflow "
        "service call {0}/_action/cancel_goal action_msgs/srv/CancelGoal"
    ),
    "action result": "graphflow action send_goal prints the result of its goal",
    "bag stop": "Ctrl-C in its terminal ends a recording",
    "bag pause": "the space bar in its terminal pauses it",
    "node cleanup": "none is needed: a node that has ended is not listed",
    "rosnode cleanup": "none is needed: a node that has ended is not listed",
    "node create": "a node is a class in a file: graphflow init NAME writes one, and graphflow run FILE.py runs it",
    "test": "tests are run by pytest: python -m pytest",
    "rostest": "tests are run by pytest: python -m pytest",
    **dict.fromkeys(("rviz", "rviz2"), ROBOT_VIEWS),
    **dict.fromkeys(("gazebo", "gz", "ign"), "in its place there is a simulator on MuJoCo: graphflow up tb_sim"),
    **dict.fromkeys(("roscd", "rosls", "rosed"), "graphflow pkg prefix --share PACKAGE prints where a package is"),
    "rosclean": "each run has its own folder of logs: graphflow logs shows them",
    "setup": "nothing has to be set up or sourced: graphflow init NAME creates a project",
}
_OPTIONS = {
    **dict.fromkeys(("topic echo --count", "topic echo -1"), "--once shows a single message"),
    "topic echo -p": "--csv prints comma-separated values",
    **dict.fromkeys(("param list --node", "param list -n"), "the node is an argument: graphflow param list NODE"),
    **dict.fromkeys(
        (
            "param dump -o",
            "param dump --output",
            "param dump --output-dir",
            "param dump --output-file",
            "param dump -f",
        ),
        "the output is printed; to save it: graphflow param dump NODE > FILE.yaml",
    ),
    **dict.fromkeys(("bag record -j", "bag record --bz2", "bag record --lz4"), "write --compression zstd"),
    **dict.fromkeys(("bag record --name", "bag record --bag-name", "bag record -n"), "-o names the bag's folder"),
    **dict.fromkeys(("bag record --split", "bag record --size"), "--max-bag-size BYTES starts another file"),
    "bag play -u": "--playback-duration limits the seconds to play",
    **dict.fromkeys(("bag play -i", "bag play --immediate"), "graphflow bag burst publishes all at once"),
    **dict.fromkeys(
        ("restart --all", "restart -a"),
        "to restart the whole graph: graphflow up GRAPH.yaml --replace, or name the nodes",
    ),
    **dict.fromkeys(("stop --all", "stop -a"), "to stop the whole graph: graphflow down"),
    **dict.fromkeys(("launch --screen", "launch --log", "launch -v"), "leave it out: nodes' output is always shown"),
    **dict.fromkeys(
        ("logs --tail", "logs --last", "logs -t", "logs --num", "logs --count"),
        "-n 5 shows the last 5 lines of each node",
    ),
    **dict.fromkeys(("logs --graph-name", "logs --name"), "--graph NAME chooses the graph"),
    "launch --wait": "leave it out: there is no master to wait for",
}
"""Options of other tools by our verb, and what to type instead."""
_TYPE = re.compile(r"\A([a-z]\w*)/([A-Z]\w*)\Z")
_PRIVATE = re.compile(r"\A_(?=[a-z])(\w+):=")
_NAMED = re.compile(r"\A__(name|ns):=")
"""A private parameter and a node's name, as written in ROS 1."""
_KINDS = {"msg": "msg", "rosmsg": "msg", "message": "msg", "srv": "srv", "rossrv": "srv"}


def answer(path: str, words: Sequence[str]) -> str:
    """Return the error text for words that are not a command; empty if they are not known.

    Args:
        path: The verbs before them, as in `topic`; empty at the top.
        words: The unknown word and those after it.
    """
    word, whole = words[0], [*path.split(), *words]
    for count in range(min(2, len(whole)), len(path.split()), -1):
        key, behind = " ".join(whole[:count]), whole[count:]
        if key in _SENTENCES:
            return f"no such command {word!r}: {_with(_SENTENCES[key], behind, 'NAME')}"
        if key in ("create", "new") and not behind:
            return f"no such command {word!r}: {_INIT}"
        if key in _LINES:
            return f"no such command {word!r}; did you mean: graphflow {_line(key, behind)}"
    if word == "help":
        line = " ".join([*path.split(), *words[1:], "--help"])
        return f"no such command 'help'; did you mean: graphflow {line}"
    if path == "interface" and "/" in word:
        return f"no such command {word!r}; did you mean: graphflow interface show {word}"
    return ""


def option_answer(path: str, option: str) -> str:
    """Return what to use instead of an option that a verb does not have; empty if the option is not known."""
    return _OPTIONS.get(f"{path} {option}", "")


def _line(key: str, words: Sequence[str]) -> str:
    """Return the whole command, with types in ROS 2's notation."""
    kind = _KINDS.get(key.partition(" ")[0])
    if kind is not None:
        words = [_TYPE.sub(rf"\1/{kind}/\2", word) for word in words]
    if key in ("rosrun", "roslaunch"):
        words = [_PRIVATE.sub(r"-p \1:=", _NAMED.sub(_renamed, word)) for word in words]
        return " ".join([_LINES[key], *words])
    line = _LINES[key]
    if "{0}" in line:
        return _with(line, words, "NAME")
    return " ".join([line, *map(shlex.quote, words)])


def _renamed(found: re.Match[str]) -> str:
    return f"-r __{'node' if found[1] == 'name' else 'ns'}:="


def _with(text: str, words: Sequence[str], otherwise: str) -> str:
    """Replace `{0}` in a text with the first of some words that is not an option."""
    return text.replace("{0}", next((word for word in words if not word.startswith("-")), otherwise))
