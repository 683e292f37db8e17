"""The environment variables that graphflow reads, and those that are misspellings of one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from graphflow.names import nearest

PREFIX = "GRAPHFLOW_"
KNOWN = (
    *("CONNECT", "DOMAIN", "LOG", "LOOP", "NET", "PORTABLE", "RACES", "RENDEZVOUS", "SHARED_MEMORY", "WIRE"),
    *("PREFIX", "THEME"),  # of the console
    *("ENDS_WITH", "PYTHON"),  # between processes of graphflow's own
)
"""Without the prefix."""


def misspelt(variables: Iterable[str]) -> Iterator[str]:
    """A sentence on each variable that nothing reads, and that is like one that something does."""
    for variable in variables:
        word = variable.removeprefix(PREFIX)
        if word != variable and word not in KNOWN and (meant := nearest(word, KNOWN, cutoff=0.75)) is not None:
            yield f"nothing reads {variable}; did you mean {PREFIX}{meant}?"
