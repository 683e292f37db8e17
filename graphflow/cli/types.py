"""When the type on the command line and the type in the graph are not the same."""

from __future__ import annotations

from graphflow.cli import output
from graphflow.cli.exits import UsageFault


def agree(given: str, actual: str, name: str) -> str:
    """The type to use: the graph's, when the given one has the same definition under another name.

    Raises:
        UsageFault: They are two different types.
    """
    if given == actual:
        return actual
    from graphflow.msgs import registry

    # turtlesim and turtlesim_msgs hold the same types under two names.
    if registry.definition_file(given) == registry.definition_file(actual):
        output.talk(f"note: {name} is a {actual}; using that")
        return actual
    raise UsageFault(f"{name} is a {actual}, not a {given}")
