"""Conversion of ROS's component containers to nodes that share a process.

node_container: {name: c, composable_node: [{pkg: composition, plugin: "composition::Talker"}]}
->  /talker: {class: nodes.talker:Talker, process: c}
"""

from __future__ import annotations

from pathlib import Path

from graphflow.launchfiles.settings import conditions
from graphflow.markup.source import Complain
from graphflow.markup.tree import Item, items
from graphflow.names import did_you_mean
from graphflow.workspace import executables

_ANY = {"if", "unless"}
_OF_CONTAINERS = {"args", "ros_args", "param", "remap", "env", "respawn", "respawn_delay", "on_exit", "launch-prefix"}
"""Attributes of a container that only its nodes can have in a graph file."""
KNOWN = {
    "node_container": {"pkg", "exec", "name", "namespace", "composable_node", "output", *_OF_CONTAINERS, *_ANY},
    "load_composable_node": {"target", "composable_node", *_ANY},
}
"""The actions on containers, with their attributes."""
_OF_NODES = ("name", "namespace", "param", "remap")


def components(item: Item, root: Path, complain: Complain, leave_out: Complain) -> list[Item]:
    """Convert the nodes of a container to actions of their own.

    Args:
        root: The project's folder.
        complain: Called with faults.
        leave_out: Called with components that are not installed, and with attributes that only a container has.
    """
    container = item.entries.get("name") or item.entries.get("target")
    if container is None or not isinstance(container.value, str):
        complain(item.at, "the attribute 'name' or 'target' is missing")
        return []
    for key in sorted(_OF_CONTAINERS & item.entries.keys()):
        text = f"{key}: left out, since a container is a process that nodes share; write it at the nodes"
        leave_out(item.entries[key].at, text)
    process = container.with_value(container.value.rstrip("/").rpartition("/")[2])
    found = []
    for component in items(item.entries.get("composable_node")):
        package, plugin = component.entries.get("pkg"), component.entries.get("plugin")
        if package is None or plugin is None:
            complain(component.at, "composable_node: the attributes 'pkg' and 'plugin' are needed")
            continue
        name = str(plugin.value).rpartition("::")[2].lower()
        if executables.find(str(package.value), name, root) is None:
            known = [name for owner, name in executables.with_graphflow() if owner == package.value]
            text = f"no node here is the component {plugin.value} of the package {package.value}"
            if near := did_you_mean(name, known):
                complain(plugin.place, f"composable_node: {text}{near}")
            else:
                leave_out(plugin.place, f"{plugin.value} is left out: {text}")
            continue
        entries = {key: component.entries[key] for key in _OF_NODES if key in component.entries}
        entries |= conditions(item, component)
        entries |= {"pkg": package, "exec": plugin.with_value(name), "process": process}
        found.append(component.with_value(entries))
    return found
