"""Types on the command line: the project's own are known, and may differ from those in the graph."""

from __future__ import annotations

from graphflow.cli import output
from graphflow.errors import UsageFault


def use_project() -> None:
    """Make the interfaces of the project around the working directory known."""
    from pathlib import Path

    from graphflow.graph.project import add_interfaces, project_root

    add_interfaces(project_root(Path.cwd()))


def agree(given: str, actual: str, name: str) -> str:
    """The type to use: the graph's, when the given one has the same definition under another name.

    Raises:
        UsageFault: The two types differ.
    """
    if given == actual:
        return actual
    from graphflow.msgs import registry

    # turtlesim and turtlesim_msgs hold the same types under two names.
    if registry.definition_file(given) == registry.definition_file(actual):
        output.talk(f"note: {name} is of type {actual}; using that")
        return actual
    raise UsageFault(f"{name} is of type {actual}, not {given}")
