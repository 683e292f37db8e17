"""The workings of one node, behind `Node`: its parts, its life, its handlers' runners, and what becomes of errors."""

from __future__ import annotations

import asyncio
import concurrent.futures
import inspect
from asyncio import CancelledError
from collections import deque
from collections.abc import Callable, Coroutine, Iterable, Mapping
from contextlib import AsyncExitStack
from functools import cache
from typing import Any, ClassVar, Protocol, TypeVar

from graphflow.deadlock import races
from graphflow.deadlock.protocols import Unopened
from graphflow.errors import ClosedError, DeclarationError, ParameterError, UsageFault
from graphflow.executor.clock import Clock
from graphflow.executor.groups import Groups, HandlerGroup
from graphflow.executor.runner import Runner, RunnerSpec
from graphflow.interface import OnError
from graphflow.machines.regrouping import Regrouping
from graphflow.msgs import registry
from graphflow.names import Resolver
from graphflow.qos import PARAMETERS, SERVICES, Qos
from graphflow.runtime.context import Context
from graphflow.runtime.declarations import declared
from graphflow.runtime.declarations.binding import Binding, Creator
from graphflow.runtime.declarations.checks import check_node
from graphflow.runtime.declarations.declare import Group
from graphflow.runtime.declarations.misplaced import check_made
from graphflow.runtime.endpoints.endpoint import Endpoint
from graphflow.runtime.endpoints.services import ServiceServer
from graphflow.runtime.failures import ErrorBudget, Failures, report
from graphflow.runtime.logs.logger import node_logger
from graphflow.runtime.logs.rosout import Rosout
from graphflow.runtime.mistakes.other_threads import call_soon
from graphflow.runtime.mistakes.repeats import Repeats
from graphflow.runtime.mistakes.slow_hooks import when_slow
from graphflow.runtime.mistakes.source.slips import slips
from graphflow.runtime.node_clock import NodeClock
from graphflow.runtime.node_options import unused_remaps
from graphflow.runtime.node_services import LoggerLevels, TypeDescriptions
from graphflow.runtime.parameters.params import ParameterChange, Parameters
from graphflow.runtime.parameters.services import ParameterEvents, ParameterServices
from graphflow.runtime.part import Part
from graphflow.wire.liveliness import Entity, Kind

P = TypeVar("P", bound=Part)

STOP_LIMIT = 2.0
"""Seconds that cancelled handlers and tasks have for their cleanup."""


class Instance(declared.NodeClass, Creator, Protocol):
    """What the core needs from the user's object."""

    error_budget: ClassVar[ErrorBudget | None]

    async def on_start(self) -> None: ...

    async def on_shutdown(self) -> None: ...


class NodeCore:
    """What a `Node` is made of: its parts' `Host`, and the search's `Subject`.

    Args:
        overrides: Parameter values from outside, by name, each with where it was written.
        concurrency: What a graph file says about its groups.
    """

    def __init__(
        self,
        instance: Instance,
        names: Resolver,
        overrides: Mapping[str, tuple[Any, str]],
        concurrency: Regrouping,
    ) -> None:
        cls = type(instance)
        self.instance = instance
        self.names = names
        self.id = 0
        self.log = node_logger(self.full_name)
        self.parameters = Parameters(overrides)
        self.groups = Groups(declared.groups(cls), cls.default_group, concurrency)
        self.starting: asyncio.Task[Any] | None = None
        """The task in which `on_start` runs, until it returns."""
        self.tasks: set[asyncio.Task[Any]] = set()
        """Tasks that `spawn` has started and that have not ended."""
        self.runners: list[Runner] = []
        self.refuses_unused = False
        """Whether remap rules that match nothing are an error."""
        self.failure: BaseException | None = None
        """The error that ended the node."""
        self.failure_taken = False
        """Whether the end of the node was waited for."""
        self.entered = AsyncExitStack()
        """Context managers that are left after `on_shutdown`."""
        self._made: dict[str, Any] = {}
        """What `Node.__init__` has set on the instance."""
        self._context: Context | None = None
        self._ended: asyncio.Future[None] | None = None
        self.parts: list[Part] = []
        self._late: list[Part] | None = []
        """What is opened once `on_start` has returned; None from then on."""
        self._binding = Binding(instance, self, self.parameters)
        self._failures = Failures(self, instance.error_budget, self._fail)
        self._repeats = Repeats(self)
        self._token: Any = None
        self._own_services: set[str] = set()
        self._rosout: Rosout | None = None
        self._parameter_events: ParameterEvents | None = None
        self._clock = NodeClock(self, self.names.resolve, self.add)

    # who it is

    @property
    def name(self) -> str:
        return self.names.name

    @property
    def namespace(self) -> str:
        return self.names.namespace

    @property
    def full_name(self) -> str:
        return self.names.full_name

    @property
    def is_running(self) -> bool:
        return self._context is not None

    @property
    def has_started(self) -> bool:
        """Whether `on_start` has returned."""
        return self._late is None

    @property
    def context(self) -> Context:
        if self._context is None:
            raise ClosedError(f"node {self.full_name} is not running")
        return self._context

    @property
    def clock(self) -> Clock:
        return self._clock.current

    # what it has

    @property
    def held(self) -> Mapping[str, Any]:
        """What the declarations of the class have become, by attribute."""
        return self._binding.held

    @property
    def handlers(self) -> frozenset[str]:
        """Methods that are known as handlers before a node is made, declared or read from the source."""
        return _handlers(type(self.instance))

    @property
    def hooks(self) -> frozenset[str]:
        return declared.hooks(type(self.instance))

    @property
    def endpoints(self) -> list[Endpoint]:
        """Everything the node has on the network; for actions, the services and topics that they consist of."""
        return [endpoint for part in self.parts for endpoint in part.endpoints]

    @property
    def unopened(self) -> list[Unopened]:
        found = [Unopened(part.handler_title, _services(part)) for part in self._late or ()]
        tasks = [name for name, h in declared.handlers(type(self.instance)).items() if h.kind == "task"]
        return [*found, *(Unopened(f"task {name}") for name in tasks)] if self._late is not None else []

    def serves(self, service: str) -> bool:
        return any(e.kind is Kind.SERVICE and e.name == service for e in self.endpoints)

    def statistics(self) -> dict[str, dict[str, Any]]:
        """Numbers since the start, by the name of each handler, endpoint and group."""
        found = {f"group {name}": group.statistics() for name, group in self.groups.by_name.items()}
        return found | {part.title: part.statistics() for part in self.parts if part.title}

    # how it is made

    def bind(self, *, parameter_services: bool, rosout: bool, logger_service: bool) -> None:
        """Make what the class declares, and what every node has."""
        self._made = dict(vars(self.instance))
        self._binding.bind_parameters()
        self.parameters.observe(self._parameters_changed)
        if rosout:
            self._rosout = self.add(Rosout(self))
        if parameter_services:
            for name, type_name, callback in ParameterServices(self.parameters).handlers():
                self.serve(name, f"rcl_interfaces/srv/{type_name}", callback, PARAMETERS)
            self._parameter_events = self.add(ParameterEvents(self, self.parameters))
            if self.parameters.get("start_type_description_service"):
                descriptions = TypeDescriptions(lambda: self.endpoints)
                type_name = "type_description_interfaces/srv/GetTypeDescription"
                self.serve("get_type_description", type_name, descriptions.get, SERVICES)
        if logger_service:
            levels = LoggerLevels(self.log)
            self.serve("get_logger_levels", "rcl_interfaces/srv/GetLoggerLevels", levels.get, SERVICES)
            self.serve("set_logger_levels", "rcl_interfaces/srv/SetLoggerLevels", levels.set, SERVICES)
        self._binding.bind()

    def serve(self, name: str, type_name: str, callback: Callable[[Any], Any], qos: Qos) -> None:
        """Make one of the services that every node has; they exist before `on_start` runs."""
        type_: Any = registry.interface_class(type_name)
        self._own_services.add(f"~/{name}")
        resolved = self.names.resolve(f"~/{name}", "service")
        self.add(ServiceServer(self, type_, resolved, qos, callback, name, is_inner=True))

    def add(self, part: P, *, late: bool = False) -> P:
        """Add a part, and open it if the time has come: `late` ones wait for `on_start`. May raise WrongThread."""
        if self._context is not None:
            self._context.refuse_other_threads(f"create_... of node {self.full_name}")
        self.parts.append(part)
        if late and self._late is not None:
            self._late.append(part)
        elif self._context is not None:
            part.open()
        if self.has_started:
            self._repeats.made(part)
        return part

    def forget(self, part: Part) -> None:
        if part in self.parts:
            self.parts.remove(part)
        self._repeats.closed(part)
        if self._late and part in self._late:
            self._late.remove(part)

    def place(
        self, callback: Callable[..., Any] | None, otherwise: str, group: Group | HandlerGroup | None, thread: bool
    ) -> tuple[str, Any, HandlerGroup | None]:
        """A handler's name, how to call it, and the group whose slots its runs take.

        Args:
            callback: None for a subscription that is iterated.
            otherwise: What stands for a handler without a name, such as a lambda.
        """
        name = getattr(callback, "__name__", "")
        label = name if name and name != "<lambda>" else otherwise
        if callback is None:
            return label, None, None
        place = self.groups.place(label, group)
        threaded = thread or (place.is_threaded and not inspect.iscoroutinefunction(callback))
        return label, self._in_thread(callback) if threaded else callback, place.group

    def _in_thread(self, fn: Callable[..., Any]) -> Callable[..., Coroutine[Any, Any, Any]]:
        if inspect.iscoroutinefunction(fn):
            raise ValueError(f"{fn.__qualname__}: thread=True is for `def`, an `async def` runs on the loop")

        async def run(*args: Any) -> Any:
            # A thread cannot be cancelled: until it has ended the run goes on, and holds its slot.
            return await self.context.in_thread(fn, *args, stays=True)

        return run

    def runner(self, spec: RunnerSpec, items: deque[Any], group: HandlerGroup | None = None) -> Runner:
        made = Runner(self.context.ledger, spec, items, group)
        self.runners[:] = [r for r in self.runners if not r.closed or r.active]
        self.runners.append(made)
        return made

    def ensure_made(self) -> None:
        """Check that the node was made correctly.

        Raises:
            DeclarationError: Its `__init__` has overwritten an attribute that every node has.
            ParameterError: A value was given for a parameter that it does not have.
        """
        for attribute, value in self._made.items():
            if vars(self.instance).get(attribute) is not value:
                cls = type(self.instance).__name__
                raise DeclarationError(f"{cls}: every node has self.{attribute}; choose another name")
        check_made(self.instance)
        if unused := self.parameters.unused_overrides(type(self.instance)):
            raise ParameterError(f"node {self.full_name}: " + "; ".join(unused))

    # its life

    async def start(self, context: Context) -> None:
        """Go on the network: open what is declared, announce it, start timers and tasks.

        Raises:
            GraphflowError: An override names no parameter, `concurrency` no handler, or something cannot be opened;
            nothing is left open.
            ClosedError: The node is already running, or has been stopped.
        """
        if self._ended is not None:
            state = "is already running" if self.is_running else "has been stopped; make a new one"
            raise ClosedError(f"node {self.full_name} {state}")
        self.ensure_made()
        self._context = context
        self.id = context.next_id()
        self._ended = context.loop.create_future()
        context.nodes.append(self)
        if races.is_wanted():
            races.watch(self.instance, self.full_name, self.log, frozenset(self._made))
        try:
            await self._open(context)
            self.warn_unused_remaps()
            for slip in slips(type(self.instance)):
                self.log.warning("%s", slip)
            await self._begin()
        except BaseException:  # cancellation included: nothing stays open
            await self.stop()
            raise

    async def _begin(self) -> None:
        """Start what the class declares as `@task`."""
        for attribute, handler in declared.handlers(type(self.instance)).items():
            if handler.kind == "task":
                self.spawn(getattr(self.instance, attribute))

    async def _open(self, context: Context) -> None:
        node = Entity(context.domain, context.session.zid, self.id, self.id, Kind.NODE, self.namespace, self.name)
        self._token = context.session.announce(node.token)
        assert self._late is not None
        for part in [part for part in self.parts if part not in self._late]:
            part.open()
        if self.parameters.get("use_sim_time"):
            self._follow_sim_time()
        slow = when_slow(self, "on_start")
        self.starting = asyncio.current_task()
        context.search.arm()
        try:
            await self.instance.on_start()
        except Exception as error:
            self.refuses_unused = False
            self.warn_unused_remaps()  # which may be why
            self.failure = error
            self.report_error("on_start", error)
            raise
        finally:
            self.starting = None
            slow.cancel()
        self.groups.refuse_strays()
        late, self._late = self._late, None
        for part in sorted(late, key=lambda part: part.opens_last):
            part.open()

    def warn_unused_remaps(self) -> None:
        """Warn of remap rules that have matched nothing, or raise a UsageFault where their author waits for it."""
        if (problems := self.unused_remaps()) and self.refuses_unused:
            raise UsageFault("; ".join(problems))
        for problem in problems:
            self.log.warning("%s", problem)

    def unused_remaps(self) -> list[str]:
        """What is wrong with the remap rules that have matched nothing so far, a sentence for each."""
        return list(unused_remaps(self.names, self._own_services, self.instance.dynamic_names, self.parameters))

    def complaints(self) -> list[str]:
        """What is wrong with the node that it knows itself, a sentence for each."""
        return [*self.unused_remaps(), *self._clock.complaints(), *(c for p in self.parts for c in p.complaints())]

    def shutdown(self) -> None:
        """End the node from within, from any thread: the code that runs it will stop it."""
        if self._context is not None and not self._context.is_here:
            call_soon(self, self.shutdown, ())
        elif self._ended is not None and not self._ended.done():
            self._ended.set_result(None)

    async def wait_ended(self) -> None:
        """Wait until the node ends itself by `shutdown` or fails; raises the error it failed with."""
        assert self._ended is not None
        try:
            await asyncio.shield(self._ended)
        finally:
            self.failure_taken = True

    async def stop(self) -> None:
        """Leave the network: cancel handlers and tasks, wait for their cleanup, withdraw everything."""
        context = self._context
        if context is None:
            return
        try:
            await self.end(self.begin_to_stop(), self.tasks)
            await self._finish()
        finally:
            self.log.say_gathered()
            # Even when this wait is cancelled: nothing stays open.
            if self._rosout is not None:
                self._rosout.detach()
            for part in list(reversed(self.parts)):
                part.close()
            if self._token is not None:
                self._token.close()
            if self._ended is not None and not self._ended.done():
                self._ended.cancel()
            if self in context.nodes:  # two callers may stop a node
                context.nodes.remove(self)
            self._context = None

    def begin_to_stop(self) -> list[Runner | None]:
        """Have timers and the like begin no more work; returns the runners, whose `cancel` does the same for runs."""
        return [*(part.begin_to_stop() for part in self.parts), *self._binding.runners()]

    async def end(self, runners: Iterable[Runner | None], tasks: Iterable[asyncio.Task[Any]]) -> None:
        """Cancel what runs and give it time to clean up."""
        ending: dict[asyncio.Future[Any], str] = {r.cancel(): r.name for r in runners if r is not None}
        for task in {*tasks} - {asyncio.current_task()}:
            task.cancel()
            ending[task] = task.get_name()
        if ending:
            _, stuck = await asyncio.wait(ending, timeout=STOP_LIMIT)
            if stuck:
                names = ", ".join(ending[future] for future in stuck)
                self.log.warning("still running %.0f s after it was cancelled: %s", STOP_LIMIT, names)

    async def _finish(self) -> None:
        if self.has_started:
            await self.limited("on_shutdown", self.instance.on_shutdown)
        await self.limited("leaving what was entered", self.entered.aclose)

    async def limited(self, what: str, work: Callable[[], Coroutine[Any, Any, Any]]) -> None:
        """Do one part of stopping: if it fails or takes too long, the rest is done all the same."""
        try:
            async with asyncio.timeout(STOP_LIMIT):
                await work()
        except TimeoutError:
            self.log.warning("%s took more than %.0f s and was cancelled", what, STOP_LIMIT)
        except Exception as error:
            self.report_error(what, error)

    def spawn(self, fn: Callable[..., Coroutine[Any, Any, Any]], *args: Any) -> asyncio.Task[Any]:
        """Run `fn(*args)` alongside everything else until the node stops. An error in it ends the node."""
        task = self.context.loop.create_task(fn(*args), name=f"{self.full_name}.{getattr(fn, '__name__', 'task')}")
        self.tasks.add(task)
        task.add_done_callback(self._task_done)
        self.context.search.arm()
        return task

    def _task_done(self, task: asyncio.Task[Any]) -> None:
        self.tasks.discard(task)
        if task.cancelled() or (error := task.exception()) is None:
            return
        if self._ended is not None and not self._ended.done():
            self.report_error(f"task {task.get_name()}", error)
            self._fail(error)

    def handler_failed(self, label: str, error: BaseException, on_error: OnError | None = None) -> None:
        if isinstance(error, (CancelledError, concurrent.futures.CancelledError)):  # from a coroutine, or from a thread
            return
        if on_error is None or not self.is_running:  # stopping did not wait for this run
            self.report_error(label, error)
        else:
            self._failures.failed(label, error, on_error)

    def report_error(self, label: str, error: BaseException) -> None:
        report(self.log, label, error)
        if self._context is not None and error is not self.failure:
            self._context.noticed(error)

    def _fail(self, error: BaseException) -> None:
        """End the node with an error."""
        if self._ended is not None and not self._ended.done():
            self.failure = error
            self._ended.set_exception(error)
            self._ended.exception()  # it is logged: asyncio need not complain when nothing waits for it

    # parameters and time

    def _parameters_changed(self, changes: Mapping[str, ParameterChange]) -> None:
        if self._context is None:
            return
        if "use_sim_time" in changes:
            self._follow_sim_time()
        if self._parameter_events is not None:
            self._parameter_events.tell(changes)

    def _follow_sim_time(self) -> None:
        """Follow /clock, or the context's clock, as the parameter `use_sim_time` says."""
        self._clock.follow(is_simulated=bool(self.parameters.get("use_sim_time")))
        for part in self.parts:
            part.clock_changed()
            for endpoint in part.endpoints:
                if endpoint is not part:
                    endpoint.clock_changed()


def _services(part: Part) -> tuple[str, ...]:
    return tuple(endpoint.name for endpoint in part.endpoints if endpoint.kind is Kind.SERVICE)


@cache
def _handlers(cls: Any) -> frozenset[str]:
    return frozenset(handler.name for handler in cls.interface().handlers)


def core_of(node: object) -> NodeCore:
    """The workings of a `Node`, for what runs it. Raises DeclarationError for what is none, or was not fully made."""
    check_node(node)
    core = vars(node).get("_core")
    if not isinstance(core, NodeCore):
        raise DeclarationError(f"{type(node).__name__}.__init__ must call super().__init__(...)")
    return core
