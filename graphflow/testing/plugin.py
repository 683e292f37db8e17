"""The pytest plugin: the fixture `graph`, and `async def` tests run in an event loop of their own.

Nothing heavy is imported before a test asks for it: the plugin is loaded by every pytest run of an environment that
has graphflow installed. Where another plugin runs asynchronous tests (pytest-asyncio, anyio), it keeps those that
do not use `graph`.
"""

from __future__ import annotations

import asyncio
import inspect
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from graphflow.testing.graph import Graph

LIMIT = 60.0
"""Seconds of real time that an asynchronous test may take."""


def pytest_configure(config: pytest.Config) -> None:
    """Put a project's own `nodes` before those that come with an editable graphflow."""
    root = str(config.rootpath)
    if (config.rootpath / "nodes").is_dir() and root not in sys.path:
        sys.path.insert(0, root)


@pytest.fixture
def graphflow_runner() -> Iterator[asyncio.Runner]:
    """The event loop of one test."""
    with asyncio.Runner() as runner:
        yield runner


@pytest.fixture
def graph(graphflow_runner: asyncio.Runner) -> Iterator[Graph]:
    """A graph in memory under a manual clock; all its nodes are stopped after the test."""
    from graphflow.testing.graph import Graph

    made = Graph()
    yield made
    graphflow_runner.run(made.close())


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    """Run an `async def` test that uses `graph` or `graphflow_runner`."""
    if not inspect.iscoroutinefunction(pyfuncitem.obj) or "graphflow_runner" not in pyfuncitem.fixturenames:
        return None
    runner: Any = pyfuncitem.funcargs["graphflow_runner"]
    wanted = pyfuncitem._fixtureinfo.argnames
    arguments: dict[str, Any] = {name: pyfuncitem.funcargs[name] for name in wanted}

    async def limited() -> None:
        async with asyncio.timeout(LIMIT):
            await pyfuncitem.obj(**arguments)

    try:
        runner.run(limited())
    except TimeoutError as error:
        if isinstance(error.__cause__, asyncio.CancelledError):
            error.add_note(_too_long(error.__cause__))
        raise
    return True


def _too_long(ended: BaseException) -> str:
    """What to say of a test that has not come to its end; its clock stands still unless it is advanced."""
    from graphflow.deadlock.user_code import place_in

    where = place_in(ended)
    return (
        f"the test was not done after {LIMIT:g} s{f', and waited in {where}' if where else ''}. If it waits for time, "
        "advance the clock meanwhile: start it with asyncio.ensure_future, then await graph.clock.advance(1.0)"
    )
