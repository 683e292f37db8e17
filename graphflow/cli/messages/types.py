"""Types on the command line: find the project's own, and compare given types with those of the graph."""

from __future__ import annotations

import shlex
from collections.abc import Collection, Mapping

from graphflow.cli import output
from graphflow.errors import GraphflowError, UsageFault
from graphflow.names import did_you_mean


def use_project() -> None:
    """Register the interfaces of the project around the working directory."""
    from pathlib import Path

    from graphflow.workspace.project import add_interfaces, project_root

    add_interfaces(project_root(Path.cwd()))


def names_of_type(names: Mapping[str, list[str]], type_name: str, *, only_count: bool) -> list[str]:
    """Return the names that have a type, or their number, as the verbs `find` print them.

    Args:
        names: Names with their types.
        type_name: `package/kind/Name` or `package/Name`.
    """
    from graphflow.msgs.registry import having

    package, _, base = type_name.partition("/")
    wanted = {type_name, *(f"{package}/{kind}/{base}" for kind in ("msg", "srv", "action"))}
    found = [name for name, types in names.items() if wanted & {*types}]
    if not found:
        near = did_you_mean(type_name, {type_ for types in names.values() for type_ in types})
        meant = [full for full in having(type_name) if any(full in types for types in names.values())]
        output.talk(f"nothing is of type {type_name}{f'; did you mean {meant[0]!r}?' if meant else near}")
    return [str(len(found))] if only_count else found


def type_of_word(
    word: str, name: str, known: Collection[str], others: Collection[str] = (), command: str = "", rest: str = ""
) -> str:
    """Return the full name of the type that a word of the command line gives.

    Args:
        word: The word in the place of the type of `name`.
        known: The types that nodes announce for the name.
        others: Other names of the graph, one of which may have been meant.
        command: Such as `service call`, for the suggested command.
        rest: The values as they were probably meant, if the word is one of them.

    Raises:
        UsageFault: It is not a type; the text suggests the right command.
    """
    from graphflow.msgs import registry

    try:
        return registry.full_name(word)
    except GraphflowError as error:
        other = f"/{word.lstrip('/')}"
        if word.startswith("/") or other in others:
            why = f"{other} needs a command of its own, in another terminal"
        elif known:
            why = f"its type is {' and '.join(known)}"
            if command and len(known) == 1 and "/" not in word:
                why += f": graphflow {command} {name} {next(iter(known))} {rest or '...'}"
        else:
            why = str(error)
        raise UsageFault(f"{word!r} was read as the type of {name}; {why}") from None


def check_kind(type_name: str, kind: str) -> None:
    """Check that a type is of the kind that a command takes: a message, a service or an action.

    Args:
        kind: `msg`, `srv` or `action`.

    Raises:
        UsageFault: It is of another kind; the text names the command for that.
    """
    from graphflow.msgs.registry import CALLED

    _, actual, name = type_name.split("/")
    if actual == kind or "_" in name:  # a derived type, such as Spawn_Request or RotateAbsolute_SendGoal
        return
    verb = {"msg": "topic pub", "srv": "service call", "action": "action send_goal"}[actual]
    raise UsageFault(f"{type_name} is {CALLED[actual]}, not {CALLED[kind]}; graphflow {verb} takes such types")


def check_order(name: str, type_name: str | None, command: str) -> None:
    """Check that the name comes first and the type after it.

    Args:
        command: Such as `topic pub`, for the suggested command.

    Raises:
        UsageFault: They are the other way round, or the values come first.
    """
    if name.startswith("{"):
        first = shlex.join(["graphflow", *command.split(), type_name or "NAME", "TYPE", name])
        raise UsageFault(f"the values come last, after the name and its type: {first}")
    if type_name is not None and type_name.startswith("/") and not name.startswith("/") and "/" in name:
        raise UsageFault(f"the name comes first, then its type: graphflow {command} {type_name} {name} ...")


def agree(given: str, known: Collection[str], name: str) -> str:
    """Return the type to use: the graph's, also if the given one has the same definition under another name.

    Args:
        known: The types that nodes announce for the name.

    Raises:
        UsageFault: None of them agrees with the given type.
    """
    if given in known:
        return given
    from graphflow.msgs import registry

    for actual in known:
        # turtlesim and turtlesim_msgs define the same types under two names.
        same = given.split("/")[1:] == actual.split("/")[1:]
        if same and registry.definition(given) == registry.definition(actual):
            output.talk(f"note: {name} is of type {actual}; using that")
            return actual
    raise UsageFault(f"{name} is of type {' and '.join(known)}, not {given}")
