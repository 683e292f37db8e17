"""Types on the command line: the project's own are known, and may differ from those in the graph."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from graphflow.cli import output
from graphflow.errors import UsageFault
from graphflow.names import did_you_mean


def use_project() -> None:
    """Make the interfaces of the project around the working directory known."""
    from pathlib import Path

    from graphflow.graph.project import add_interfaces, project_root

    add_interfaces(project_root(Path.cwd()))


def names_of_type(names: Mapping[str, list[str]], type_name: str, *, only_count: bool) -> list[str]:
    """What `find` prints: the names that have a type, or how many.

    Args:
        names: Names with their types.
        type_name: `package/kind/Name` or `package/Name`.
    """
    package, _, base = type_name.partition("/")
    wanted = {type_name, *(f"{package}/{kind}/{base}" for kind in ("msg", "srv", "action"))}
    found = [name for name, types in names.items() if wanted & {*types}]
    if not found:
        near = did_you_mean(type_name, {type_ for types in names.values() for type_ in types})
        output.talk(f"nothing is of type {type_name}{near}")
    return [str(len(found))] if only_count else found


def agree(given: str, known: Collection[str], name: str) -> str:
    """The type to use: one of the graph's, also when the given one has the same definition under another name.

    Args:
        known: The types that nodes announce for the name.

    Raises:
        UsageFault: It has none that would do.
    """
    if given in known:
        return given
    from graphflow.msgs import registry

    for actual in known:
        # turtlesim and turtlesim_msgs hold the same types under two names.
        same = given.split("/")[1:] == actual.split("/")[1:]
        if same and registry.definition(given) == registry.definition(actual):
            output.talk(f"note: {name} is of type {actual}; using that")
            return actual
    raise UsageFault(f"{name} is of type {' and '.join(known)}, not {given}")
