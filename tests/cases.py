"""How many generated cases are tried: by default a few, with `--cases full` many, else N new ones.

`--cases turn` is for CI: as `full`, but each commit has its turn at one part of the slow tests.
"""

from __future__ import annotations

import os
import sys
import zlib
from collections.abc import Iterable, Sequence
from typing import Any, TypeVar

import pytest
from hypothesis import HealthCheck, Phase, settings

T = TypeVar("T")

VARIABLE = "GRAPHFLOW_CASES"
"""How the option reaches test modules, which need it while they are imported."""
_GIVEN = os.environ.get(VARIABLE, "few")
PARTS = 6
"""Parts of the slow tests, of which each commit has one."""
TURN = int(os.environ.get("GRAPHFLOW_TURN", "0")) % PARTS
"""The part of the slow tests that is run with `--cases turn`."""
_WANTED = "full" if _GIVEN == "turn" else _GIVEN


def count(few: int, full: int) -> int:
    """The number of cases to try."""
    return {"few": few, "full": max(few, full // 4)}.get(_WANTED) or int(_WANTED)


def cases(number: int) -> settings:
    """So many cases; always the same ones, unless new ones were asked for by number."""
    return settings(
        max_examples=number,
        derandomize=_WANTED in ("few", "full"),
        deadline=None,
        suppress_health_check=[HealthCheck.too_slow],
        phases=set(Phase) - {Phase.explain},  # it takes longer than it is worth
    )


def sample(names: Sequence[T], step: int = 4) -> Sequence[T]:
    """One in `step` of many alike, beginning with the first; all of them with `--cases full`."""
    return names[::step] if _WANTED == "few" else names


MANY, MANY_REAL = {"few": (2, 1), "full": (20, 2)}.get(_WANTED, (sys.maxsize, sys.maxsize))
"""Cases of one test that are run, where there are more; of one that starts processes."""


def few_of_many(items: Sequence[pytest.Item]) -> tuple[list[pytest.Item], list[pytest.Item]]:
    """The tests to run, and those to leave out: of a test with many cases, some at equal distances are run.

    With `--cases full`, these are most; with a number, all are.
    """
    kept: list[pytest.Item] = []
    left: list[pytest.Item] = []
    cases_of: dict[str, list[pytest.Item]] = {}
    for item in items:
        cases_of.setdefault(item.nodeid.partition("[")[0], []).append(item)
    chosen: set[int] = set()
    for same in cases_of.values():
        many = MANY if same[0].get_closest_marker("real") is None else MANY_REAL
        step = -(-len(same) // many)
        chosen.update(map(id, same[::step]))
    for item in items:
        (kept if id(item) in chosen else left).append(item)
    return kept, left


def limit(number: int) -> pytest.MarkDecorator:
    """The time that so many cases may take."""
    return pytest.mark.timeout(120 + number // 5)


slow = pytest.mark.slow
"""For a test that takes a fifth of a second or more, or guards what seldom changes: it runs with `--cases full`."""


def without_slow(items: Sequence[pytest.Item]) -> tuple[list[pytest.Item], list[pytest.Item]]:
    """The tests to run, and those to leave out: slow ones, all or the parts that have no turn."""
    kept: list[pytest.Item] = []
    left: list[pytest.Item] = []
    for item in items:
        has_turn = _WANTED != "few" and (_GIVEN != "turn" or zlib.crc32(item.nodeid.encode()) % PARTS == TURN)
        (kept if has_turn or item.get_closest_marker("slow") is None else left).append(item)
    return kept, left


def some(names: Iterable[Any], *always: Any) -> list[Any]:
    """Parameters of a slow test: `always` these, the others with `--cases full`."""
    return [pytest.param(name, marks=() if name in always else slow) for name in names]
