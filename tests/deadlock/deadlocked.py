"""Programs that cannot go on: how that is to be told."""

from __future__ import annotations

from typing import Any, NamedTuple

import pytest

from graphflow import Node
from graphflow.testing import Graph
from tests.deadlock.cast import Caplog, at, cleared, in_vain, reports, say
from tests.flat import flat


class Stuck(NamedTuple):
    """A program that cannot go on, and how that is to be told."""

    program: type[Node]
    wanted: str
    blocked: str
    """The handler that cannot run."""
    holder: str
    group: str
    verdict: str
    marker: str
    has_remedy: bool
    """Whether the report tells what ends it."""


CALLED = "the response of service /ping"
PLANNED = "the result of action /plan"


def stuck(
    program: type[Node],
    wanted: str = "self.there",
    blocked: str = "subscription arrive",
    holder: str = "subscription go",
    group: str = "motion",
    *,
    verdict: str = "LIKELY DEADLOCK",
    marker: str = "",
    has_remedy: bool = True,
) -> Any:
    """A case: a program, and how it is to be told."""
    marker = f"stuck: {marker or program.__name__}"
    case = Stuck(program, wanted, blocked, holder, group, verdict, marker, has_remedy)
    return pytest.param(case, id=program.__name__)


def dead_call(program: type[Node], *expected: str) -> Any:
    """The same for a call or goal, whose deadlock is certain."""
    words = expected or (CALLED, "service on_ping")
    return stuck(program, *words, verdict="DEADLOCK")


async def cannot_go_on(graph: Graph, caplog: Caplog, case: Stuck) -> None:
    """Run a program: it is told once, within a second, who holds what and waits where, for whom that cannot run."""
    graph.deadlock = "report"
    graph.waits_outside = False  # one of them waits on a thread for what cannot happen
    await graph.start(case.program())
    await say(graph, "/go", "/arrive", "/arrive")
    await graph.clock.advance(1.0)
    [text] = [*reports(caplog), *in_vain(caplog)]

    told = flat(text)
    assert told.startswith(f"{case.verdict}: ")
    holds = f" holds group '{case.group}' and" if case.group else ""
    [_, after] = told.split(f" {case.holder} of /robot{holds} waits for {case.wanted} {at(case.marker)}")
    assert f"{case.blocked} of /robot " in after.partition(" -> ")[2].partition(" -> ")[0]
    assert "ends it:" in told or not case.has_remedy
    assert [line for line in text.splitlines() if len(line) > 100] == []
    await graph.clock.advance(8.0)
    assert [*reports(caplog), *in_vain(caplog)] == [text]
    assert not cleared(caplog)
