"""The nodes that come with graphflow, under a name that a project's own `nodes/` cannot hide."""

from graphflow.workspace.project import add_interfaces, demos_root

add_interfaces(demos_root())
__path__ = [str(demos_root() / "nodes")]
