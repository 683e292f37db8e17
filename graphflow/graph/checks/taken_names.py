"""Names that two nodes or steps of a graph have."""

from __future__ import annotations

from graphflow.errors import Place


def taken(name: str, what: str, at: Place, first: Place, *, is_included: bool, is_absolute: bool) -> str:
    """Return the problem of a name that a node or step has already, and the remedy.

    Args:
        what: `nodes` or `steps`.
        at, first: The places of this one and of the first.
        is_included: Whether this one is in an included file.
        is_absolute: Whether its name has a slash in front that keeps a namespace out.
    """
    if first.file != at.file and what == "steps":
        return f"there is a step {name!r} already, at {first}; give this one another name"
    if first.file != at.file and not is_included:
        return f"{name} is already in the included file; change it under override:"
    if first.file != at.file:
        return f"{name} is already at {first}; give one of them another name, or one include: a namespace"
    if first == at:
        slash = "leave out its slash and " if is_absolute else ""
        return (
            f"this makes the {what[:-1]} {name} more than once: put the loop's variable into its name, or {slash}give "
            "each include: of this file a namespace of its own"
        )
    return f"there are two {what} {name}; the other is on line {first.line}"
