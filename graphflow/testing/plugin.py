"""The pytest plugin: the fixture `graph`, and an event loop for each `async def` test.

Heavy imports wait for the first test that needs them: every pytest run in an environment with graphflow loads the
plugin. Another plugin for asynchronous tests (pytest-asyncio, anyio) runs the tests it has claimed, in its own loop,
and those that do not use `graph`; the time limits apply there, too.
"""

from __future__ import annotations

import asyncio
import functools
import inspect
import linecache
import re
import sys
import time
from collections.abc import AsyncGenerator, Callable, Coroutine, Generator, Iterator
from types import TracebackType
from typing import TYPE_CHECKING, Any, TypeAlias

import pytest

if TYPE_CHECKING:
    from graphflow.testing.graph import Graph

Test: TypeAlias = Callable[..., Coroutine[object, object, None]]

LIMIT = 60.0
"""Longest duration of an asynchronous test, in seconds of real time, unless it is marked with its own `timeout`."""
IDLE_LIMIT = 5.0
"""Longest idle time of a test with a manual clock, in seconds of real time."""
IDLE = 0.02
"""Processor time in seconds, per second of real time, below which a test counts as idle."""
_ASYNC_DEF = ", and async def in place of def"


def pytest_configure(config: pytest.Config) -> None:
    """Give a project's own `nodes` package precedence over an editable graphflow's."""
    root = str(config.rootpath)
    if (config.rootpath / "nodes").is_dir() and root not in sys.path:
        sys.path.insert(0, root)
    if not config.pluginmanager.has_plugin("timeout"):  # pytest-timeout, whose mark it is
        config.addinivalue_line("markers", "timeout(seconds): limit the duration of a test")


@pytest.fixture
def graphflow_runner() -> Iterator[asyncio.Runner]:
    """Return the event loop of one test."""
    with asyncio.Runner() as runner:
        yield runner


@pytest.fixture
def graph(graphflow_runner: asyncio.Runner) -> Iterator[Graph]:
    """Return a graph in memory under a manual clock; all its nodes are stopped after the test."""
    from graphflow.testing.graph import Graph

    made = Graph()
    yield made
    if made.loop in (None, graphflow_runner.get_loop()):  # in another plugin's loop, the test has closed it
        graphflow_runner.run(made.close())


@pytest.hookimpl(wrapper=True, trylast=True)  # within those of other plugins, which may have made it synchronous
def pytest_fixture_setup(fixturedef: Any, request: pytest.FixtureRequest) -> Generator[None, object, object]:
    """Run an `async def` fixture of a test that uses `graph` in the test's event loop, unless another plugin does."""
    made, names = fixturedef.func, request.fixturenames
    is_asynchronous = inspect.isasyncgenfunction(made) or inspect.iscoroutinefunction(made)
    if not is_asynchronous or "graphflow_runner" not in names or "anyio_backend" in names:
        return (yield)
    fixturedef.func = (
        _synchronous(fixturedef, request) if fixturedef.scope == "function" else _too_long_lived(fixturedef)
    )
    try:
        return (yield)
    finally:
        fixturedef.func = made


def _synchronous(fixturedef: Any, request: pytest.FixtureRequest) -> Callable[..., object]:
    """Return a function that runs an asynchronous fixture in its test's event loop."""
    made, instance = fixturedef.func, request.instance
    if inspect.ismethod(made) and isinstance(instance, type(made.__self__)):
        made = made.__func__.__get__(instance)  # as pytest does, since each test has an instance of its own
    runner: asyncio.Runner = request.getfixturevalue("graphflow_runner")

    @functools.wraps(made)
    def run(*args: object, **kwargs: object) -> object:
        if not inspect.isasyncgenfunction(made):
            return runner.run(made(*args, **kwargs))
        steps = made(*args, **kwargs)
        request.addfinalizer(lambda: runner.run(_end_of(steps)))
        return runner.run(_start_of(steps))

    return run


def _too_long_lived(fixturedef: Any) -> Callable[..., object]:
    """Return a function that refuses an asynchronous fixture of a scope longer than a test's event loop."""

    @functools.wraps(fixturedef.func)
    def refuse(*_: object, **__: object) -> object:
        text = (
            f"the fixture {fixturedef.argname!r} is asynchronous, and runs in a test's event loop: leave out its scope"
        )
        pytest.fail(text, pytrace=False)

    return refuse


async def _start_of(steps: AsyncGenerator[object, None]) -> object:
    async for value in steps:
        return value
    pytest.fail("an async fixture has ended without a yield", pytrace=False)


async def _end_of(steps: AsyncGenerator[object, None]) -> None:
    async for _ in steps:
        await steps.aclose()
        pytest.fail("an async fixture yields once", pytrace=False)


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None, object, object]:
    """Limit the duration of `async def` tests that use `graph` or `graphflow_runner`, whichever plugin runs them."""
    if not isinstance(item, pytest.Function) or "graphflow_runner" not in item.fixturenames:
        return (yield)
    generated = getattr(item.obj, "hypothesis", None)
    if generated is not None and inspect.iscoroutinefunction(generated.inner_test):
        test = generated.inner_test
        generated.inner_test = _by_examples(item, test)
        try:
            return (yield)
        finally:
            generated.inner_test = test
    if inspect.iscoroutinefunction(item.obj):
        item.obj = _limited(item, item.obj)
        return (yield)
    has_failed = True
    try:
        result = yield
        has_failed = False
    finally:
        if has_failed:
            _report([f"{text}{_ASYNC_DEF}" for text in _forgotten()], item)
    _fail_if_forgotten(_ASYNC_DEF)
    return result


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[object]) -> Generator[None, object, object]:
    """Add advice to reports, as in the logs of nodes, and end traces at the user's last line."""
    errors = sys.modules.get("graphflow.runtime.mistakes.errors.attribute_errors")
    if call.excinfo is not None and errors is not None:
        errors.explain(call.excinfo.value)
        if "graphflow_runner" in getattr(item, "fixturenames", ()):
            from graphflow.runtime.mistakes.errors.python_errors import remark_on

            if remark := remark_on(call.excinfo.value):
                call.excinfo.value.add_note(remark)
            if not item.config.getoption("fulltrace", False):
                call.excinfo = _ending_at_users_line(call.excinfo)
    if call.when == "call" and errors is not None and _is_unrun(item, call.excinfo):
        text = f"graphflow runs async tests that use its fixture: write async def {item.name}(graph)"
        item.add_report_section("call", "graphflow", text)
    return (yield)


def _ending_at_users_line(error: pytest.ExceptionInfo[BaseException]) -> pytest.ExceptionInfo[BaseException]:
    """Drop the frames below the user's last line from an error that graphflow raised, or a time limit."""
    from graphflow.analysis.user_code import is_refusal, is_users_frame, parts_of
    from graphflow.errors import GraphflowError

    parts = list(parts_of(error.tb))
    own = [place for place, part in enumerate(parts) if is_users_frame(part.tb_frame)]
    if not own or not (isinstance(error.value, (GraphflowError, TimeoutError)) or is_refusal(parts[-1])):
        return error
    kept: TracebackType | None = None
    for part in reversed(parts[: own[-1] + 1]):
        kept = TracebackType(kept, part.tb_frame, part.tb_lasti, part.tb_lineno)
    assert kept is not None
    return pytest.ExceptionInfo.from_exc_info((error.type, error.value.with_traceback(kept), kept))


def _is_unrun(item: pytest.Item, error: pytest.ExceptionInfo[BaseException] | None) -> bool:
    """Whether a test failed because no plugin runs coroutine functions."""
    return (
        error is not None
        and isinstance(item, pytest.Function)
        and inspect.iscoroutinefunction(item.obj)
        and str(error.value).startswith("async def functions are not natively supported")
    )


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    """Run an `async def` test, unless another plugin does."""
    if "graphflow_runner" not in pyfuncitem.fixturenames or "anyio_backend" in pyfuncitem.fixturenames:
        return None
    runner = pyfuncitem.funcargs["graphflow_runner"]
    assert isinstance(runner, asyncio.Runner)
    if inspect.iscoroutinefunction(pyfuncitem.obj):
        runner.run(pyfuncitem.obj(**{name: pyfuncitem.funcargs[name] for name in _fixtures(pyfuncitem).argnames}))
        return True
    generated = getattr(pyfuncitem.obj, "hypothesis", None)
    if generated is not None and inspect.iscoroutinefunction(test := generated.inner_test):

        @functools.wraps(test)
        def run(*args: object, **kwargs: object) -> None:
            runner.run(test(*args, **kwargs))

        generated.inner_test = run
    return None


def _fixtures(item: pytest.Function) -> Any:
    """Return the arguments and fixtures of a test, for which pytest has no public name."""
    return item._fixtureinfo


def _limited(item: pytest.Function, test: Test) -> Test:
    """Wrap a test so that it ends when it takes too long or stands still."""
    runner = item.funcargs["graphflow_runner"]
    assert isinstance(runner, asyncio.Runner)
    made: Any = item.funcargs.get("graph")

    @functools.wraps(test)
    async def limited(*args: object, **kwargs: Any) -> None:
        graph: Graph | None = kwargs.get("graph", made)
        loop = asyncio.get_running_loop()
        if graph is not None and graph.loop not in (None, loop):
            raise RuntimeError(
                "a fixture has started nodes in an event loop other than the test's: mark the test for the "
                "fixture's plugin, as with @pytest.mark.asyncio"
            )
        began, waits = time.monotonic(), list[str]()
        try:
            async with asyncio.timeout(_limit(item)) as limit:
                watching = asyncio.create_task(_end_when_idle(limit, graph, waits)) if graph is not None else None
                try:
                    await test(*args, **kwargs)
                    if graph is not None:
                        graph.raise_failed()
                        await asyncio.sleep(0)  # lets new tasks start
                        _fail_if_forgotten()
                        _warn_of_misspelt_taps(item, graph)
                except (Exception, pytest.fail.Exception) as error:  # any failure of the test, reported and raised
                    found = _forgotten()
                    if graph is not None and not _is_of_a_line(error):
                        found += _unstarted(graph, error)
                        found += await _unmet(graph, test) if graph.loop is loop else []
                    _report(found, item)
                    raise
                finally:
                    if watching is not None:
                        watching.cancel()
        except TimeoutError as error:
            ended = error.__cause__ or error.__context__  # Python 3.11.3 and later set the cause
            if isinstance(ended, asyncio.CancelledError):
                text = _too_long(ended, time.monotonic() - began, waits)
                raise TimeoutError(text).with_traceback(ended.__traceback__) from None
            raise
        finally:
            # Closes an example's own graph, and the fixture's too, whose loop another plugin may close before the end.
            if graph is not None and graph.loop is loop and (graph is not made or runner.get_loop() is not loop):
                await graph.close()

    return limited


def _limit(item: pytest.Function) -> float:
    mark = item.get_closest_marker("timeout")
    return LIMIT if mark is None else float(mark.args[0] if mark.args else mark.kwargs["timeout"])


def _fail_if_forgotten(way: str = "") -> None:
    """Fail a test that has not awaited a call of its graph."""
    if found := _forgotten():
        pytest.fail(f"{found[0]}{way}", pytrace=False)


def _forgotten() -> list[str]:
    from graphflow.testing.forgotten import forgotten

    return forgotten()


def _report(lines: list[str], item: pytest.Item) -> None:
    if lines:
        item.add_report_section("call", "graphflow", "\n".join(lines))


def _is_of_a_line(error: BaseException) -> bool:
    """Whether an error concerns only a line's content, whatever else the test waited for."""
    from graphflow.errors import DeclarationError, EncodeError, InvalidName, ParameterError

    return isinstance(error, (DeclarationError, EncodeError, InvalidName, ParameterError, NameError, ImportError))


def _unstarted(graph: Graph, error: BaseException) -> list[str]:
    from graphflow.testing.unmet import unstarted

    return [*unstarted(graph, error)]


async def _unmet(graph: Graph, test: Test) -> list[str]:
    """Return a sentence for each unmet wait of a failing test."""
    from graphflow.analysis.user_code import place_in
    from graphflow.runtime.mistakes.errors.kept_errors import KeptErrors
    from graphflow.testing.unmet import arrivals, unmet

    before = arrivals(graph)
    await asyncio.sleep(0)  # lets new tasks start
    found = _forgotten()
    for _, name, error in KeptErrors(asyncio.get_running_loop()).failed():
        found.append(f"{name} failed, and nothing awaits it: {error!r} ({place_in(error)})")
    try:
        found += await unmet(graph, before, inspect.unwrap(test))
    except RuntimeError as error:  # the graph does not settle
        found.append(str(error))
    return found


def _warn_of_misspelt_taps(item: pytest.Function, graph: Graph) -> None:
    """Warn of a passing test that looks at a topic which no node has, by a name like another's."""
    from graphflow.testing.unmet import misspelt_taps

    for text in misspelt_taps(graph):
        item.warn(pytest.PytestWarning(text))


def _by_examples(item: pytest.Function, test: Test) -> Test:
    """Wrap a Hypothesis test so that each example has its own graph."""
    limited = _limited(item, test)
    if "graph" not in item.funcargs:
        return limited
    fixtures = _fixtures(item).name2fixturedefs.items()
    if users := [name for name, found in fixtures if found and "graph" in found[-1].argnames]:
        raise RuntimeError(
            f"each example has its own graph, which {users[0]!r} cannot use: start its nodes in the test"
        )
    from hypothesis import HealthCheck, settings

    # Hypothesis refuses fixtures that are not reset for each example, and applying `settings` twice:
    # hence the attribute in which it keeps them, which has no public name.
    decorated: Any = getattr(item.obj, "__func__", item.obj)
    given: Any = getattr(decorated, "_hypothesis_internal_use_settings", settings.default)
    allowed = [*given.suppress_health_check, HealthCheck.function_scoped_fixture]
    decorated._hypothesis_internal_use_settings = settings(given, suppress_health_check=allowed)

    @functools.wraps(test)
    async def example(*args: object, **kwargs: object) -> None:
        from graphflow.testing.graph import Graph

        await limited(*args, **kwargs | {"graph": Graph()})

    return example


async def _end_when_idle(limit: asyncio.Timeout, graph: Graph, waits: list[str]) -> None:
    """End a test that stands still: it waits for time to pass, and its clock does not move.

    Args:
        waits: Receives a sentence for each service that is waited for in vain.
    """
    idle = 0.0
    while idle < IDLE_LIMIT:
        used, step = time.process_time(), min(1.0, IDLE_LIMIT)
        await asyncio.sleep(step)
        idle = idle + step if time.process_time() - used < IDLE * step else 0.0
    from graphflow.testing.unmet import unserved

    waits += unserved(graph)
    limit.reschedule(asyncio.get_running_loop().time())


def _too_long(ended: BaseException, seconds: float, waits: list[str]) -> str:
    """Return the report of a test that has not ended; its clock stands still unless advanced."""
    from graphflow.analysis.user_code import place_in

    where = place_in(ended)
    text = f"the test was not done after {seconds:.0f} s{f', and waited in {where}' if where else ''}"
    if waits:
        return f"{text}: {'; '.join(waits)}"
    file, _, line = where.rpartition(":")
    slept = re.search(r"await\s+([\w.]*\bclock)\.sleep\((.*)\)", linecache.getline(file, int(line))) if line else None
    if slept is not None:
        return f"{text}: a test's clock moves when it is told to; write await {slept[1]}.advance({slept[2]})"
    return (
        f"{text}. If it waits for time, or for a node that is not there, advance the clock meanwhile: "
        "start it with asyncio.ensure_future, then await graph.clock.advance(1.0). If it works that long, mark it with "
        f"@pytest.mark.timeout({2 * seconds:.0f})"
    )
