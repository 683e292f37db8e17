"""Mistakes in the source of a program for rclpy: for the program itself as it runs, and for `graphflow check`.

`slips` has those that nothing else would report while it runs; `foreseen` has those that are reported as they occur.
"""

from __future__ import annotations

import ast
from collections.abc import Callable
from functools import partial
from typing import Final

from graphflow.analysis.mistakes.calls.after_spin import after_spin
from graphflow.analysis.mistakes.calls.called_early import results_passed, spins_called
from graphflow.analysis.mistakes.calls.cancelled_futures import cancelled_futures
from graphflow.analysis.mistakes.calls.early_messages import early_messages
from graphflow.analysis.mistakes.calls.forgotten_callbacks import forgotten_callbacks
from graphflow.analysis.mistakes.calls.hidden_methods import hidden_methods
from graphflow.analysis.mistakes.calls.idle_executors import idle_executors
from graphflow.analysis.mistakes.calls.inverted_waits import inverted_waits
from graphflow.analysis.mistakes.calls.lifecycle_hooks import lifecycle_hooks
from graphflow.analysis.mistakes.calls.misgiven import misgiven
from graphflow.analysis.mistakes.calls.misplaced import replaced_methods
from graphflow.analysis.mistakes.calls.mixed_interfaces import mixed_interfaces
from graphflow.analysis.mistakes.calls.nested_spins import nested_spins
from graphflow.analysis.mistakes.calls.single_spins import single_spins
from graphflow.analysis.mistakes.calls.unused_publishers import unused_publishers
from graphflow.analysis.mistakes.checks import IN_CODE, IN_FILES, Found
from graphflow.analysis.mistakes.values.message_values import message_values, subscribed
from graphflow.analysis.mistakes.values.names_in_pairs import names_in_pairs
from graphflow.analysis.mistakes.values.old_parameters import old_parameters
from graphflow.analysis.mistakes.values.parameter_values import parameter_values
from graphflow.analysis.mistakes.values.two_names import two_names
from graphflow.analysis.rclpy_futures import early_questions, early_results
from graphflow.analysis.uncalled import misspelt_main

_IN_PROGRAMS: Final[tuple[Callable[[ast.Module], Found], ...]] = (
    partial(misgiven, starts="executor.create_task({})"),
    replaced_methods,
    early_questions,
    after_spin,
    cancelled_futures,
    mixed_interfaces,
    old_parameters,
    parameter_values,
    names_in_pairs,
    single_spins,
    nested_spins,
    inverted_waits,
    lifecycle_hooks,
    unused_publishers,
    forgotten_callbacks,
    two_names,
    early_results,
    early_messages,
    hidden_methods,
)
"""Checks of programs for rclpy alone."""


def slips(module: ast.Module) -> list[tuple[int, str]]:
    """Return the lines of a file that Python runs without an error and without effect, each with a sentence."""
    found = [slip for check in (*IN_CODE, *IN_FILES, *_IN_PROGRAMS) for slip in check(module)]
    return [*found, *message_values(module, subscribed(module))]


def foreseen(module: ast.Module) -> list[tuple[int, str]]:
    """Return the lines of a file that fail, or do the wrong thing, when the program comes to them."""
    found = [(early.line, early.text) for early in spins_called(module)]
    return [*found, *results_passed(module, is_of_threads=False), *misspelt_main(module), *idle_executors(module)]
