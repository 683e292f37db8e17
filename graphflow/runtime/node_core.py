"""The implementation of a node: its parts, life cycle, runners and error handling."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Coroutine, Mapping, Sequence
from contextlib import AsyncExitStack
from functools import cache
from typing import Any, TypeVar, TypeVarTuple

from graphflow.deadlock import races
from graphflow.deadlock.protocols import Unopened
from graphflow.errors import ClosedError, DeclarationError, ParameterError, Place, UsageFault
from graphflow.executor.clock import Clock
from graphflow.executor.groups import Groups, HandlerGroup
from graphflow.executor.runner import Runner, RunnerSpec
from graphflow.interface import COMMON_SERVICES, OnError
from graphflow.machines.regrouping import Regrouping
from graphflow.msgs import registry
from graphflow.names import Resolver
from graphflow.qos import PARAMETERS, SERVICES, Qos
from graphflow.runtime.callables import name_of
from graphflow.runtime.context import Context
from graphflow.runtime.declarations import declared
from graphflow.runtime.declarations.binding import Binding, Instance
from graphflow.runtime.declarations.checks import check_node
from graphflow.runtime.declarations.declare import Group
from graphflow.runtime.declarations.misplaced import check_made
from graphflow.runtime.endpoints.endpoint import Endpoint
from graphflow.runtime.endpoints.services import ServiceServer
from graphflow.runtime.failures import Failures, report
from graphflow.runtime.logs.logger import node_logger
from graphflow.runtime.logs.rosout import Rosout
from graphflow.runtime.mistakes import unrun
from graphflow.runtime.mistakes.at_start import warn_at_start, warn_of_variables
from graphflow.runtime.mistakes.other_threads import call_soon
from graphflow.runtime.mistakes.repeats import Repeats
from graphflow.runtime.mistakes.slow_hooks import when_slow
from graphflow.runtime.node_clock import NodeClock
from graphflow.runtime.node_options import unused_remaps, without_super
from graphflow.runtime.node_services import LoggerLevels, TypeDescriptions
from graphflow.runtime.node_work import end_work, limited, placed
from graphflow.runtime.parameters.params import ParameterChange, Parameters
from graphflow.runtime.parameters.services import ParameterEvents, ParameterServices
from graphflow.runtime.part import Part
from graphflow.transport.base import Closable
from graphflow.wire.liveliness import Entity, Kind

P = TypeVar("P", bound=Part)
Ts = TypeVarTuple("Ts")


class NodeCore:
    """The implementation behind a `Node`: the `Host` of its parts, and a `Subject` of the deadlock search.

    Args:
        overrides: Parameter values by name, each with the place that gives it.
        concurrency: The graph file's changes to the groups.
    """

    def __init__(
        self, instance: Instance, names: Resolver, overrides: Mapping[str, tuple[object, str]], concurrency: Regrouping
    ) -> None:
        cls = type(instance)
        self.instance = instance
        self.names = names
        self.id = 0
        self.log = node_logger(self.full_name)
        self.parameters = Parameters(overrides)
        self.groups = Groups(declared.groups(cls), cls.default_group, concurrency)
        self.starting: asyncio.Task[object] | None = None
        """The task that runs `on_start`, until it returns."""
        self.tasks: set[asyncio.Task[object]] = set()
        """Running tasks that `spawn` has started."""
        self.runners: list[Runner] = []
        self.refuses_unused = False
        """Whether a remap rule that matches nothing is an error."""
        self.failure: BaseException | None = None
        """The error that ended the node."""
        self.failure_taken = False
        """Whether a caller has waited for the node's end."""
        self.entered = AsyncExitStack()
        """Context managers to exit after `on_shutdown`."""
        self._made: dict[str, object] = {}
        """The attributes that `Node.__init__` has set on the instance."""
        self._context: Context | None = None
        self._ended: asyncio.Future[None] | None = None
        self.parts: list[Part] = []
        self.transforms: set[str] = set()
        """Attributes with transforms, of which the node may send some; "" for one in no attribute."""
        self._late: list[Part] | None = []
        """Parts to open once `on_start` has returned; None from then on."""
        self._binding = Binding(instance, self, self.parameters)
        self._failures = Failures(self, instance.error_budget, self._fail)
        self._repeats = Repeats(self)
        self._token: Closable | None = None
        self._own_services: set[str] = set()
        self._rosout: Rosout | None = None
        self._parameter_events: ParameterEvents | None = None
        self._clock = NodeClock(self, self.names.resolve, self.add)

    # identity

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
            way = "use this from on_start, a handler or a task, which run when the node does"
            raise ClosedError(f"node {self.full_name} is not running; {way}")
        return self._context

    @property
    def clock(self) -> Clock:
        return self._clock.current

    # contents

    @property
    def objects(self) -> Mapping[str, object]:
        """The runtime objects of the class's declarations, by attribute."""
        return self._binding.objects

    @property
    def handlers(self) -> frozenset[str]:
        """Names of the class's handlers, declared or found in its source."""
        return _handlers(type(self.instance))

    @property
    def hooks(self) -> frozenset[str]:
        return declared.hooks(type(self.instance))

    @property
    def endpoints(self) -> list[Endpoint]:
        """The node's endpoints on the network; an action counts as the services and topics it consists of."""
        return [endpoint for part in self.parts for endpoint in part.endpoints]

    @property
    def unopened(self) -> list[Unopened]:
        if self._late is None:
            return []
        tasks = [Unopened(f"task {n}") for n, h in declared.handlers(type(self.instance)).items() if h.kind == "task"]
        return [*(Unopened(part.handler_title, _services(part)) for part in self._late), *tasks]

    def serves(self, service: str) -> bool:
        return any(e.kind is Kind.SERVICE and e.name == service for e in self.endpoints)

    def single_sends(self, publisher: Part) -> Sequence[Place]:
        from graphflow.runtime.mistakes.source.single_sends import single_sends  # most nodes never need it

        return single_sends(self.instance, publisher)

    def statistics(self) -> dict[str, dict[str, object]]:
        """Return counters since the start, by the name of each handler, endpoint and group."""
        groups = {f"group {name}": group.statistics() for name, group in self.groups.by_name.items()}
        return groups | {part.title: part.statistics() for part in self.parts if part.title}

    # construction

    def bind(self, *, parameter_services: bool, rosout: bool, logger_service: bool) -> None:
        """Create the endpoints that the class declares and those that every node has."""
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
                get = TypeDescriptions(lambda: self.endpoints).get
                self.serve("get_type_description", COMMON_SERVICES["get_type_description"], get, SERVICES)
        if logger_service:
            levels = LoggerLevels(self.log)
            for name, answer in (("get_logger_levels", levels.get), ("set_logger_levels", levels.set)):
                self.serve(name, COMMON_SERVICES[name], answer, SERVICES)
        self._binding.bind()

    def serve(self, name: str, type_name: str, callback: Callable[[Any], object], qos: Qos) -> None:
        """Offer one of the services that every node has; they exist before `on_start` runs."""
        type_: Any = registry.interface_class(type_name)
        self._own_services.add(f"~/{name}")
        resolved = self.names.resolve(f"~/{name}", "service")
        self.add(ServiceServer(self, type_, resolved, qos, callback, name, is_inner=True))

    def add(self, part: P, *, late: bool = False) -> P:
        """Add a part, and open it if it is due: `late` parts open after `on_start`. Raises WrongThread off the loop."""
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
        self, callback: Callable[..., object] | None, otherwise: str, group: Group | HandlerGroup | None, thread: bool
    ) -> tuple[str, Any, HandlerGroup | None]:
        """Return a handler's label, the function to call, and its group, as `node_work.placed` does."""
        return placed(self, self.groups, callback, otherwise, group, thread)

    def runner(self, spec: RunnerSpec, items: deque[Any], group: HandlerGroup | None = None) -> Runner:
        made = Runner(self.context.ledger, spec, items, group)
        self.runners[:] = [r for r in self.runners if not r.closed or r.active]
        self.runners.append(made)
        return made

    def ensure_made(self) -> None:
        """Check that the node was constructed correctly.

        Raises:
            DeclarationError: Its `__init__` has overwritten an attribute that every node has.
            ParameterError: An override is for a parameter that the node does not have, or a check refuses it.
        """
        cls, own = type(self.instance).__name__, vars(self.instance)
        for attribute in (attribute for attribute, value in self._made.items() if own.get(attribute) is not value):
            raise DeclarationError(f"{cls}: every node has self.{attribute}; choose another name")
        check_made(self.instance)
        if unused := self.parameters.unused_overrides(type(self.instance)):
            raise ParameterError(f"node {self.full_name}: " + "; ".join(unused))
        self._binding.check_given()

    # life cycle

    async def start(self, context: Context) -> None:
        """Join the network: open and announce the declared endpoints, then start timers and tasks.

        Raises:
            GraphflowError: An override names no parameter, `concurrency` no handler, or something cannot be opened;
            nothing is left open.
            ClosedError: The node is already running, or has been stopped.
        """
        if self._ended is not None:
            state = "is already running" if self.is_running else "has been stopped; create a new one"
            raise ClosedError(f"node {self.full_name} {state}")
        self.ensure_made()
        unrun.ran()
        self._context = context
        self.id = context.next_id()
        self._ended = context.loop.create_future()
        context.nodes.append(self)
        if races.is_wanted():
            races.watch(self.instance, self.full_name, self.log, frozenset(self._made))
        try:
            await self._open(context)
            self.warn_unused_remaps()
            others = [(core.full_name, core.instance) for core in context.nodes if core is not self]
            warn_at_start(self.log, self.instance, others, is_regrouped=bool(self.groups.regrouping.groups))
            warn_of_variables(self, self.instance)
            await self._begin()
        except BaseException:  # cancellation included: nothing stays open
            await self.stop()
            raise

    async def _begin(self) -> None:
        """Start the class's `@task` methods."""
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
        except Exception as error:  # of the user's hook: reported, then raised
            self.refuses_unused = False
            self.warn_unused_remaps()  # an unused rule may have caused the error
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
        """Warn of remap rules that match nothing, or raise UsageFault if `refuses_unused`."""
        if (problems := self.unused_remaps()) and self.refuses_unused:
            raise UsageFault("; ".join(problems))
        for problem in problems:
            self.log.warning("%s", problem)

    def unused_remaps(self) -> list[str]:
        """Return a sentence for each remap rule that has matched nothing so far."""
        return list(unused_remaps(self.names, self._own_services, self.instance.dynamic_names, self.parameters))

    def complaints(self) -> list[str]:
        """Return the problems that the node knows of, a sentence each."""
        return [*self.unused_remaps(), *self._clock.complaints(), *(c for p in self.parts for c in p.complaints())]

    def shutdown(self) -> None:
        """End the node from within, from any thread; the code that runs it then stops it."""
        if self._context is not None and not self._context.is_here:
            call_soon(self, self.shutdown, ())
        elif self._ended is not None and not self._ended.done():
            from graphflow.runtime.mistakes.kept_in_vain import warn_of_kept  # few nodes end themselves

            warn_of_kept(self.parts, self.log, self.full_name)
            self._ended.set_result(None)

    async def wait_ended(self) -> None:
        """Wait until the node ends by `shutdown` or fails; raises the error it failed with."""
        assert self._ended is not None
        try:
            await asyncio.shield(self._ended)
        finally:
            self.failure_taken = True

    async def stop(self) -> None:
        """Leave the network: cancel handlers and tasks, wait for their cleanup, close all parts."""
        context = self._context
        if context is None:
            return
        try:
            await end_work(self.log, self.begin_to_stop(), self.tasks)
            await self._finish()
        finally:
            self.log.log_suppressed()
            # Runs even when the wait above is cancelled, so that nothing stays open.
            if self._rosout is not None:
                self._rosout.detach()
            for part in list(reversed(self.parts)):
                part.close()
            if self._token is not None:
                self._token.close()
            if self._ended is not None and not self._ended.done():
                self._ended.cancel()
            if self in context.nodes:  # two callers may stop a node at the same time
                context.nodes.remove(self)
            self._context = None

    def begin_to_stop(self) -> list[Runner | None]:
        """Keep the parts from starting more work; returns the runners to cancel."""
        return [*(part.begin_to_stop() for part in self.parts), *self._binding.runners()]

    async def _finish(self) -> None:
        if self.has_started:
            await limited(self, "on_shutdown", self.instance.on_shutdown)
        await limited(self, "exiting context managers", self.entered.aclose)

    def spawn(self, fn: Callable[[*Ts], Coroutine[object, object, object]], *args: *Ts) -> asyncio.Task[object]:
        """Run `fn(*args)` in the background until the node stops. An error in it ends the node."""
        task = self.context.loop.create_task(fn(*args), name=f"{self.full_name}.{name_of(fn, 'task')}")
        self.tasks.add(task)
        task.add_done_callback(self._task_done)
        self.context.search.arm()
        return task

    def _task_done(self, task: asyncio.Task[object]) -> None:
        self.tasks.discard(task)
        if task.cancelled() or (error := task.exception()) is None:
            return
        if self._ended is not None and not self._ended.done():
            self.report_error(f"task {task.get_name()}", error)
            self._fail(error)

    def handler_failed(self, label: str, error: BaseException, on_error: OnError | None = None) -> None:
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
            self._ended.exception()  # already logged: keeps asyncio from warning that it was never retrieved

    # parameters and time

    def _parameters_changed(self, changes: Mapping[str, ParameterChange]) -> None:
        if self._context is None:
            return
        if "use_sim_time" in changes:
            self._follow_sim_time()
        if self._parameter_events is not None:
            self._parameter_events.publish(changes)

    def _follow_sim_time(self) -> None:
        """Follow /clock or the context's clock, as the parameter `use_sim_time` selects."""
        self._clock.follow(is_simulated=bool(self.parameters.get("use_sim_time")))
        for part in self.parts:
            part.clock_changed()
            for endpoint in part.endpoints:
                if endpoint is not part:
                    endpoint.clock_changed()


def _services(part: Part) -> tuple[str, ...]:
    return tuple(endpoint.name for endpoint in part.endpoints if endpoint.kind is Kind.SERVICE)


@cache
def _handlers(cls: type[Instance]) -> frozenset[str]:
    return frozenset(handler.name for handler in cls.interface().handlers)


def core_of(node: object) -> NodeCore:
    """Return a node's core. Raises DeclarationError if `node` is not a node or not fully constructed."""
    check_node(node)
    core = vars(node).get("_core")
    if not isinstance(core, NodeCore):
        raise DeclarationError(without_super(type(node)))
    return core
