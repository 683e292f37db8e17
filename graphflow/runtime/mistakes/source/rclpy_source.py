"""Mistakes in the source of a program for rclpy: for the program itself as it runs, and for `graphflow check`.

`slips` has those that nothing else would report while it runs; `foreseen` has those that are reported as they occur.
"""

from __future__ import annotations

import ast

from graphflow.analysis.rclpy_futures import early_questions
from graphflow.analysis.uncalled import misspelt_main, uncalled_methods
from graphflow.runtime.mistakes.source.after_spin import after_spin
from graphflow.runtime.mistakes.source.busy_loops import busy_loops
from graphflow.runtime.mistakes.source.called_early import results_passed, spins_called
from graphflow.runtime.mistakes.source.cancelled_futures import cancelled_futures
from graphflow.runtime.mistakes.source.conditions import constant_conditions
from graphflow.runtime.mistakes.source.contrary_names import contrary_names
from graphflow.runtime.mistakes.source.defined_twice import defined_twice
from graphflow.runtime.mistakes.source.ineffective import ineffective
from graphflow.runtime.mistakes.source.literal_units import literal_units
from graphflow.runtime.mistakes.source.lone_nanoseconds import lone_nanoseconds
from graphflow.runtime.mistakes.source.lost_values import lost_values
from graphflow.runtime.mistakes.source.message_values import message_values, subscribed
from graphflow.runtime.mistakes.source.misgiven import misgiven
from graphflow.runtime.mistakes.source.misplaced import replaced_methods
from graphflow.runtime.mistakes.source.mixed_angles import mixed_angles
from graphflow.runtime.mistakes.source.mixed_interfaces import mixed_interfaces
from graphflow.runtime.mistakes.source.names_in_pairs import names_in_pairs
from graphflow.runtime.mistakes.source.nanoseconds import compared_nanoseconds
from graphflow.runtime.mistakes.source.never_equal import never_exact
from graphflow.runtime.mistakes.source.old_parameters import old_parameters
from graphflow.runtime.mistakes.source.quaternions import angles_as_quaternions
from graphflow.runtime.mistakes.source.reused_objects import reused_objects
from graphflow.runtime.mistakes.source.wrong_scale import wrong_scale


def slips(module: ast.Module) -> list[tuple[int, str]]:
    """Return the lines of a file that Python runs without an error and without effect, each with a sentence."""
    found = [*uncalled_methods(module), *misgiven(module, "executor.create_task({})"), *ineffective(module)]
    found += [*results_passed(module, is_of_threads=True), *compared_nanoseconds(module), *mixed_angles(module)]
    found += [*constant_conditions(module), *defined_twice(module), *lost_values(module), *never_exact(module)]
    found += [*contrary_names(module), *literal_units(module), *replaced_methods(module), *early_questions(module)]
    found += [*reused_objects(module), *angles_as_quaternions(module), *busy_loops(module), *after_spin(module)]
    found += [*message_values(module, subscribed(module))]
    found += [*cancelled_futures(module), *lone_nanoseconds(module), *mixed_interfaces(module)]
    found += [*old_parameters(module), *wrong_scale(module), *names_in_pairs(module)]
    return found


def foreseen(module: ast.Module) -> list[tuple[int, str]]:
    """Return the lines of a file that fail, or do the wrong thing, when the program comes to them."""
    found = [(early.line, early.text) for early in spins_called(module)]
    return [*found, *results_passed(module, is_of_threads=False), *misspelt_main(module)]
