"""Slips in a file that is written for rclpy: those that are visible without knowing the classes of its nodes."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.uncalled import uncalled_methods
from graphflow.runtime.mistakes.source.called_early import results_passed
from graphflow.runtime.mistakes.source.ineffective import ineffective
from graphflow.runtime.mistakes.source.misgiven import misgiven
from graphflow.runtime.mistakes.source.mixed_angles import mixed_angles
from graphflow.runtime.mistakes.source.nanoseconds import compared_nanoseconds


def slips_in_file(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the lines of such slips; each comes with its correction."""
    yield from uncalled_methods(module)
    yield from misgiven(module, "executor.create_task({})")
    yield from ineffective(module)
    yield from results_passed(module, is_of_threads=True)
    yield from compared_nanoseconds(module)
    yield from mixed_angles(module)
