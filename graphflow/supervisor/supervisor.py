"""The supervisor: carries out what `machines.process` decides, for every process of one graph, and runs its steps."""

from __future__ import annotations

import asyncio
import logging
import time
from pathlib import Path
from typing import Any

from graphflow import __version__
from graphflow.errors import GraphflowError, SupervisorError
from graphflow.graph.plan import Plan, PlannedNode, PlannedStep
from graphflow.machines.process import ALARMS, Do, Event, Exit, Order, State, step
from graphflow.names import did_you_mean
from graphflow.runtime.context import Context
from graphflow.supervisor.doors import Doors
from graphflow.supervisor.rundir import log_file
from graphflow.supervisor.starter import Starter
from graphflow.supervisor.steps import StepRunner

logger = logging.getLogger("graphflow.supervisor")


class Process:
    """One process of the graph, as the supervisor sees it."""

    def __init__(self, name: str, nodes: list[PlannedNode], log: str) -> None:
        self.name = name
        self.nodes = nodes
        self.log = log
        self.state = State.PENDING
        self.pid: int | None = None
        self.exit: Exit | None = None
        self.since = time.time()
        """When the process entered its state, in seconds since 1970."""
        self.waiting_for = {n.name for n in nodes}
        """Nodes that are not ready yet."""
        self.error = ""
        self.log_error = ""
        """Why lines of its log were lost."""
        self.restarts = 0
        self.stop_asked = False
        self.failed = False
        """Whether the process ended by itself with a failure."""
        self.alarm: asyncio.TimerHandle | None = None


class Supervisor:
    """One running graph.

    Args:
        starter: Starts the processes; what becomes of them is passed to `heard`.
        step_types: Service types by step, as far as they are known.
        logs: The folder of the nodes' logs.
    """

    def __init__(self, plan: Plan, context: Context, starter: Starter, logs: Path, step_types: dict[str, str]) -> None:
        self._plan = plan
        self.exit_code = 0
        self.up = asyncio.Event()
        """Whether everything is ready and all steps are done."""
        self.ended = asyncio.Event()
        self.doors = Doors(self._end_if_all_have)
        self._context = context
        self._starter = starter
        self._steps = StepRunner(context, step_types)
        self._processes = {
            name: Process(name, nodes, str(log_file(logs, name))) for name, nodes in plan.processes().items()
        }
        self._process_of = {n.name: p for p in self._processes.values() for n in p.nodes}
        self._done: set[str] = set()
        """Processes that are ready and steps that are finished, by name."""
        self._step_tasks: dict[str, asyncio.Task[None]] = {}
        self._order = self._make_order()
        self._planned = {n["name"]: n for n in plan.to_json()["nodes"]}
        self._mode = "peer" if len(self._processes) <= MESH_LIMIT else "client"
        self._stopping = False
        self._layers: list[list[str]] = []
        self._began = time.monotonic()

    def _make_order(self) -> Order:
        def holder(name: str) -> str:
            return self._process_of[name].name if name in self._process_of else f"step {name}"

        after: dict[str, frozenset[str]] = {}
        for process in self._processes.values():
            needs = {holder(a) for node in process.nodes for a in node.after}
            after[process.name] = frozenset(needs - {process.name})
        for planned in self.plan.steps:
            after[f"step {planned.name}"] = frozenset(holder(a) for a in planned.after)
        return Order(after)

    # what doors may ask

    def describe(self) -> list[dict[str, Any]]:
        """One row per node, for `ps`."""
        return [
            {
                "node": node.name,
                "state": self._state_word(process),
                "pid": process.pid,
                "since": process.since,
                "process": node.process,
                "class": node.class_path,
                "log": process.log,
                "restarts": process.restarts,
                "detail": process.error
                or (str(process.exit) if process.exit and process.exit.failed else "")
                or (f"its log is not written whole: {process.log_error}" if process.log_error else ""),
            }
            for process in self._processes.values()
            for node in process.nodes
        ]

    @staticmethod
    def _state_word(process: Process) -> str:
        if process.state is State.ENDED and process.failed:
            return "failed"
        return process.state.value

    @property
    def plan(self) -> Plan:
        """What is to run."""
        return self._plan

    def hello(self) -> dict[str, Any]:
        """What a door is told when it begins to follow."""
        return {
            "event": "hello",
            "version": __version__,
            "graph": self.plan.name,
            "file": self.plan.file,
            "console": self.plan.console,
            "layout": self.doors.layout,
        }

    def restart(self, node: str, by: str) -> None:
        """Start a node's process again, whether it runs or has ended.

        Raises:
            SupervisorError: There is no such node, or the graph is being stopped.
        """
        process = self._named(node)
        if self._stopping:
            raise SupervisorError("the graph is being stopped")
        self.doors.announce(f"restart {node}", by)
        self._happen(process, Event.RESTART)

    def stop(self, node: str, by: str) -> None:
        """Stop a node's process; the others go on.

        Raises:
            SupervisorError: There is no such node.
        """
        process = self._named(node)
        self.doors.announce(f"stop {node}", by)
        process.stop_asked = True
        self._happen(process, Event.STOP)

    def _named(self, node: str) -> Process:
        if node not in self._process_of:
            near = did_you_mean(node, self._process_of)
            raise SupervisorError(f"graph {self.plan.name} has no node {node}{near}")
        return self._process_of[node]

    def begin_stop(self, *, now: bool, reason: str) -> None:
        """Stop everything, last started first; `now` sends SIGKILL. Asking again is harmless."""
        if self.ended.is_set():
            return
        if not self._stopping:
            self._stopping = True
            self._tell(event="stopping", reason=reason)
            for task in self._step_tasks.values():
                task.cancel()
            living = [p.name for p in self._processes.values() if p.state is not State.ENDED]
            self._layers = self._order.stop_layers(living)
        if now:
            for process in self._processes.values():
                process.stop_asked = True
                self._happen(process, Event.KILL)
        self._stop_next_layer()

    def note(self, text: str) -> None:
        """Tell the doors that follow the graph something about its surroundings."""
        self._tell(event="note", text=text)

    # events from below

    async def run(self) -> int:
        """Bring the graph up and keep it until it has ended; returns its exit code."""
        if self._mode == "client":
            self._tell(
                event="note",
                text=f"{len(self._processes)} processes are more than a mesh carries ({MESH_LIMIT}): their messages "
                "pass through the rendezvous; nodes that share a `process:` need fewer",
            )
        self._start_ready_ones()
        await self.ended.wait()
        for task in self._step_tasks.values():
            task.cancel()
        await asyncio.gather(*self._step_tasks.values(), return_exceptions=True)
        await self._steps.close()
        self._tell(event="end", exit_code=self.exit_code)
        return self.exit_code

    def heard(self, event: dict[str, Any]) -> None:
        """Take in an event of a worker."""
        process = self._processes.get(event.get("process", ""))
        if process is None:
            return
        what = event["event"]
        if what == "spawned":
            process.pid = event["pid"]
            if process.state in (State.STOPPING, State.RESTARTING):  # asked to stop before it had a pid
                self._act(process, Do.TERMINATE)
        elif what == "ready":
            process.waiting_for.discard(event["node"])
            self._tell(event="ready", node=event["node"], pid=process.pid)
            if not process.waiting_for:
                self._happen(process, Event.READY)
                self._finished(process.name)
        elif what == "failed":
            process.error = event["error"]
        elif what == "log_lost":
            process.log_error = str(event["why"])
            self._tell(event="note", text=f"{process.name}: its log is not written whole: {process.log_error}")
        elif what == "exited":
            process.exit = Exit() if event["status"] is None else Exit.of_status(event["status"])
            if event["status"] is None and (trouble := self._starter.trouble()):
                self.note(trouble)
            self._happen(process, Event.EXIT)

    def starter_lost(self, how: str) -> None:
        """The starter has died, and all workers end with it."""
        if self.ended.is_set():
            return
        self.exit_code = 1
        self._tell(event="error", message=f"{how}, and the nodes with it")
        self._stopping, self._layers = True, []
        for process in self._processes.values():
            process.stop_asked = True
            if process.pid is None:
                self._happen(process, Event.EXIT if process.state is State.STARTING else Event.STOP)
        self._end_if_all_have()

    # decisions carried out

    def _start_ready_ones(self) -> None:
        if self._stopping:
            return
        for name in self._order.startable(self._done):
            if name in self._processes:
                self._happen(self._processes[name], Event.GO)
            elif name not in self._step_tasks:
                planned = next(s for s in self.plan.steps if f"step {s.name}" == name)
                self._step_tasks[name] = asyncio.create_task(self._run_step(planned), name=name)
        if not self.up.is_set() and len(self._done) == len(self._processes) + len(self.plan.steps):
            self.up.set()
            self._tell(event="up", seconds=time.monotonic() - self._began)

    def _finished(self, name: str) -> None:
        self._done.add(name)
        self._start_ready_ones()

    async def _run_step(self, planned: PlannedStep) -> None:
        try:
            answer = await self._steps.run(planned)
        except GraphflowError as error:
            logger.error("step %s: %s", planned.name, error)
            self._tell(event="step", step=planned.name, ok=False, text=f"{planned.call}: {error}")
            self._fail(f"step {planned.name} failed")
            return
        self._tell(event="step", step=planned.name, ok=True, text=f"{planned.call} -> {answer}")
        self._finished(f"step {planned.name}")

    def _fail(self, reason: str) -> None:
        self.exit_code = 1
        self.begin_stop(now=False, reason=reason)

    def _happen(self, process: Process, event: Event) -> None:
        was = process.state
        if event is Event.LATE and was in (State.STOPPING, State.RESTARTING):
            self._tell(event="note", text=f"{process.name} did not end within {ALARMS[was]:.0f} s: killed")
        process.state, actions = step(was, event)
        if process.state is not was:
            process.since = time.time()
            if process.alarm is not None:
                process.alarm.cancel()
                process.alarm = None
            if process.state in ALARMS:
                loop = self._context.loop
                process.alarm = loop.call_later(ALARMS[process.state], self._happen, process, Event.LATE)
        if was is State.RESTARTING and process.state is State.STARTING:
            self._tell_exit(process, unexpected=False)
        for action in actions:
            self._act(process, action)
        if process.state is State.ENDED and was is not State.ENDED:
            self._process_ended(process, was)

    def _act(self, process: Process, action: Do) -> None:
        if action is Do.SPAWN:
            self._spawn(process)
        elif action is Do.TERMINATE and process.pid is not None:
            self._starter.terminate(process.name, process.pid)
        elif action is Do.KILL and process.pid is not None:
            self._starter.kill(process.name, process.pid)
        elif action is Do.GIVE_UP:
            missing = ", ".join(sorted(process.waiting_for))
            process.error = f"not ready within {ALARMS[State.STARTING]:.0f} s: {missing}"
            hint = f"\n  {trouble}" if (trouble := self._starter.trouble()) else ""
            self._tell(event="error", message=f"{process.error}\n  its log: {process.log}{hint}")
            process.failed = True
            if not self.up.is_set():
                self._fail(f"{process.name} did not become ready")

    def _spawn(self, process: Process) -> None:
        env: dict[str, str] = {}
        for node in process.nodes:
            env.update(node.env)
        job = {
            "process": process.name,
            "nodes": [self._planned[n.name] for n in process.nodes],
            "log": process.log,
            "file": self.plan.file,
            "root": self.plan.root,
            "domain": self._context.domain,
            "mode": self._mode,
            "deadlock": self.plan.deadlock,
            "call_timeout": self.plan.call_timeout,
        }
        again = process.exit is not None
        process.restarts += again
        process.pid, process.exit, process.error, process.log_error = None, None, "", ""
        process.stop_asked = process.failed = False
        process.waiting_for = {n.name for n in process.nodes}
        self._tell(event="starting", process=process.name, again=again)
        self._starter.spawn(process.name, job, process.log, env)

    def _process_ended(self, process: Process, was: State) -> None:
        asked = process.stop_asked or was is State.STOPPING
        early = was is State.STARTING and not asked
        if early and not process.error:
            process.error = f"ended before it was ready: {', '.join(sorted(process.waiting_for))}"
        failed = early or (process.exit is not None and process.exit.failed)
        self._tell_exit(process, unexpected=failed and not asked)
        if failed and not asked:
            process.failed = True
            if process.pid is not None:
                self._write_down(process)
            self.exit_code = 1
            if was is State.STARTING and not self.up.is_set():
                self.begin_stop(now=False, reason=f"{process.name} did not start")
        if self._stopping:
            self._stop_next_layer()
        self._end_if_all_have()

    def _write_down(self, process: Process) -> None:
        """Say in a process's log how it ended, which it could not do itself."""
        why = f": {process.error}" if process.error else ""
        line = f"[supervisor] process {process.pid} has ended: {process.exit}{why}\n"
        try:
            with open(process.log, "a", encoding="utf-8") as file:
                file.write(line)
        except OSError as error:  # a full disk
            logger.error("%s: %s", process.log, error)

    def _tell_exit(self, process: Process, *, unexpected: bool) -> None:
        if process.exit is not None:
            self._tell(
                event="exited",
                process=process.name,
                nodes=[n.name for n in process.nodes],
                pid=process.pid,
                how=str(process.exit),
                unexpected=unexpected,
                error=process.error,
                log=process.log,
            )

    def _end_if_all_have(self) -> None:
        """End with the last process; while consoles look on, it may be started again."""
        if any(p.state is not State.ENDED for p in self._processes.values()):
            return
        if self._stopping or not self.doors.consoles:
            self.ended.set()
        else:
            self._tell(event="note", text="all nodes have ended; restart one, or stop the graph")

    def _stop_next_layer(self) -> None:
        while self._layers and all(self._processes_ended(name) for name in self._layers[0]):
            self._layers.pop(0)
        if self._layers:
            for name in self._layers[0]:
                process = self._processes[name]
                if not process.stop_asked:
                    process.stop_asked = True
                    self._happen(process, Event.STOP)
        self._end_if_all_have()

    def _processes_ended(self, name: str) -> bool:
        return self._processes[name].state is State.ENDED

    def _tell(self, **event: Any) -> None:
        self.doors.tell(**event)


MESH_LIMIT = 24
"""Up to this many processes each is a peer of every other; beyond, they are clients of the rendezvous."""
