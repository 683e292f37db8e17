"""Types on the command line: the project's own are known, and may differ from those in the graph."""

from __future__ import annotations

import shlex
from collections.abc import Collection, Mapping

from graphflow.cli import output
from graphflow.errors import GraphflowError, UsageFault
from graphflow.names import did_you_mean


def use_project() -> None:
    """Make the interfaces of the project around the working directory known."""
    from pathlib import Path

    from graphflow.workspace.project import add_interfaces, project_root

    add_interfaces(project_root(Path.cwd()))


def names_of_type(names: Mapping[str, list[str]], type_name: str, *, only_count: bool) -> list[str]:
    """What `find` prints: the names that have a type, or how many.

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
    """The full name of the type that a word of the command line is.

    Args:
        word: It stands where the type of `name` does.
        known: The types that nodes announce for the name.
        others: Other names of the graph, which the word may have been meant as.
        command: As in `service call`, for the line to type.
        rest: The values as they were meant, if the word is one of them.

    Raises:
        UsageFault: It is no type; the text says what it was taken for.
    """
    from graphflow.msgs import registry

    try:
        return registry.full_name(word)
    except GraphflowError as error:
        other = f"/{word.lstrip('/')}"
        if word.startswith("/") or other in others:
            why = f"{other} needs a command of its own, as in another terminal"
        elif known:
            why = f"that is {' and '.join(known)}"
            if command and len(known) == 1 and "/" not in word:
                why += f": graphflow {command} {name} {next(iter(known))} {rest or '...'}"
        else:
            why = str(error)
        raise UsageFault(f"{word!r} was taken for the type of {name}; {why}") from None


def check_kind(type_name: str, kind: str) -> None:
    """See that a type is a message, a service or an action, as a command takes it.

    Args:
        kind: `msg`, `srv` or `action`.

    Raises:
        UsageFault: It is another; the text names the command for it.
    """
    from graphflow.msgs.registry import CALLED

    _, actual, name = type_name.split("/")
    if actual == kind or "_" in name:  # a part of another, as Spawn_Request or RotateAbsolute_SendGoal
        return
    verb = {"msg": "topic pub", "srv": "service call", "action": "action send_goal"}[actual]
    raise UsageFault(f"{type_name} is {CALLED[actual]}, not {CALLED[kind]}; graphflow {verb} takes such types")


def refuse_turned(name: str, type_name: str | None, command: str) -> None:
    """See that the name comes first, and then its type.

    Args:
        command: As in `topic pub`, for the line to type.

    Raises:
        UsageFault: They are the other way round, or the values come first.
    """
    if name.startswith("{"):
        first = shlex.join(["graphflow", *command.split(), type_name or "NAME", "TYPE", name])
        raise UsageFault(f"the values come last, after the name and its type: {first}")
    if type_name is not None and type_name.startswith("/") and not name.startswith("/") and "/" in name:
        raise UsageFault(f"the name comes first, then its type: graphflow {command} {type_name} {name} ...")


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
