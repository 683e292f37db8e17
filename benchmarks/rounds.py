"""Interleaved rounds: every contender runs once a round, and ratios are taken within a round before the median."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Mapping


def compare(
    contenders: Mapping[str, Callable[[], float]], rounds: int, unit: str, baseline: str
) -> dict[str, tuple[float, float]]:
    """Measure all contenders `rounds` times in turn, print a table, and return (median, median ratio) by name.

    Args:
        contenders: Functions that measure once and return a number of `unit`s.
        baseline: The contender that ratios are taken to.
    """
    results: dict[str, list[float]] = {name: [] for name in contenders}
    for i in range(rounds):
        # Turn the order round every time, so that nobody always follows the same neighbour.
        for name in list(contenders)[:: 1 if i % 2 else -1]:
            results[name].append(contenders[name]())
    found = {}
    print(f"{'':28}{'median':>12} {unit:<8}{'ratio':>8}   ({rounds} interleaved rounds, ratio to {baseline})")
    for name, values in results.items():
        ratio = statistics.median(v / b for v, b in zip(values, results[baseline], strict=True))
        found[name] = (statistics.median(values), ratio)
        print(f"{name:28}{found[name][0]:12.2f} {unit:<8}{ratio:8.2f}")
    return found


def goal(what: str, value: float, limit: float, *, at_least: bool = False) -> None:
    """Print whether a goal is met."""
    met = value >= limit if at_least else value <= limit
    print(f"goal: {what} {'>=' if at_least else '<='} {limit:g}: {value:.2f}  {'met' if met else 'MISSED'}")
