"""Commands of ROS 1, and ones that a user of ROS 2 half remembers: each with the line to type, or why there is none."""

from __future__ import annotations

import re
import shlex
from collections.abc import Sequence

_INIT = "graphflow init NAME makes a project, and graphflow pkg create NAME a package"
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
"""The verb that the words behind them follow, or the whole line where it has a place for the first of them."""
_NO_CORE = "none is needed: nodes find each other, and each machine starts what they meet at by itself"
_THERE = "a topic is there as soon as a node publishes it or subscribes to it"
_RENAMED = "names are changed where a node is started: graphflow run NODE -r OLD:=NEW"
_SENTENCES = {
    **dict.fromkeys(("core", "roscore", "master", "rosmaster"), _NO_CORE),
    **dict.fromkeys(("topic create", "topic add", "topic delete", "topic remove"), _THERE),
    **dict.fromkeys(("topic remap", "remap", "topic rename", "node rename"), _RENAMED),
    "action cancel": (
        "Ctrl-C at graphflow action send_goal cancels its goal; all goals of an action are cancelled by: graphflow "
        "service call {0}/_action/cancel_goal action_msgs/srv/CancelGoal"
    ),
    "action result": "graphflow action send_goal prints the result of its goal",
    "bag stop": "Ctrl-C in its terminal ends a recording",
    "bag pause": "SPACE in its terminal pauses it",
    "node cleanup": "none is needed: a node that has gone is not listed",
    "rosnode cleanup": "none is needed: a node that has gone is not listed",
    "node create": "a node is a class in a file: graphflow init NAME writes one, and graphflow run FILE.py runs it",
    "test": "tests are run by pytest: python -m pytest",
    "rostest": "tests are run by pytest: python -m pytest",
    **dict.fromkeys(("rviz", "rviz2"), "RViz is not here: graphflow view serves the graph to Foxglove and Lichtblick"),
    **dict.fromkeys(("gazebo", "gz"), "no simulator is here but turtlesim: graphflow run turtlesim"),
    **dict.fromkeys(("roscd", "rosls", "rosed"), "graphflow pkg prefix --share PACKAGE prints where a package is"),
    "rosclean": "logs are in folders of their own: graphflow logs shows them",
    "setup": "nothing has to be set up or sourced: graphflow init NAME makes a project",
}
_OPTIONS = {
    **dict.fromkeys(("topic echo --count", "topic echo -1"), "one message is shown by --once"),
    "topic echo -p": "values separated by commas are shown by --csv",
    **dict.fromkeys(("param list --node", "param list -n"), "the node stands by itself: graphflow param list NODE"),
    **dict.fromkeys(
        (
            "param dump -o",
            "param dump --output",
            "param dump --output-dir",
            "param dump --output-file",
            "param dump -f",
        ),
        "it is printed, and written into a file by: graphflow param dump NODE > FILE.yaml",
    ),
    **dict.fromkeys(("bag record -j", "bag record --bz2", "bag record --lz4"), "write --compression zstd"),
    **dict.fromkeys(("bag record --name", "bag record --bag-name", "bag record -n"), "the bag's folder is named by -o"),
    **dict.fromkeys(("bag record --split", "bag record --size"), "a new file begins after --max-bag-size BYTES"),
    "bag play -u": "seconds of the bag to play are --playback-duration",
    **dict.fromkeys(("bag play -i", "bag play --immediate"), "all messages at once are sent by: graphflow bag burst"),
    **dict.fromkeys(("launch --screen", "launch --log", "launch -v"), "leave it out: what nodes print is shown"),
    "launch --wait": "leave it out: there is no master to wait for",
}
"""Options of other tools, by the verb."""
_TYPE = re.compile(r"\A([a-z]\w*)/([A-Z]\w*)\Z")
_PRIVATE = re.compile(r"\A_(?=[a-z])(\w+):=")
_NAMED = re.compile(r"\A__(name|ns):=")
"""A private parameter, and a node's name, as ROS 1 has them."""
_KINDS = {"msg": "msg", "rosmsg": "msg", "message": "msg", "srv": "srv", "rossrv": "srv"}


def answer(path: str, words: Sequence[str]) -> str:
    """What to say of words that are no command; empty where that is not known.

    Args:
        path: The verbs before them, as in `topic`; empty at the top.
        words: From the unknown one on.
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
    """What to say of an option that a verb does not have; empty where that is not known."""
    return _OPTIONS.get(f"{path} {option}", "")


def _line(key: str, words: Sequence[str]) -> str:
    """The whole line, with types as they are written now."""
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
    """A text with the first of some words in its place."""
    return text.replace("{0}", next((word for word in words if not word.startswith("-")), otherwise))
