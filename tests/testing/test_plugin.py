"""The pytest plugin in another project."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest
from _pytest.assertion.rewrite import AssertionRewriter

import graphflow
import graphflow.testing.graph  # here and not by a project under test: numpy cannot be imported twice
from tests.cases import slow

pytest_plugins = ["pytester"]

NODE = """
    from graphflow import Node, Param, Publisher, task, timer
    from graphflow.msgs.std_msgs.msg import String

    class Counter(Node):
        rate = Param(1.0)
        out = Publisher(String, "out")
        count = 0

        @timer(hz=rate)
        async def tick(self) -> None:
            self.count += 1
            self.out.publish(String(data=str(self.count)))

    class Broken(Node):
        @task
        async def work(self) -> None:
            raise ValueError("broken")
"""


@slow
def test_a_foreign_project_has_the_fixture(pytester: pytest.Pytester) -> None:
    """An `async def` test with `graph` runs without configuration."""
    pytester.makepyfile(
        counter=NODE,
        test_counter="""
            from counter import Counter
            from graphflow.msgs.std_msgs.msg import String

            async def test_counts(graph):
                await graph.start(Counter(rate=10))
                heard = graph.tap(String, "/out")
                await graph.clock.advance(1.0)
                assert [m.data for m in heard] == [str(n) for n in range(1, 11)]

            async def test_is_wrong(graph):
                await graph.start(Counter())
                assert graph.nodes == []
        """,
    )

    result = pytester.runpytest_subprocess("-p", "no:cacheprovider")

    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines(["*assert graph.nodes == []*"])


def run(pytester: pytest.Pytester, test: str, *options: str) -> pytest.RunResult:
    pytester.makepyfile(counter=NODE, test_it=test)
    return pytester.runpytest_inprocess("-p", "no:cacheprovider", *options)


def test_pytest_leaves_the_package_as_it_is() -> None:
    """After `rclpy enable`, Python has imported it already, and pytest would warn that it cannot rewrite it."""
    assert AssertionRewriter.is_rewrite_disabled(graphflow.__doc__ or "")


def test_fixtures_and_parameters_come_along(pytester: pytest.Pytester) -> None:
    """An asynchronous test takes other fixtures, parameters and a class around it like any test."""
    result = run(
        pytester,
        """
        import pytest
        from counter import Counter

        @pytest.fixture
        def two():
            return 2

        class TestIt:
            @pytest.mark.parametrize("rate", [1, 5])
            async def test_counts(self, rate, two, graph, tmp_path):
                assert tmp_path.exists()
                node = Counter(rate=rate)
                await graph.start(node)
                await graph.clock.advance(two)
                assert node.count == rate * two

        def test_plain(graph):
            assert graph.nodes == []
        """,
    )

    result.assert_outcomes(passed=3)


def test_a_failing_node_fails_the_test(pytester: pytest.Pytester) -> None:
    """Even if the test's own assertions hold."""
    result = run(
        pytester,
        """
        from counter import Broken

        async def test_it(graph):
            await graph.start(Broken())
        """,
    )

    result.assert_outcomes(passed=1, errors=1)
    result.stdout.fnmatch_lines(["*ValueError: broken*"])


@slow
def test_tests_that_would_pass_in_vain(pytester: pytest.Pytester) -> None:
    """Fail: where an assertion has failed in a handler, where an `await` is missing, and the `async` of a test."""
    result = run(
        pytester,
        """
        from counter import Counter
        from graphflow import Node, subscription
        from graphflow.msgs.std_msgs.msg import String

        class Probe(Node):
            @subscription(String, "out")
            async def heard(self, message):
                assert message.data == "2"

        async def test_probe(graph):
            await graph.start(Counter(), Probe())
            await graph.clock.advance(2.0)

        async def test_advance(graph):
            graph.clock.advance(2.0)

        def test_start(graph):
            graph.start(Counter())

        async def test_settle(graph):
            await graph.settle

        async def test_words(graph):
            heard = graph.tap(String, "out")
            assert repr(heard) == "<Tap /out []>"
            graph.advance(1.0)

        def test_def(graph):
            graph.start(Counter())
            assert graph.nodes

        async def test_next(graph):
            assert graph.nodes

        async def test_up(graph):
            assert graph.up("g.yaml")["/counter"]

        async def test_right(graph):
            await graph.start(Counter())
            await graph.clock.advance(1.0)
        """,
    )

    result.assert_outcomes(failed=8, passed=1)
    result.stdout.fnmatch_lines(
        [
            "*assert *'1' == '2'*",
            "*test_it.py:15: this has no effect until it is awaited; write await graph.clock.advance(2.0)*",
            "*test_it.py:18: this * write await graph.start(Counter()), and async def in place of def*",
            "*call it: await settle()*",
            "*'Graph' object has no attribute 'advance'; write await graph.clock.advance(1.0)*",
            "*_ test_def _*",
            "*test_it.py:29: this * write await graph.start(Counter()), and async def in place of def*",
            "*_ test_next _*",
            "*_ test_up _*",
            "*test_it.py:36: this * write await graph.up(...)*",
        ]
    )
    reports, _, _ = result.stdout.str().partition("short test summary info")  # which may repeat them
    assert reports.count("has no effect until it is awaited") == 4


def test_asynchronous_fixtures(pytester: pytest.Pytester) -> None:
    """They run in the test's event loop, for each test anew; what follows a `yield` runs at the end."""
    result = run(
        pytester,
        """
        import pytest
        from counter import Counter

        ended = []

        @pytest.fixture
        async def counter(graph):
            node = Counter()
            await graph.start(node)
            return node

        @pytest.fixture
        async def second(graph, counter):
            yield graph.make(Counter, "second")
            await graph.clock.advance(1.0)
            ended.append(counter.count)

        @pytest.mark.parametrize("seconds", [1, 2])
        async def test_counts(graph, counter, second, seconds):
            await graph.start(second)
            await graph.clock.advance(float(seconds))
            assert counter.count == second.count == seconds

        def test_the_ends():
            assert ended == [2, 3]

        class TestOfClasses:
            @pytest.fixture
            async def own(self, counter):
                self.counter = counter
                return counter

            async def test_own(self, graph, own):
                assert own.is_running and self.counter is own
        """,
    )

    result.assert_outcomes(passed=4)


def test_asynchronous_fixtures_with_mistakes(pytester: pytest.Pytester) -> None:
    """A second `yield`, none, and a longer scope are told."""
    result = run(
        pytester,
        """
        import pytest

        ended = []

        @pytest.fixture
        async def twice(graph):
            try:
                yield 1
                yield 2
            finally:
                ended.append("twice")

        @pytest.fixture
        async def never(graph):
            if graph is None:
                yield 1

        @pytest.fixture(scope="module")
        async def long():
            return 1

        async def test_twice(twice): ...

        async def test_never(never): ...

        @pytest.mark.parametrize("n", [1, 2])
        async def test_long(graph, long, n): ...

        def test_the_end():
            assert ended == ["twice"]
        """,
    )

    result.assert_outcomes(passed=2, errors=4)
    told = result.stdout.str().partition("short test summary info")[0]
    assert told.count("an async fixture yields once") == 1
    assert told.count("an async fixture has ended without a yield") == 1
    assert told.count("the fixture 'long' is asynchronous, and runs in a test's event loop: leave out its scope") == 2


def test_a_node_that_is_not_started(pytester: pytest.Pytester) -> None:
    """It may be why a test fails, although nothing else runs either."""
    result = run(
        pytester,
        """
        from counter import Counter

        async def test_counts(graph):
            node = Counter()
            assert node.count == 1
        """,
    )

    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*Captured graphflow call*", "node is not started: await graph.start(node)"])


def test_a_task_that_has_failed(pytester: pytest.Pytester) -> None:
    """It may be why a test fails, and is shown with it."""
    result = run(
        pytester,
        """
        import asyncio
        from graphflow import Node

        class Robot(Node):
            async def on_start(self):
                self.driving = asyncio.create_task(self.drive())

            async def drive(self):
                raise KeyError("wheel")  # here

        async def test_it(graph):
            await graph.start(Robot())
            await graph.settle()
            assert graph.tap is None
        """,
    )

    result.assert_outcomes(failed=1)
    line = "*Robot.drive failed, and nothing awaits it: KeyError('wheel') (*test_it.py:9)"
    result.stdout.fnmatch_lines(["*AssertionError*", line])


def test_a_test_that_hangs_is_ended(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    """After a limit of real time, with an error that shows where it waited."""
    monkeypatch.setattr("graphflow.testing.plugin.LIMIT", 0.01)
    result = run(
        pytester,
        """
        import asyncio

        async def test_it(graph):
            await asyncio.Event().wait()  # here
        """,
    )

    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        ["*asyncio.Event().wait()  # here*", "E *TimeoutError*waited in *test_it.py:4*advance the clock*"]
    )


def test_an_error_ends_at_the_tests_line(pytester: pytest.Pytester) -> None:
    """Without the source of what it calls, unless that is asked for; a forgotten await needs no trace at all."""
    text = """
        async def test_it(graph):
            assert graph.tap("a", "b").latest

        async def test_latest(graph):
            from graphflow.msgs.std_msgs.msg import String
            assert graph.tap(String, "words").latest

        async def test_forgotten(graph):
            graph.settle()
        """
    result = run(pytester, text)
    result.assert_outcomes(failed=3)
    shown = result.stdout.str()
    assert "checks.py" not in shown
    assert "testing/graph.py" not in shown
    assert "plugin.py" not in shown
    result.stdout.fnmatch_lines(['> *assert graph.tap("a", "b").latest', "E *"])
    assert "checks.py" in run(pytester, text, "--full-trace", "--tb=short").stdout.str()


@slow
@pytest.mark.parametrize("plugin", ["timeout", "no:timeout"])
def test_a_limit_of_its_own(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch, plugin: str) -> None:
    """Is that of pytest-timeout's mark, whether that is installed or not."""
    monkeypatch.setattr("graphflow.testing.plugin.LIMIT", 0.01)
    result = run(
        pytester,
        """
        import asyncio
        import pytest

        @pytest.mark.timeout(20)
        async def test_long(graph):
            await asyncio.sleep(0.1)

        async def test_short(graph):
            await asyncio.sleep(0.1)
        """,
        "-p",
        plugin,
    )

    result.assert_outcomes(failed=1, passed=1)
    result.stdout.fnmatch_lines(["*was not done after*mark it with @pytest.mark.timeout(*)*"])


def test_a_test_that_inspects_too_early(pytester: pytest.Pytester) -> None:
    """The messages right after it are told."""
    result = run(
        pytester,
        """
        from graphflow.msgs.std_msgs.msg import String

        async def test_it(graph):
            heard = graph.tap(String, "/out")
            graph.publisher(String, "/out").publish(String())
            assert len(heard) == 1
        """,
    )
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*1 message of /out arrived after the test had ended: await graph.settle() before*"])


@slow
def test_a_test_that_waits_for_a_service(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    """Which no node has, is ended with its name."""
    monkeypatch.setattr("graphflow.testing.plugin.IDLE_LIMIT", 0.2)
    result = run(
        pytester,
        """
        from counter import Counter
        from graphflow.msgs.std_srvs.srv import Trigger

        async def test_it(graph):
            await graph.start(Counter())
            await graph.call(Trigger, "/nobody", Trigger.Request())
        """,
    )

    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        ["*TimeoutError: the test was not done after * s*: the test waits for /nobody, which no *"]
    )


def test_a_test_that_sleeps(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    """By the graph's clock, is shown how time passes."""
    monkeypatch.setattr("graphflow.testing.plugin.IDLE_LIMIT", 0.2)
    result = run(
        pytester,
        """
        from counter import Counter

        async def test_it(graph):
            await graph.start(Counter())
            await graph.clock.sleep(0.5)
        """,
    )

    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        ["*TimeoutError: *: a test's clock moves when it is told to; write *clock.advance(0.5)"]
    )


@slow
def test_a_test_that_stands_still_is_ended(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    """It waits for time, and its clock does not move; a busy test continues."""
    monkeypatch.setattr("graphflow.testing.plugin.IDLE_LIMIT", 0.4)
    result = run(
        pytester,
        """
        import asyncio, time
        from graphflow.msgs.std_srvs.srv import Empty

        async def test_still(graph):
            await graph.call(Empty, "/nobody", Empty.Request())  # here

        async def test_busy(graph):
            until = time.monotonic() + 1.0
            while time.monotonic() < until:
                await asyncio.sleep(0)
        """,
    )

    result.assert_outcomes(failed=1, passed=1)
    result.stdout.fnmatch_lines(["*TimeoutError*waited in *test_it.py:5: the test waits for /nobody*"])


def test_a_failing_test_is_told_what_has_not_happened(pytester: pytest.Pytester) -> None:
    """In a section of its report; a passing test has none."""
    result = run(
        pytester,
        """
        import pytest
        from counter import Counter
        from graphflow.msgs.std_msgs.msg import String

        @pytest.mark.parametrize("way", ["assert", "fail"])
        async def test_waits(graph, way):
            await graph.start(Counter())
            heard = graph.tap(String, "/outt")
            if way == "fail":
                pytest.fail("nothing")
            assert heard

        async def test_passes(graph):
            await graph.start(Counter())
        """,
    )
    result.assert_outcomes(passed=1, failed=2)
    result.stdout.fnmatch_lines(
        2
        * [
            "*Captured graphflow call*",
            "no node publishes /outt, which the test taps; did you mean '/out'?",
            "the test's clock stood still, and something waits for time: await graph.clock.advance(1.0)",
        ]
    )


@slow
def test_an_error_about_a_line_of_the_test(pytester: pytest.Pytester) -> None:
    """The report has only the error."""
    result = run(
        pytester,
        """
        from counter import Counter
        from graphflow.msgs.std_srvs.srv import Empty, Trigger

        async def test_it(graph):
            await graph.start(Counter())
            await graph.call(Empty, "/empty", Trigger.Request())
        """,
    )
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*EncodeError: /empty takes Empty_Request*"])
    result.stdout.no_fnmatch_line("*Captured graphflow call*")


def test_other_asynchronous_tests_are_left_alone(pytester: pytest.Pytester) -> None:
    """An asynchronous test without graphflow is left to the plugin it was written for."""
    pytester.makeconftest(
        """
        import asyncio, pytest

        ran = []

        @pytest.hookimpl
        def pytest_pyfunc_call(pyfuncitem):
            ran.append(pyfuncitem.name)
            asyncio.run(pyfuncitem.obj())
            return True

        def pytest_terminal_summary(terminalreporter):
            terminalreporter.line(f"by the other plugin: {ran}")
        """
    )
    result = run(
        pytester,
        """
        async def test_other():
            pass

        async def test_ours(graph):
            pass
        """,
    )

    result.assert_outcomes(passed=2)
    assert "by the other plugin: ['test_other']" in result.stdout.str()


TAKES_ALL = """
    import asyncio, inspect, pytest

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(item):
        test, made = item.obj, getattr(item.obj, "hypothesis", None)
        if made is not None:
            inner = made.inner_test
            made.inner_test = lambda *args, **kwargs: asyncio.run(inner(*args, **kwargs))
        elif inspect.iscoroutinefunction(test):
            item.obj = lambda **kwargs: asyncio.run(test(**kwargs))
        return (yield)
"""
"""Another plugin that runs all asynchronous tests, in loops that it closes, as pytest-asyncio does in its auto mode."""


@slow
def test_another_plugin_may_run_a_test_with_the_fixture(
    pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its nodes are stopped in the loop of that plugin, and the test is limited as any other."""
    monkeypatch.setattr("graphflow.testing.plugin.IDLE_LIMIT", 0.05)
    pytester.makeconftest(TAKES_ALL)
    result = run(
        pytester,
        """
        import asyncio
        from counter import Broken, Counter

        async def test_it(graph, graphflow_runner):
            node = Counter(rate=10)
            await graph.start(node)
            await graph.clock.advance(1.0)
            assert node.count == 10
            assert graphflow_runner.get_loop() is not asyncio.get_running_loop()

        async def test_still(graph):
            await asyncio.Event().wait()  # here

        async def test_broken(graph):
            await graph.start(Broken())
        """,
    )

    result.assert_outcomes(passed=1, failed=2)
    result.stdout.fnmatch_lines(["*waited in *test_it.py:12*", "*ValueError: broken*"])


def test_nodes_of_another_loop_are_refused(pytester: pytest.Pytester) -> None:
    """Where a fixture of another plugin has started them, but the test is not that plugin's."""
    result = run(
        pytester,
        """
        import asyncio, pytest
        from counter import Counter

        @pytest.fixture
        def started(graph):
            loop = asyncio.new_event_loop()
            loop.run_until_complete(graph.start(Counter()))
            yield
            loop.run_until_complete(graph.close())
            loop.close()

        async def test_it(started, graph):
            pass
        """,
    )

    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        ["*RuntimeError: a fixture has started nodes in an event loop other than*@pytest.mark.asyncio"]
    )


@slow
@pytest.mark.parametrize("conftest", ["", TAKES_ALL], ids=["ours", "another's"])
def test_generated_examples_have_a_graph_each(pytester: pytest.Pytester, conftest: str) -> None:
    """A Hypothesis test may be asynchronous and use `graph`: examples do not share state."""
    pytester.makeconftest(conftest)
    result = run(
        pytester,
        """
        from counter import Counter
        from hypothesis import given, settings, strategies as st

        rates = st.sampled_from([1, 2, 5, 10])
        graphs = []

        @given(rate=rates)
        @settings(max_examples=20, database=None)
        async def test_it(graph, rate):
            assert graph.nodes == []
            node = Counter(rate=rate)
            await graph.start(node)
            await graph.clock.advance(1.0)
            assert node.count == rate
            graphs.append(graph)

        def test_each(graph):
            assert len(graphs) > 1 and not any(node.is_running for graph in graphs for node in graph.nodes)

        class TestIt:
            @given(rates)
            @settings(database=None)
            async def test_falsified(self, graph, rate):
                node = Counter(rate=rate)
                await graph.start(node)
                await graph.clock.advance(1.0)
                assert node.count < 5
        """,
    )

    result.assert_outcomes(passed=2, failed=1)
    result.stdout.fnmatch_lines(["*assert 5 < 5*", "*rate=5,*"])


def test_generated_examples_share_no_node(pytester: pytest.Pytester) -> None:
    """A fixture is made once for all examples, and so would be its graph."""
    result = run(
        pytester,
        """
        import pytest
        from hypothesis import given, strategies as st

        @pytest.fixture
        def tap(graph):
            return None

        @given(n=st.integers())
        async def test_it(graph, tap, n):
            pass
        """,
    )

    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*each example has its own graph, which 'tap' cannot use*"])


def test_each_test_has_a_loop_of_its_own(pytester: pytest.Pytester) -> None:
    """Leftovers of one test do not reach the next, and its loop is closed."""
    result = run(
        pytester,
        """
        import asyncio

        loops = []

        async def test_one(graph):
            loops.append(asyncio.get_running_loop())

        async def test_two(graph, graphflow_runner):
            assert asyncio.get_running_loop() is not loops[0]
            assert loops[0].is_closed()
            assert graphflow_runner.get_loop() is asyncio.get_running_loop()
        """,
    )

    result.assert_outcomes(passed=2)


@slow
def test_the_plugin_is_light() -> None:
    """Every pytest run loads it, so it imports no slow module."""
    code = "import graphflow.testing.plugin, json, sys; print(json.dumps(sorted(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)

    modules = set(json.loads(done.stdout))
    assert not modules & {"numpy", "pydantic", "graphflow.runtime.node", "graphflow.testing.graph", "zenoh"}


def test_an_async_test_without_the_fixture(pytester: pytest.Pytester) -> None:
    """The error names the fixture that makes it run."""
    result = run(
        pytester,
        """
        import counter

        async def test_counts():
            pass
        """,
    )
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["graphflow runs async tests that use its fixture: write async def test_counts(graph)"])
