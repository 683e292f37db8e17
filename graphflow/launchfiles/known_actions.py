"""The launch actions and attributes that a graph file can express, and the faults of others."""

from __future__ import annotations

from graphflow.launchfiles.attributes import shape_fault
from graphflow.launchfiles.components import KNOWN as CONTAINERS
from graphflow.markup import ros1_words
from graphflow.markup.source import Complain
from graphflow.markup.tree import Item
from graphflow.names import did_you_mean

CONDITIONS = ("if", "unless")
"""Attributes that any action may have."""
_IGNORED = {"output", "emulate_tty", "sigterm_timeout", "sigkill_timeout", "exec_name", "log_cmd"}
"""Attributes without an effect here: output is always logged, and stopping is always the same."""
RECORDED = ("number", "after_number", "after_what", "brought_to")
"""Attributes that `recorded` adds to those of the YAML dialect; see `Action.relations`."""
_RUN = {
    *RECORDED,
    "launch-prefix",
    "name",
    "env",
    "respawn",
    "respawn_delay",
    "respawn_max_retries",
    "on_exit",
    *CONDITIONS,
    *_IGNORED,
}
_KNOWN: dict[str, set[str]] = {
    "arg": {"name", "default", "description", "choice", *CONDITIONS},
    "let": {"name", "value", *CONDITIONS},
    "set_env": {"name", "value", *CONDITIONS},
    "append_env": {"name", "value", "prepend", "separator", *CONDITIONS},
    "group": {"children", "scoped", "forwarding", "keep", *CONDITIONS, *RECORDED},
    "include": {"file", "arg", "let", *CONDITIONS, *RECORDED},
    "node": {"pkg", "exec", "namespace", "args", "ros_args", "remap", "param", "autostart", *_RUN},
    **CONTAINERS,
    "executable": {"cmd", "cwd", "shell", *_RUN},
    "push_ros_namespace": {"namespace", *CONDITIONS},
    "set_parameter": {"name", "value", "type", *CONDITIONS},
    "set_parameters_from_file": {"filename", *CONDITIONS},
    "set_remap": {"from", "to", *CONDITIONS},
    "set_use_sim_time": {"value", *CONDITIONS},
    "timer": {"period", "children", *CONDITIONS, *RECORDED},
    "log": {"message", "level", *CONDITIONS, *RECORDED},
    "shutdown": {"reason", *CONDITIONS, *RECORDED},
}
"""Actions that a graph file can express, with their attributes."""
KNOWN_ACTIONS = frozenset(_KNOWN)
SAME = {"ros_timer": "timer", "push-ros-namespace": "push_ros_namespace", "lifecycle_node": "node"}
"""Other names of actions."""
_ELSEWHERE = {
    "unset_env": "write env: in a group or at a node",
    "reset_env": "write env: in a group or at a node",
    "set_ros_log_dir": "set the environment variable ROS_LOG_DIR",
}
FORMER = {"type": "exec", "package": "pkg", "executable": "exec", "ns": "namespace"}
"""Attributes by their names in launch files in Python, and in some of ROS 1."""


def no_action(item: Item) -> str:
    """Return the fault of an item of a list of actions that is none."""
    for name, attributes in item.entries.items():
        if attributes.value is None and SAME.get(name, name) in _KNOWN:
            return f"the attributes of {name}: stand below it: indent them further than {name}:"
    return f"expected an action, for example node: {{pkg: turtlesim, exec: turtlesim_node}}, got {item.plain()!r}"


def is_known(name: str, item: Item, complain: Complain) -> bool:
    """Check an action; returns whether it can be converted, perhaps without some of its attributes.

    Args:
        complain: Called with each fault.
    """
    if name not in _KNOWN:
        complain(item.at, _unknown_action(name))
        return False
    if not isinstance(item.value, dict):
        complain(item.place, f"{name}: expected a mapping of its attributes, got {item.plain()!r}")
        return False
    for key, value in item.entries.items():
        if key not in _KNOWN[name]:
            complain(value.at, _unknown_attribute(name, key, value.value))
        elif (fault := shape_fault(key, value)) is not None:
            complain(value.place, f"{name}: {fault}")
    return True


def _unknown_action(name: str) -> str:
    if former := ros1_words.action(name):
        return f"<{name}> {former}"
    hint = _ELSEWHERE.get(name)
    near = f": {hint}" if hint else did_you_mean(name, _KNOWN)
    return f"the action {name!r} has no equivalent in a graph file{near}"


def _unknown_attribute(name: str, key: str, value: object) -> str:
    known = sorted(_KNOWN[name] - _IGNORED - {*RECORDED, "children"})
    ours = FORMER.get(key, "")
    former = ros1_words.attribute(name, key, value) or (f"it is called {ours!r} here" if ours in known else "")
    hint = f"; {former}" if former else did_you_mean(key, known) or f"; there is {', '.join(known)}"
    return f"{name}: unknown attribute {key!r}{hint}"
