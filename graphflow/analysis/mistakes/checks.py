"""The checks that native nodes and programs for rclpy have in common."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable
from functools import partial
from typing import Final, TypeAlias

from graphflow.analysis.mistakes.calls.busy_loops import busy_loops
from graphflow.analysis.mistakes.calls.called_early import results_passed
from graphflow.analysis.mistakes.calls.defined_twice import defined_twice
from graphflow.analysis.mistakes.calls.hidden_logs import hidden_logs
from graphflow.analysis.mistakes.calls.kept_locks import kept_locks
from graphflow.analysis.mistakes.calls.silent_excepts import silent_excepts
from graphflow.analysis.mistakes.calls.single_transforms import single_transforms
from graphflow.analysis.mistakes.units.contrary_names import contrary_names
from graphflow.analysis.mistakes.units.literal_units import literal_units
from graphflow.analysis.mistakes.units.lone_nanoseconds import lone_nanoseconds
from graphflow.analysis.mistakes.units.mixed_angles import mixed_angles
from graphflow.analysis.mistakes.units.nanoseconds import compared_nanoseconds
from graphflow.analysis.mistakes.units.quaternions import angles_as_quaternions
from graphflow.analysis.mistakes.units.wrong_scale import wrong_scale
from graphflow.analysis.mistakes.values.conditions import constant_conditions
from graphflow.analysis.mistakes.values.contrary_bounds import contrary_bounds
from graphflow.analysis.mistakes.values.ineffective import ineffective
from graphflow.analysis.mistakes.values.lasting_counters import lasting_counters
from graphflow.analysis.mistakes.values.lost_values import lost_values
from graphflow.analysis.mistakes.values.never_exact import never_exact
from graphflow.analysis.mistakes.values.reused_objects import reused_objects
from graphflow.analysis.mistakes.values.unformatted import unformatted
from graphflow.analysis.uncalled import uncalled_methods

Found: TypeAlias = Iterable[tuple[int, str]]
"""Lines, each with a sentence."""

IN_CODE: Final[tuple[Callable[[ast.AST], Found], ...]] = (
    uncalled_methods,
    ineffective,
    defined_twice,
    partial(results_passed, is_of_threads=True),
    reused_objects,
    angles_as_quaternions,
    busy_loops,
    kept_locks,
    lone_nanoseconds,
    single_transforms,
    unformatted,
)
"""Checks of any code, such as one class."""

IN_FILES: Final[tuple[Callable[[ast.Module], Found], ...]] = (
    compared_nanoseconds,
    mixed_angles,
    constant_conditions,
    contrary_bounds,
    lasting_counters,
    lost_values,
    never_exact,
    contrary_names,
    literal_units,
    silent_excepts,
    hidden_logs,
    wrong_scale,
)
"""Checks that also read the imports and names of the whole file."""
