"""The supervisor: carries out the decisions of `machines.process` for all processes of a graph, and runs its steps."""

from __future__ import annotations

import asyncio
import logging
import random
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from graphflow import __version__
from graphflow.errors import GraphflowError, SupervisorError
from graphflow.graph.plan import Plan, PlannedNode, PlannedStep
from graphflow.machines.process import ALARMS, Do, Event, Exit, Need, State, step
from graphflow.machines.restarts import Again, GiveUp
from graphflow.names import did_you_mean
from graphflow.runtime.context import Context
from graphflow.supervisor.control.clients import Clients
from graphflow.supervisor.control.components import Components
from graphflow.supervisor.ends import end_of_graph, has_failed, was_stopped
from graphflow.supervisor.launching import debugging
from graphflow.supervisor.launching.programs import command_of, signal_of
from graphflow.supervisor.lifecycle_manager import LifecycleManager
from graphflow.supervisor.processes.health import Health
from graphflow.supervisor.processes.jobs import MESH_LIMIT, environment_of, no_mesh, worker_start
from graphflow.supervisor.processes.process import Process
from graphflow.supervisor.processes.starter import Starter
from graphflow.supervisor.rundir import log_file
from graphflow.supervisor.start_order import SLOW_START, needs_of_up, restarted_with, start_order, waits
from graphflow.supervisor.steps import StepRunner, keep_up, remark_on

if TYPE_CHECKING:
    from graphflow.supervisor.control.messages import Hello, NodeRow
    from graphflow.supervisor.processes import messages

logger = logging.getLogger("graphflow.supervisor")
_ENDING = (State.STOPPING, State.RESTARTING, State.RESETTING)


class Supervisor:
    """One running graph.

    Args:
        starter: Starts the processes; reports their events to `on_event`.
        logs: The folder of the nodes' logs.
        step_types: Service types by step, as far as they are known.
    """

    def __init__(self, plan: Plan, context: Context, starter: Starter, logs: Path, step_types: dict[str, str]) -> None:
        self._plan = plan
        self.exit_code = 0
        self.up = asyncio.Event()
        """Set once all that the graph needs at first is ready and done."""
        self.ended = asyncio.Event()
        self.clients = Clients(self._end_if_all_have)
        self._context = context
        self._starter = starter
        self._steps = StepRunner(context, step_types)
        self._lifecycles = LifecycleManager(context, self._steps, self.on_event)
        self._processes = {
            name: Process(name, nodes, str(log_file(logs, name))) for name, nodes in plan.processes().items()
        }
        self.components = Components(starter, list(self._processes.values()), self._member_changed)
        self._process_of = {n.name: p for p in self._processes.values() for n in p.nodes}
        self._met: set[Need] = set()
        """Needs that processes and steps have met."""
        self._step_tasks: dict[str, asyncio.Task[None]] = {}
        self._order = start_order(plan, self._processes.values())
        self._needed_for_up = needs_of_up(self._order, self._processes)
        self._planned = {n["name"]: n for n in plan.to_json()["nodes"]}
        self._stopping = False
        self._layers: list[list[str]] = []
        """Processes that are still to be stopped, in that order."""
        self._began = time.monotonic()

    def describe(self) -> list[NodeRow]:
        """Return one row per node, for `ps`."""
        return [row for process in self._processes.values() for row in process.rows()]

    @property
    def plan(self) -> Plan:
        """The plan that the graph runs."""
        return self._plan

    def hello(self) -> Hello:
        """Return the first event of a client that follows the graph."""
        return {
            "event": "hello",
            "version": __version__,
            "graph": self.plan.name,
            "file": self.plan.file,
            "console": self.plan.console,
            "layout": self.clients.layout,
        }

    def restart(self, node: str, by: str, *, only_ended: bool = False, threads: Sequence[str] = ()) -> None:
        """Start a node's process again, whether it runs or has ended.

        Args:
            only_ended: Refuse if it runs.
            threads: Handlers of the node that run in threads from then on.

        Raises:
            SupervisorError: There is no such node, it cannot be started now, or the graph is being stopped.
        """
        process = self._named(node)
        if self._stopping:
            raise SupervisorError("the graph is being stopped")
        if process.state is State.PENDING:
            waits = self._order.lacking(process.name, self._met)
            raise SupervisorError(f"{node} has not been started yet: it comes after {waits}")
        if only_ended and process.state not in (State.ENDED, State.WAITING):
            text = f"{node} runs already: it is {process.state_name}; to start it again: graphflow restart {node}"
            raise SupervisorError(text)
        if threads:
            self._planned[node] = process.put_in_threads(node, threads).to_json()
        in_threads = f" with {', '.join(threads)} in threads" if threads else ""
        self.clients.announce(f"{'start' if only_ended else 'restart'} {node}{in_threads}", by)
        process.restarts.forget()
        self._apply(process, Event.RESTART)

    def stop(self, node: str, by: str) -> None:
        """Stop a node's process; the others go on.

        Raises:
            SupervisorError: There is no such node.
        """
        process = self._named(node)
        if process.state is State.ENDED:
            raise SupervisorError(f"{node} is not running: {process.state_name}")
        self.clients.announce(f"stop {node}", by)
        process.stop_requested = True
        process.failed &= process.state is not State.WAITING  # the request, not the failure, ends its restarts
        self._apply(process, Event.STOP)

    def _named(self, node: str) -> Process:
        if node not in self._process_of:
            near = did_you_mean(node, self._process_of)
            raise SupervisorError(f"graph {self.plan.name} has no node {node}{near}")
        return self._process_of[node]

    def begin_stop(self, *, now: bool, reason: str) -> None:
        """Stop everything, last started first; `now` sends SIGKILL. A repeated call is harmless."""
        if self.ended.is_set():
            return
        if not self._stopping:
            self._stopping = True
            self.clients.broadcast({"event": "stopping", "reason": reason})
            for task in self._step_tasks.values():
                task.cancel()
            living = [p.name for p in self._processes.values() if p.state is not State.ENDED]
            self._layers = self._order.stop_layers(living)
            for process in self._processes.values():
                if process.state in (State.PENDING, State.WAITING, State.RESTARTING, State.RESETTING):
                    process.stop_requested = True  # at once, whatever its layer, or it would be started meanwhile
                    self._apply(process, Event.STOP)
        if now:
            for process in self._processes.values():
                process.stop_requested = True
                self._apply(process, Event.KILL)
        self._stop_next_layer()

    def note(self, text: str) -> None:
        """Send clients a remark about the graph's environment."""
        self.clients.broadcast({"event": "note", "text": text})

    async def run(self) -> int:
        """Bring the graph up and keep it until it has ended; returns its exit code."""
        if len(self._processes) > MESH_LIMIT:
            self.note(no_mesh(len(self._processes)))
        self._start_startable()
        self._end_if_all_have()  # a launch file may have no processes
        health = asyncio.create_task(Health(self._processes.values(), self.note).watch())
        slow = self._context.loop.call_later(SLOW_START, self._note_waits)
        await self.ended.wait()
        health.cancel()
        slow.cancel()
        for task in self._step_tasks.values():
            task.cancel()
        await asyncio.gather(*self._step_tasks.values(), return_exceptions=True)
        await self._lifecycles.close()
        await self._steps.close()
        self.clients.broadcast({"event": "end", "exit_code": self.exit_code})
        return self.exit_code

    def _note_waits(self) -> None:
        if not (self.up.is_set() or self._stopping):
            steps = [s for s in self.plan.steps if (task := self._step_tasks.get(f"step {s.name}")) and not task.done()]
            self.note(f"the graph is not up after {SLOW_START:g} s: {waits(steps, self._processes.values())}")

    def on_event(self, event: messages.ProcessEvent) -> None:
        """Take in an event of a process."""
        process = self._processes.get(event.get("process", ""))
        if process is None:
            return
        match event["event"]:
            case "spawned":
                self._has_spawned(process, event["pid"])
            case "ready":
                self._has_become_ready(process, event["node"])
            case "failed":
                process.error = event["error"]
                if process.is_program:  # a failed worker ends by itself; a program knows of no failure
                    self._act(process, Do.TERMINATE)
            case "exited":
                self._has_exited(process, event["status"])
            case "obeyed" | "joined" | "left":
                self.components.on_event(event)
            case _:
                self._observe(process, event)

    def _observe(
        self,
        process: Process,
        event: messages.Beat | messages.LifecycleChanged | messages.DebuggerAwaited | messages.LogLost,
    ) -> None:
        """Take in an event that changes no process's state."""
        match event["event"]:
            case "beat":
                process.last_beat = time.monotonic()
            case "lifecycle":
                process.lifecycle[event["node"]] = event["state"]
            case "debugging":
                self.note(debugging.invitation(process.name, event["port"]))
            case "log_lost":
                process.log_error = event["why"]
                self.note(f"{process.name}: its log is incomplete: {process.log_error}")

    def _has_spawned(self, process: Process, pid: int) -> None:
        process.pid = pid
        if process.state in _ENDING:  # it had no pid to signal until now
            self._act(process, Do.TERMINATE)
        elif process.is_program and process.nodes[0].lifecycle:
            self._lifecycles.begin(process.name, process.nodes[0])
        elif process.is_program:  # nothing shows when a foreign program is ready
            self._has_become_ready(process, process.name)

    def _has_exited(self, process: Process, status: int | None) -> None:
        process.exit = Exit() if status is None else Exit.of_status(status)
        if status is None and (trouble := self._starter.trouble()):
            self.note(trouble)
        self.components.lost(process)
        self._lifecycles.end(process.name)
        self._apply(process, Event.EXIT)

    def starter_lost(self, how: str) -> None:
        """Take in the end of the starter, with which all workers end."""
        if self.ended.is_set():
            return
        self.exit_code = 1
        self.clients.broadcast({"event": "error", "message": f"{how}, and the nodes with it"})
        self._stopping, self._layers = True, []
        for process in self._processes.values():
            process.stop_requested = True
            # Of a process that was never spawned, no end will be reported.
            if process.pid is None:
                self._apply(process, Event.EXIT if process.state is State.STARTING else Event.STOP)
        self._end_if_all_have()

    def _has_become_ready(self, process: Process, node: str) -> None:
        process.waiting_for.discard(node)
        self.clients.broadcast({"event": "ready", "node": node, "pid": process.pid})
        if not process.waiting_for:
            process.ready_since = time.monotonic()
            self._apply(process, Event.READY)
            self._meet(process.name, "ready")

    def _start_startable(self) -> None:
        if self._stopping:
            return
        for name in self._order.startable(self._met):
            if name in self._processes:
                self._apply(self._processes[name], Event.GO)
            elif name not in self._step_tasks:
                planned = next(s for s in self.plan.steps if f"step {s.name}" == name)
                self._step_tasks[name] = asyncio.create_task(self._run_step(planned), name=name)
                self._step_tasks[name].add_done_callback(lambda _: self._end_if_all_have())
        if not self.up.is_set() and self._needed_for_up <= self._met:
            self.up.set()
            left = [p for p in self._processes.values() if p.state is State.PENDING]
            pending = {n.name: self._order.lacking(p.name, self._met) for p in left for n in p.nodes}
            self.clients.broadcast({"event": "up", "seconds": time.monotonic() - self._began, "pending": pending})

    def _meet(self, name: str, *what: str) -> None:
        """Record needs that a process or step has met, and start those that waited for them."""
        self._met.update(Need(name, each) for each in what)
        self._start_startable()

    async def _run_step(self, planned: PlannedStep) -> None:
        try:
            answer = await self._steps.run(planned)
        except GraphflowError as error:
            logger.error("step %s: %s", planned.name, error)
            self._step_ended(planned, f"{planned.target}: {error}", ok=False)
            self._fail(f"step {planned.name} failed")
            return
        if planned.do == "shutdown":
            self.begin_stop(now=False, reason=planned.target)
            return
        if planned.do == "log":
            self.clients.broadcast({"event": "said", "text": planned.target})
        else:
            self._step_ended(planned, f"{planned.target} -> {answer}{remark_on(answer)}", ok=True)
        self._meet(f"step {planned.name}", "done")

    def _step_ended(self, planned: PlannedStep, text: str, *, ok: bool) -> None:
        self.clients.broadcast({"event": "step", "step": planned.name, "ok": ok, "text": text})

    def _fail(self, reason: str) -> None:
        self.exit_code = 1
        self.begin_stop(now=False, reason=reason)

    def _apply(self, process: Process, event: Event) -> None:
        was = process.state
        if event is Event.LATE and was in _ENDING:
            self.note(f"{process.name} did not end within {process.alarm_after:g} s: killed")
        process.state, actions = step(was, event)
        # The alarm first: the actions below may apply further events to this process.
        if process.state is not was:
            process.since = time.time()
            if process.alarm is not None:
                process.alarm.cancel()
                process.alarm = None
            process.alarm_after = process.may_stay(time.monotonic())
            if process.alarm_after is not None:
                process.alarm = self._context.loop.call_later(process.alarm_after, self._apply, process, Event.LATE)
        if was in _ENDING and event is Event.EXIT and process.state is not State.ENDED:
            self._send_exit(process, unexpected=False)
        for action in actions:
            self._act(process, action)
        if process.state is State.ENDED and was is not State.ENDED:
            self._process_ended(process, was)
        if process.state is State.PENDING and was is not State.PENDING:
            # It was reset after the failure of another, and may be startable at once.
            self._met.discard(Need(process.name))
            self._start_startable()

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
            self.clients.broadcast({"event": "error", "message": f"{process.error}\n  its log: {process.log}{hint}"})
            process.failed = True
            if not self.up.is_set():
                self._fail(f"{process.name} did not become ready")

    def _spawn(self, process: Process) -> None:
        process.begin()
        self.clients.broadcast({"event": "starting", "process": process.name, "again": process.starts > 1})
        nodes = process.nodes
        if process.is_program:
            job: messages.ProgramJob = {"command": command_of(nodes[0]), "signal": signal_of(nodes[0])}
            self._starter.spawn(process.name, job, process.log, environment_of(nodes))
            return
        described = [self._planned[node.name] for node in nodes]
        start = worker_start(self.plan, self._context.domain, process.name, nodes, described, process.log)
        self._starter.spawn(*start)

    def _member_changed(self, process: Process, node: PlannedNode, joined: bool) -> None:
        """Take in that a node was loaded or unloaded: a restart of the process keeps to that."""
        if joined:
            self._process_of[node.name] = process
            self._planned[node.name] = node.to_json()
            self.clients.broadcast({"event": "ready", "node": node.name, "pid": process.pid})
        else:
            del self._process_of[node.name], self._planned[node.name]
            process.lifecycle.pop(node.name, None)
            self.clients.broadcast({"event": "left", "node": node.name, "process": process.name})

    def _process_ended(self, process: Process, was: State) -> None:
        requested, failed = was_stopped(process, was), has_failed(process, was)
        if failed and was is State.STARTING and not process.error:
            process.error = f"ended before it was ready: {', '.join(sorted(process.waiting_for))}"
        follows = None if requested or self._stopping else self._decide_restart(process)
        if isinstance(follows, GiveUp):
            process.given_up = follows.why
        process.failed |= failed
        if failed and process.pid is not None:
            process.log_end()  # before clients learn of it, who may show the log
        if was not in (State.PENDING, State.WAITING):
            self._send_exit(process, unexpected=failed, again=follows)
        if isinstance(follows, Again):
            self._start_again(process, follows)
            return
        if failed:
            self.exit_code = 1
        if not requested and not self._stopping:
            end = end_of_graph(process, was, self._order, is_up=self.up.is_set())
            if end is not None:
                self.exit_code = 1 if end.failed else self.exit_code
                self.begin_stop(now=False, reason=end.reason)
        if self._stopping:
            self._stop_next_layer()
        else:
            self._meet(process.name, "exited", *(() if failed or requested else ("done",)))
        self._end_if_all_have()

    def _decide_restart(self, process: Process) -> Again | GiveUp | None:
        end = process.exit if process.exit is not None else Exit()
        chance = random.random()  # noqa: S311 - it only keeps processes from coming back together
        return process.restarts.decide(end, process.ready_for, time.monotonic(), chance)

    def _start_again(self, process: Process, follows: Again) -> None:
        process.last_end = process.error or str(process.exit)
        process.delay = follows.delay
        self._met.discard(Need(process.name))  # processes that start later wait for the new one
        self._apply(process, Event.AGAIN)
        for name in restarted_with(process.name, self.plan.strategy, self._order, self._processes):
            self._apply(self._processes[name], Event.RESET)

    def _send_exit(self, process: Process, *, unexpected: bool, again: Again | GiveUp | None = None) -> None:
        if process.exit is not None:
            delay = again.delay if isinstance(again, Again) else None
            self.clients.broadcast(process.exit_event(process.exit, unexpected=unexpected, again=delay))

    def _end_if_all_have(self) -> None:
        """End with the last process, unless a console is attached, which may restart one."""
        left = [p for p in self._processes.values() if p.state is not State.ENDED]
        if left and all(p.state is State.PENDING for p in left) and not self._stopping:
            if any(not task.done() for task in self._step_tasks.values()):
                return
            unmet = ", ".join(f"{n.name} ({n.what})" for n in sorted(self._order.after[left[0].name] - self._met))
            self._fail(f"{left[0].name} comes after {unmet}, which cannot happen any more")
            return
        running = [name for name, task in self._step_tasks.items() if not task.done()]
        if left or (not self._stopping and keep_up(self.plan.steps, running, has_processes=bool(self._processes))):
            return
        if self._stopping or not self.clients.consoles:
            self.ended.set()
        else:
            self.note("all nodes have ended; restart one, or stop the graph")

    def _stop_next_layer(self) -> None:
        while self._layers and all(self._processes[name].state is State.ENDED for name in self._layers[0]):
            self._layers.pop(0)
        if self._layers:
            for process in [self._processes[name] for name in self._layers[0]]:
                if not process.stop_requested:
                    process.stop_requested = True
                    self._apply(process, Event.STOP)
        self._end_if_all_have()
