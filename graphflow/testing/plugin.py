"""The pytest plugin: the fixture `graph`, and `async def` tests run in an event loop of their own.

Nothing heavy is imported before a test asks for it: the plugin is loaded by every pytest run of an environment that
has graphflow installed. Where another plugin runs asynchronous tests (pytest-asyncio, anyio), it keeps those that
do not use `graph`.
"""

from __future__ import annotations

import asyncio
import inspect
import sys
import time
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from graphflow.testing.graph import Graph

LIMIT = 60.0
"""Seconds of real time that an asynchronous test may take."""
IDLE_LIMIT = 5.0
"""Seconds of real time in which a test with a manual clock may do nothing at all."""
IDLE = 0.02
"""Seconds of processor time in one of real time that count as nothing."""


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

    began = time.monotonic()

    async def limited() -> None:
        async with asyncio.timeout(LIMIT) as limit:
            watching = asyncio.create_task(_end_when_idle(limit)) if "graph" in pyfuncitem.fixturenames else None
            try:
                await pyfuncitem.obj(**arguments)
            finally:
                if watching is not None:
                    watching.cancel()

    try:
        runner.run(limited())
    except TimeoutError as error:
        ended = error.__cause__ or error.__context__  # the first since Python 3.11.3
        if isinstance(ended, asyncio.CancelledError):
            error.add_note(_too_long(ended, time.monotonic() - began))
        raise
    return True


async def _end_when_idle(limit: asyncio.Timeout) -> None:
    """End a test that stands still: what it waits for would come with time, and its clock does not move."""
    idle = 0.0
    while idle < IDLE_LIMIT:
        used, step = time.process_time(), min(1.0, IDLE_LIMIT)
        await asyncio.sleep(step)
        idle = idle + step if time.process_time() - used < IDLE * step else 0.0
    limit.reschedule(asyncio.get_running_loop().time())


def _too_long(ended: BaseException, seconds: float) -> str:
    """What to say of a test that has not come to its end; its clock stands still unless it is advanced."""
    from graphflow.deadlock.user_code import place_in

    where = place_in(ended)
    return (
        f"the test was not done after {seconds:.0f} s{f', and waited in {where}' if where else ''}. If it waits for "
        "time, or for a node that is not there, advance the clock meanwhile: "
        "start it with asyncio.ensure_future, then await graph.clock.advance(1.0)"
    )
