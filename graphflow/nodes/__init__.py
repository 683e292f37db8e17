"""The nodes that come with graphflow, by a name that no project's `nodes/` can take: `graphflow.nodes.turtlesim`."""

from graphflow.workspace.project import add_interfaces, demos_root

add_interfaces(demos_root())
__path__ = [str(demos_root() / "nodes")]
