"""Execution of handlers: each from its queue, in its own context, separated by groups, and in turns."""

from __future__ import annotations

import asyncio
import gc
import itertools
import weakref
from asyncio import CancelledError
from collections import deque
from collections.abc import Callable
from contextvars import ContextVar
from random import Random
from typing import Any

import pytest

from graphflow.executor import runner
from graphflow.executor.groups import HandlerGroup
from graphflow.executor.ledger import Ledger
from graphflow.executor.runner import BURST, Run, Runner, RunnerSpec
from graphflow.testing.clock import settle
from tests.cases import slow

Handler = Callable[[Any], Any]


class Bench:
    """A runner with a queue to fill, and a record of how its runs ended."""

    def __init__(self, handler: Handler, group: HandlerGroup | None = None, name: str = "bench") -> None:
        self.loop = asyncio.get_running_loop()
        self.items: deque[Any] = deque()
        self.ended: list[tuple[Any, Any, BaseException | None]] = []
        slots: HandlerGroup = group if group is not None else HandlerGroup(1)
        spec = RunnerSpec(name, handler, self._finished)
        self.runner = Runner(Ledger(self.loop), spec, self.items, slots)

    def _finished(self, item: Any, result: Any, error: BaseException | None) -> None:
        self.ended.append((item, result, error))

    def put(self, *items: Any) -> None:
        """Have items arrive as they do in life: by the loop, outside of every task."""
        self.items.extend(items)
        self.loop.call_soon(self.runner.wake)

    @property
    def results(self) -> list[Any]:
        return [result for _, result, _ in self.ended]

    @property
    def errors(self) -> list[BaseException | None]:
        return [error for _, _, error in self.ended]


# runs


async def test_a_run_is_used_again_only_if_nobody_has_kept_it(graphflow_runner: asyncio.Runner) -> None:
    """Data that libraries attach to a task, even weakly, must not leak to the next message's run."""
    kept: list[Any] = []
    numbers: list[int] = []

    async def handler(item: int) -> None:
        run: Any = asyncio.current_task()
        assert run.item == item
        numbers.append(run.number)
        if item == 3:
            kept.append(run)
        elif item == 4:
            kept.append(weakref.ref(run))

    bench = Bench(handler)
    bench.put(1)
    await settle()
    spare = id(bench.runner._spare)
    bench.put(2)
    await settle()
    assert bench.runner._spare is not None
    assert id(bench.runner._spare) == spare
    for item in (3, 4):
        bench.put(item)
        await settle()
        assert bench.runner._spare is None
    assert kept[0].done()
    assert kept[1]() is None
    assert numbers == sorted(set(numbers))
    assert bench.runner.active == set()


async def test_a_run_that_was_asked_to_cancel_is_not_used_again(graphflow_runner: asyncio.Runner) -> None:
    """Nor one that has waited: the next begins without a request to cancel."""
    asked: list[int] = []

    async def handler(item: int) -> None:
        run: Any = asyncio.current_task()
        asked.append(run.cancelling())
        if item == 1:
            run.cancel()

    bench = Bench(handler)
    bench.put(1, 2)
    await settle()
    assert asked == [0, 0]


async def test_a_run_that_is_used_again_has_nothing_of_the_last(graphflow_runner: asyncio.Runner) -> None:
    """Its group and its context variables are those of its own message, before and after it waits."""
    word: ContextVar[str] = ContextVar("word", default="none")
    first, second = HandlerGroup(1), HandlerGroup(1)
    seen: list[tuple[bool, str, str]] = []

    async def handler(item: str) -> None:
        run: Any = asyncio.current_task()
        before = word.get()
        word.set(item)
        if item == "waits":
            await asyncio.sleep(0)
        seen.append((run.group is second, before, word.get()))

    bench = Bench(handler, first)
    bench.put("ends")
    await settle()
    assert bench.runner._spare is not None
    bench.runner.move(second)
    bench.put("waits")
    await settle()
    assert seen == [(False, "none", "ends"), (True, "none", "waits")]


def test_an_exit_in_the_first_step_ends_the_run() -> None:
    """The program is ended by it, and the group has its slot again."""

    async def handler(item: int) -> None:
        raise SystemExit(item)

    async def make() -> Bench:
        return Bench(handler, group)

    group = HandlerGroup(1)
    with asyncio.Runner() as asyncio_runner:
        bench = asyncio_runner.run(make())
        bench.put(3)
        with pytest.raises(SystemExit):
            asyncio_runner.get_loop().run_forever()
    assert (bench.runner.active, group.running, [type(e) for e in bench.errors]) == (set(), 0, [SystemExit])


async def test_a_runner_may_want_to_hear_of_errors_only(graphflow_runner: asyncio.Runner) -> None:
    """It is then not called for successful runs."""
    told: list[Any] = []

    def handler(item: int) -> float:
        return 1 / item

    spec = RunnerSpec("bench", handler, lambda item, _, error: told.append((item, type(error))), wants_results=False)
    runner = Runner(Ledger(asyncio.get_running_loop()), spec, deque([1, 0, 2]))
    runner.wake()
    assert told == [(0, ZeroDivisionError)]
    assert (runner.runs, runner.errors) == (3, 1)


# what asyncio offers


async def test_current_task_is_the_run(graphflow_runner: asyncio.Runner) -> None:
    """A handler's current task is its run, with its item and the handler's name."""
    seen: list[Any] = []

    async def handler(item: object) -> None:
        run = asyncio.current_task()
        assert isinstance(run, Run)
        seen.append((run.get_name(), run.item))

    bench = Bench(handler, name="/talker.greet")
    bench.put(0)
    await settle()

    assert seen == [("/talker.greet", 0)]


async def test_events_queues_and_locks(graphflow_runner: asyncio.Runner) -> None:
    """asyncio's own means of waiting for one another work between handlers."""
    queue: asyncio.Queue[int] = asyncio.Queue(maxsize=1)
    event, lock = asyncio.Event(), asyncio.Lock()
    log: list[str] = []

    async def produce(n: int) -> None:
        async with lock:
            await queue.put(n)
            log.append(f"put {n}")
        if n == 2:
            event.set()

    async def consume(_: object) -> None:
        await event.wait() if queue.empty() and log else None
        for _ in range(3):
            log.append(f"got {await queue.get()}")

    producer, consumer = Bench(produce, HandlerGroup(None)), Bench(consume)
    producer.put(0, 1, 2)
    consumer.put(0)
    await settle()

    assert [line for line in log if line.startswith("got")] == ["got 0", "got 1", "got 2"]
    assert [line for line in log if line.startswith("put")] == ["put 0", "put 1", "put 2"]
    assert event.is_set()
    assert not lock.locked()


async def test_a_condition_and_a_semaphore(graphflow_runner: asyncio.Runner) -> None:
    """Waiters are woken once and permits are given back."""
    condition, permits = asyncio.Condition(), asyncio.Semaphore(1)
    awake: list[int] = []

    async def handler(n: int) -> None:
        async with permits:
            pass
        async with condition:
            await condition.wait()
            awake.append(n)

    bench = Bench(handler, HandlerGroup(None))
    bench.put(1, 2)
    await settle()
    async with condition:
        condition.notify(1)
    await settle()
    assert awake == [1]
    async with condition:
        condition.notify_all()
    await settle()

    assert awake == [1, 2]


async def test_sleep_zero_gives_the_loop_a_turn(graphflow_runner: asyncio.Runner) -> None:
    """`asyncio.sleep(0)` lets others run in between."""
    log: list[str] = []

    async def handler(name: str) -> None:
        for n in range(2):
            log.append(f"{name}{n}")
            await asyncio.sleep(0)

    bench = Bench(handler, HandlerGroup(None))
    bench.put("a", "b")
    await settle()

    assert log == ["a0", "b0", "a1", "b1"]


@pytest.mark.parametrize("suspends", [False, True])
@pytest.mark.parametrize("queued", [False, True])
async def test_context_variables_stay_in_their_run(
    graphflow_runner: asyncio.Runner, suspends: bool, queued: bool
) -> None:
    """A run's context variables are invisible to the next run and to handlers it wakes."""
    variable: ContextVar[str] = ContextVar("variable", default="clean")
    seen: list[str] = []

    async def handler(n: int) -> None:
        seen.append(variable.get())
        variable.set(f"of run {n}")
        if suspends:
            await asyncio.sleep(0)
        assert variable.get() == f"of run {n}"
        other.put(n)

    async def look(_: object) -> None:
        seen.append(variable.get())

    bench, other = Bench(handler), Bench(look)
    if queued:
        bench.put(1, 2, 3)
        await settle()
    else:
        for n in range(3):
            bench.put(n)
            await settle()

    assert seen == ["clean"] * 6
    assert bench.errors == [None] * 3


async def test_context_variables_of_a_plain_function_stay_in_their_run(graphflow_runner: asyncio.Runner) -> None:
    """A `def` handler's settings do not outlive it either."""
    variable: ContextVar[str] = ContextVar("variable", default="clean")
    seen: list[str] = []

    def handler(n: int) -> None:
        seen.append(variable.get())
        variable.set(f"of run {n}")

    bench = Bench(handler)
    bench.put(1, 2)
    await settle()

    assert seen == ["clean", "clean"]


async def test_runs_begin_with_the_context_of_where_the_runner_was_made(graphflow_runner: asyncio.Runner) -> None:
    """Every run sees the variables that the program set before it created the handler."""
    variable: ContextVar[str] = ContextVar("variable", default="nothing")
    variable.set("the program")
    seen: list[str] = []

    async def handler(_: object) -> None:
        seen.append(variable.get())

    bench = Bench(handler)
    variable.set("something later")
    bench.put(1)
    await settle()

    assert seen == ["the program"]


# cancellation


async def test_a_suspended_run_is_cancelled_at_its_await(graphflow_runner: asyncio.Runner) -> None:
    """The run raises CancelledError at its await, `finally` blocks run, and the future reports the end."""
    log: list[str] = []

    async def handler(_: object) -> None:
        try:
            await asyncio.Event().wait()
        except CancelledError:
            log.append("cancelled")
            raise
        finally:
            await asyncio.sleep(0)
            log.append("cleaned up")

    bench = Bench(handler)
    bench.put(1, 2)
    await settle()
    idle = bench.runner.cancel()
    assert not idle.done()
    await idle

    assert log == ["cancelled", "cleaned up"]
    assert [item for item, _, _ in bench.ended] == [1]
    assert isinstance(bench.errors[0], CancelledError)
    assert not bench.runner.active


async def test_cancelling_an_idle_runner_is_done_at_once(graphflow_runner: asyncio.Runner) -> None:
    """The future is done, and later arrivals are not run."""
    bench = Bench(lambda item: item)

    assert bench.runner.cancel().done()
    bench.put(1)
    await settle()

    assert bench.ended == []


async def test_cancelling_twice_waits_for_the_same_end(graphflow_runner: asyncio.Runner) -> None:
    """Both who cancel hear of the end."""
    gate = asyncio.Event()

    async def handler(_: object) -> None:
        try:
            await asyncio.Event().wait()
        finally:
            await gate.wait()

    bench = Bench(handler)
    bench.put(1)
    await settle()
    first = bench.runner.cancel()
    await settle()
    gate.set()
    await first
    second = bench.runner.cancel()

    assert second.done()

    other = Bench(handler)
    gate.clear()
    other.put(1)
    await settle()
    early = other.runner.cancel()
    await settle()
    late = other.runner.cancel()  # the cleanup goes on undisturbed
    await settle()
    assert not early.done()
    assert not late.done()

    gate.set()
    await settle()
    assert early.done()
    assert late.done()


@slow
@pytest.mark.parametrize("fails", [False, True])
@pytest.mark.parametrize("waits", [False, True])
async def test_an_ended_run_keeps_nothing_alive(graphflow_runner: asyncio.Runner, waits: bool, fails: bool) -> None:
    """A message is freed at the end of its run, without the garbage collector."""

    class Payload:
        pass

    async def handler(_: Payload) -> None:
        if waits:
            await asyncio.sleep(0)
        if fails:
            raise ValueError("wrong")

    bench = Bench(handler)
    bench.runner._finished = lambda *_: None
    gc.collect()
    gc.disable()
    try:
        payload = Payload()
        gone = weakref.ref(payload)
        bench.put(payload)
        del payload
        await settle()
        assert gone() is None
    finally:
        gc.enable()


# errors


class Unusual(BaseException):
    """Not caught by `except Exception`."""


@pytest.mark.parametrize("error", [ValueError, CancelledError, Unusual])
@pytest.mark.parametrize("when", ["def", "at once", "later"])
async def test_an_error_does_not_stop_later_messages(
    graphflow_runner: asyncio.Runner, error: type[BaseException], when: str
) -> None:
    """Whatever a run raises is reported with its item, and the next item is run."""

    async def at_once(item: int) -> int:
        if item == 1:
            raise error("wrong")
        return item

    async def later(item: int) -> int:
        await asyncio.sleep(0)
        return await at_once(item)

    def plain(item: int) -> int:
        if item == 1:
            raise error("wrong")
        return item

    bench = Bench({"def": plain, "at once": at_once, "later": later}[when])
    bench.put(0, 1, 2, 3)
    await settle()

    assert bench.results == [0, None, 2, 3]
    assert [type(e) for e in bench.errors] == [type(None), error, type(None), type(None)]
    assert bench.runner.errors == (error is not CancelledError)


async def test_a_function_that_raises_stop_iteration_has_failed(graphflow_runner: asyncio.Runner) -> None:
    """It is no coroutine, whose end that would be."""

    def handler(item: int) -> None:
        raise StopIteration(item)

    bench = Bench(handler)
    bench.put(1)
    await settle()
    assert bench.results == [None]
    assert [type(e) for e in bench.errors] == [StopIteration]


async def test_an_error_in_the_report_does_not_stop_later_messages(graphflow_runner: asyncio.Runner) -> None:
    """If `finished` fails, the loop's exception handler is called, and the slot is free again."""
    loop = asyncio.get_running_loop()
    told: list[str] = []
    loop.set_exception_handler(lambda _, context: told.append(str(context.get("exception"))))
    runs: list[int] = []

    def fail(item: int, result: Any, error: BaseException | None) -> None:
        raise ValueError(f"report {item}")

    bench = Bench(runs.append)
    bench.runner._finished = fail
    bench.put(1, 2)
    await settle()

    assert runs == [1, 2]
    assert told == ["report 1", "report 2"]


# groups


async def test_a_handler_queues_behind_itself(graphflow_runner: asyncio.Runner) -> None:
    """In a group of its own a handler has one run at a time, in the order of arrival, across every await."""
    log: list[str] = []

    async def handler(n: int) -> None:
        log.append(f"+{n}")
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        log.append(f"-{n}")

    bench = Bench(handler)
    bench.put(1, 2, 3)
    await settle()

    assert log == ["+1", "-1", "+2", "-2", "+3", "-3"]


async def test_handlers_of_different_groups_do_not_wait_for_each_other(graphflow_runner: asyncio.Runner) -> None:
    """One that is stuck leaves the other alone."""

    async def stuck(_: object) -> None:
        await asyncio.Event().wait()

    first, second = Bench(stuck), Bench(lambda item: item)
    first.put(1)
    second.put(1, 2)
    await settle()

    assert second.results == [1, 2]
    assert len(first.runner.active) == 1
    await first.runner.cancel()


async def test_a_shared_group_of_one_excludes(graphflow_runner: asyncio.Runner) -> None:
    """Two handlers of one group never run at one time, and take turns."""
    group: HandlerGroup = HandlerGroup(1)
    inside: list[str] = []
    log: list[str] = []

    async def handler(item: str) -> None:
        inside.append(item)
        assert len(inside) == 1
        await asyncio.sleep(0)
        assert inside == [item]
        log.append(item)
        inside.remove(item)

    first, second = Bench(handler, group), Bench(handler, group)
    first.put("a1", "a2", "a3")
    second.put("b1", "b2", "b3")
    await settle()

    assert log == ["a1", "b1", "a2", "b2", "a3", "b3"]
    assert first.errors == second.errors == [None] * 3
    assert group.running == 0


@pytest.mark.parametrize(("limit", "most"), [(None, 6), (2, 2), (4, 4)])
async def test_as_many_runs_as_the_group_allows(graphflow_runner: asyncio.Runner, limit: int | None, most: int) -> None:
    """A group's limit counts the runs of all its handlers together; None sets none."""
    group: HandlerGroup = HandlerGroup(limit)
    now = peak = 0

    async def handler(_: object) -> None:
        nonlocal now, peak
        now += 1
        peak = max(peak, now)
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        now -= 1

    benches = [Bench(handler, group), Bench(handler, group)]
    for bench in benches:
        bench.put(1, 2, 3)
    await settle()

    assert peak == most
    assert [len(b.ended) for b in benches] == [3, 3]
    assert group.running == 0


async def test_a_slot_is_held_until_the_cleanup_has_ended(graphflow_runner: asyncio.Runner) -> None:
    """The `finally` of a run is over before the next one of its group begins."""
    group: HandlerGroup = HandlerGroup(1)
    log: list[str] = []

    async def first(_: object) -> None:
        try:
            log.append("body")
            raise ValueError("wrong")
        finally:
            await asyncio.sleep(0)
            log.append("cleanup")

    one, two = Bench(first, group), Bench(lambda _: log.append("second"), group)
    one.put(1)
    two.put(1)
    await settle()

    assert log == ["body", "cleanup", "second"]


async def test_a_cancelled_waiter_passes_its_slot_on(graphflow_runner: asyncio.Runner) -> None:
    """A handler that ends after a slot was handed to it, and before it ran, gives the slot to the next."""
    group: HandlerGroup = HandlerGroup(1)
    gate = asyncio.Event()

    async def holds(_: object) -> None:
        await gate.wait()

    holder = Bench(holds, group)
    waiter, last = Bench(lambda item: item, group), Bench(lambda item: item, group)
    holder.put(1)
    waiter.put(1)
    last.put(1)
    await settle()
    assert group.waiting == (waiter.runner, last.runner)

    gate.set()
    while waiter.runner in group.waiting:  # until the slot has just been handed over
        await asyncio.sleep(0)
    waiter.runner.cancel()
    await settle()

    assert waiter.ended == []
    assert last.results == [1]
    assert group.running == 0


async def test_a_cancelled_handler_takes_its_ticket_back(graphflow_runner: asyncio.Runner) -> None:
    """Waiters do not queue behind a handler that has withdrawn."""
    group: HandlerGroup = HandlerGroup(1)
    gate = asyncio.Event()

    async def holds(_: object) -> None:
        await gate.wait()

    holder, waiter = Bench(holds, group), Bench(lambda item: item, group)
    holder.put(1)
    waiter.put(1)
    await settle()
    waiter.runner.cancel()
    assert group.waiting == ()
    gate.set()
    await settle()

    assert group.running == 0


@pytest.mark.parametrize("seed", range(60))
async def test_any_schedule(graphflow_runner: asyncio.Runner, seed: int) -> None:
    """With random handlers, arrivals, errors and cancellations no run is lost, doubled or out of order."""
    random = Random(seed)
    limit = random.choice([1, 1, 2, 3, None])
    group: HandlerGroup = HandlerGroup(limit)
    now = 0
    begun: list[list[int]] = [[], [], [], []]

    def make(index: int) -> Handler:
        async def handler(item: int) -> None:
            nonlocal now
            now += 1
            begun[index].append(item)
            try:
                assert limit is None or now <= limit
                for _ in range(random.randrange(3)):
                    await asyncio.sleep(0)
                if random.random() < 0.2:
                    raise ValueError("now and then")
            finally:
                try:
                    if random.random() < 0.3:
                        await asyncio.sleep(0)
                finally:
                    now -= 1

        def plain(item: int) -> None:
            begun[index].append(item)

        return plain if index == 3 else handler

    benches = [Bench(make(index), group) for index in range(4)]
    put = [0, 0, 0, 0]
    for _ in range(120):
        index = random.randrange(4)
        count = random.randrange(1, 4)
        benches[index].put(*range(put[index], put[index] + count))
        put[index] += count
        for _ in range(random.randrange(3)):
            await asyncio.sleep(0)
        if seed % 3 == 0 and random.random() < 0.01:
            benches[index].runner.cancel()
    await settle()

    for bench, items, count in zip(benches, begun, put, strict=True):
        closed = bench.runner._closed
        assert items == list(range(len(items)))
        assert closed or len(items) == count
        assert len(bench.ended) == len(items) == bench.runner.runs
        assert all(isinstance(e, (type(None), ValueError, CancelledError)) for e in bench.errors)
    assert group.running == now == 0
    assert group.waiting == ()


# fairness


@pytest.mark.parametrize("suspends", [False, True])
async def test_a_busy_handler_gives_the_loop_its_turns(graphflow_runner: asyncio.Runner, suspends: bool) -> None:
    """Between two turns of the loop a handler has at most BURST runs, however much is in its queue."""
    runs = 0

    def plain(_: object) -> None:
        nonlocal runs
        runs += 1

    async def handler(item: object) -> None:
        plain(item)
        if suspends:
            await asyncio.sleep(0)

    bench = Bench(handler if suspends else plain)
    bench.put(*range(10 * BURST))
    before = 0
    while runs < 10 * BURST:
        await asyncio.sleep(0)
        assert runs - before <= BURST
        before = runs


async def test_a_slow_handler_gives_the_loop_its_turns(
    graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Once its runs in a row have taken SLICE, the next one waits for the loop."""
    now, runs = 0.0, 0

    def handler(takes: float) -> None:
        nonlocal now, runs
        now += takes
        runs += 1

    monkeypatch.setattr(runner, "monotonic", lambda: now)
    bench = Bench(handler)
    bench.put(*[1.0] * 3, *[runner.SLICE / 4] * 8)
    turns = []
    while runs < 11:
        before = runs
        await asyncio.sleep(0)
        turns.append(runs - before)
    assert [n for n in turns if n] == [1, 1, 1, 5, 3]


async def test_a_pause_of_the_process_does_not_change_the_order(
    graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A handler that is woken begins at once, even if SLICE passes before its first run."""
    times = itertools.count()
    order: list[str] = []
    benches = [Bench(order.append), Bench(order.append)]
    monkeypatch.setattr(runner, "monotonic", lambda: float(next(times)))
    benches[0].put("first", "third")
    benches[1].put("second")
    await settle()
    assert order == ["first", "second", "third"]


async def test_arrivals_do_not_add_up_to_longer_bursts(graphflow_runner: asyncio.Runner) -> None:
    """A handler that never catches up still leaves the loop its turns, however often it is woken."""
    runs = 0

    def handler(_: object) -> None:
        nonlocal runs
        runs += 1

    bench = Bench(handler)
    before = most = 0
    for _ in range(20):
        bench.put(*range(3 * BURST))
        await asyncio.sleep(0)
        most = max(most, runs - before)
        before = runs

    assert most <= BURST
    await settle()
    assert runs == 20 * 3 * BURST


async def test_a_busy_topic_does_not_starve_a_timer_of_its_group(graphflow_runner: asyncio.Runner) -> None:
    """A handler that waits for its turn in a shared group gets it after one run of the busy one."""
    group: HandlerGroup = HandlerGroup(1)
    log: list[str] = []

    async def busy(_: object) -> None:
        log.append("topic")
        await asyncio.sleep(0)

    topic, timer = Bench(busy, group), Bench(lambda _: log.append("timer"), group)
    topic.put(*range(100))
    await asyncio.sleep(0)
    await asyncio.sleep(0)
    timer.put(1)
    behind = len(log)
    await settle()

    assert log.index("timer") <= behind + 1
    assert log.count("topic") == 100
