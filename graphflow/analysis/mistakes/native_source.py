"""Mistakes in the source of a node class, as far as the source alone shows them."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping
from typing import Final

from graphflow.analysis.mistakes.calls.background_work import background_work
from graphflow.analysis.mistakes.calls.blocking_async import blocking_async
from graphflow.analysis.mistakes.calls.misgiven import misgiven
from graphflow.analysis.mistakes.calls.misplaced import misplaced
from graphflow.analysis.mistakes.calls.separate_groups import separate_groups
from graphflow.analysis.mistakes.checks import IN_CODE, IN_FILES, Found
from graphflow.analysis.mistakes.values.added_arrays import added_arrays
from graphflow.analysis.mistakes.values.message_values import message_values
from graphflow.analysis.mistakes.values.returning_checks import returning_checks
from graphflow.analysis.swallowed import caught_in_vain, endless_loops

_IN_CLASSES: Final[tuple[Callable[[ast.ClassDef], Found], ...]] = (
    misgiven,
    misplaced,
    separate_groups,
    added_arrays,
    caught_in_vain,
    endless_loops,
    returning_checks,
    blocking_async,
    background_work,
)
"""Checks of native nodes alone."""


def slips(definition: ast.ClassDef, module: ast.Module, subscribed: Mapping[str, str]) -> Iterator[tuple[int, str]]:
    """Yield the lines of a class that Python runs without an error and without effect, each with a sentence.

    Args:
        module: The file with the definition.
        subscribed: The methods of the class that receive messages, each with the name of the type.
    """
    for check in (*IN_CODE, *_IN_CLASSES):
        yield from check(definition)
    yield from message_values(definition, subscribed)
    lines = range(definition.lineno, (definition.end_lineno or 0) + 1)
    for of_file in IN_FILES:
        yield from (found for found in of_file(module) if found[0] in lines)
