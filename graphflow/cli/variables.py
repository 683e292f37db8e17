"""The environment variables that graphflow reads, and misspellings of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from graphflow.names import nearest

PREFIX = "GRAPHFLOW_"
KNOWN = (
    *("CONNECT", "DOMAIN", "LOG", "LOOP", "NET", "PORTABLE", "RACES", "RENDEZVOUS", "SHARED_MEMORY", "WIRE"),
    *("PREFIX", "THEME"),  # read by the console
    *("ENDS_WITH", "PARAM_PLACES", "PYTHON"),  # set by graphflow for its own processes
)
"""Names of the variables, without the prefix."""


def misspelt(variables: Iterable[str]) -> Iterator[str]:
    """Yield a sentence on each variable that is not read but resembles one that is."""
    for variable in variables:
        word = variable.removeprefix(PREFIX)
        if word != variable and word not in KNOWN and (meant := nearest(word, KNOWN, cutoff=0.75)) is not None:
            yield f"nothing reads {variable}; did you mean {PREFIX}{meant}?"
