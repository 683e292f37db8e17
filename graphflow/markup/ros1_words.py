"""Actions, attributes and substitutions of ROS 1's launch files that ROS 2 lacks, with their replacements."""

from __future__ import annotations

_ACTIONS = {
    "rosparam": 'write <param from="FILE.yaml"/> in the node',
    "param": 'write it in the node, or <set_parameter name="..." value="..."/> before all nodes',
    "remap": 'write it in the node, or <set_remap from="..." to="..."/> before all nodes',
    "env": 'write it in the node, or <set_env name="..." value="..."/> before all nodes',
    "test": "tests are written with pytest",
    "machine": "all nodes of a graph run on one machine",
    "rosbuild": "leave it out",
    "master": "leave it out, as there is no master",
}
_ATTRIBUTES = {
    "node.type": "it is called 'exec' here",
    "node.required": 'write on_exit="shutdown"',
    "node.machine": "all nodes of a graph run on one machine",
    "node.clear_params": "leave it out, as the parameters of a node end with it",
    "node.cwd": "leave it out, and write whole paths",
    "node.rosparam": 'write <param from="FILE.yaml"/>',
    "group.ns": 'write <push_ros_namespace namespace="..."/> as its first element',
    "group.clear_params": "leave it out, as the parameters of a node end with it",
    "include.ns": 'write a <group> around it, and <push_ros_namespace namespace="..."/> as its first element',
    "include.pass_all_args": "leave it out, as an included file has all arguments",
    "include.clear_params": "leave it out, as the parameters of a node end with it",
    "arg.value": "write default= for one that can be given, and <let .../> in place of <arg .../> for one that cannot",
    "arg.doc": "it is called 'description' here",
    "param.command": "write value=\"$(command '...')\"",
    "param.textfile": 'write value="$(file-content FILE)"',
    "param.binfile": "a parameter cannot be a file's bytes",
}
"""Replacements by the action and its attribute or child element."""
_SUBSTITUTIONS = {"arg": "var", "find": "find-pkg-share"}


def action(name: str) -> str:
    """Return the replacement of an action of ROS 1; empty for others."""
    return f"is ROS 1's: {_ACTIONS[name]}" if name in _ACTIONS else ""


def attribute(of: str, name: str, value: object = None) -> str:
    """Return the replacement of an attribute of ROS 1, with its value where that is kept; empty for others."""
    text = _ATTRIBUTES.get(f"{of}.{name}", "")
    keeps = isinstance(value, str) and name == "ns"
    return text.replace('"..."', f'"{value}"').replace("$(arg ", "$(var ") if keeps else text


def substitution(inside: str) -> str:
    """Return the replacement of a substitution of ROS 1; empty for others.

    Args:
        inside: The text between its parentheses.
    """
    name, _, rest = inside.strip().partition(" ")
    if name in _SUBSTITUTIONS and rest:
        return f"write $({_SUBSTITUTIONS[name]} {rest})"
    return ""
