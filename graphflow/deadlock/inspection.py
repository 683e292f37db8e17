"""The introspection interface of a process: four Zenoh keys outside ROS 2's names.

@graphflow/<domain>/waits/<zid>      its waits, groups and deadlocks as JSON; answered while the loop is blocked, too
@graphflow/<domain>/numbers/<zid>    the statistics and complaints of its nodes, the lag of its loop and the time of its
                                     clock; answered while the loop is blocked, too
@graphflow/<domain>/look/<zid>       search for a deadlock that another process found and that this one must report
@graphflow/<domain>/groups/<zid>     {"node", "handler", "group"}: move a handler to another group of its node;
                                     {"node", "group", "limit"}: set the limit of a group, null for none

Anyone on the network can send requests, so their rate and their size are bounded.
"""

from __future__ import annotations

import inspect
import json
import threading
import time
from collections.abc import Mapping, Sequence
from typing import TypedDict

from graphflow.deadlock.protocols import ProcessContext, Subject
from graphflow.deadlock.search import Search
from graphflow.errors import GraphflowError, InvalidName, RemoteError
from graphflow.executor.allowance import Allowance
from graphflow.executor.runner import Runner
from graphflow.machines.waits.wait_graph_json import to_json
from graphflow.names import did_you_mean
from graphflow.transport.inbox import Inbox
from graphflow.wire import attachment
from graphflow.wire.process import GROUPS, LOOK, NUMBERS, WAITS, answer_key

LAG_LIMIT = 0.2
"""Seconds to wait for the event loop to run a callback, at most."""
ANSWERS, LOOKS, MOVES = 50, 20, 200
"""Requests per second that are served: for fresh waits or numbers, for a search, for changes of groups."""
MOVES_AT_ONCE = 64
"""Requests that are handled before other callbacks of the loop run."""
MOVE_BOUND = 10_000
"""Bytes of a request to change groups, at most."""
LIMIT_BOUND = 1_000_000
"""Largest limit of a group that can be requested."""
_KINDS = ("timer", "subscription", "service", "action")

HandlerRow = TypedDict(
    "HandlerRow",
    {"handler": str, "kind": str, "async": bool, "running": int, "waiting": int, "runs": int, "errors": int},
)
"""A handler as plain data."""


class GroupRow(TypedDict):
    """A group as plain data; the last one of a node has no name, and the handlers that are in no group."""

    name: str
    limit: int | None
    when_full: str
    thread: bool
    handlers: list[HandlerRow]


class Inspection:
    """The server of one process's introspection interface."""

    def __init__(self, process: ProcessContext, search: Search) -> None:
        self._process, self._search = process, search
        self._thread = threading.get_ident()
        now_ns = process.clock.monotonic_ns
        self._waits_allowed, self._numbers_allowed = Allowance(ANSWERS, now_ns), Allowance(ANSWERS, now_ns)
        self._looks_allowed, self._moves_allowed = Allowance(LOOKS, now_ns), Allowance(MOVES, now_ns)
        self._last_waits = self._last_numbers = b"{}"
        """Answers that are repeated to requests above the rate."""
        session, domain = process.session, process.domain
        self._reports = (
            session.open_report(answer_key(domain, WAITS, session.zid), self._waits),
            session.open_report(answer_key(domain, LOOK, session.zid), self._look),
            session.open_report(answer_key(domain, NUMBERS, session.zid), self._numbers),
        )
        self._inbox = Inbox(session.bell, MOVE_BOUND, self._asked)
        self._server = session.open_server(answer_key(domain, GROUPS, session.zid), self._inbox, is_paced=True)

    def _waits(self) -> bytes:
        """Answer a request for the waits. Runs on any thread."""
        if not self._waits_allowed.take():
            return self._last_waits
        search, watchdog = self._search, self._search.watchdog
        nodes: dict[str, Sequence[Mapping[str, object]]] = {
            n.full_name: groups_of(n) for n in list(self._process.nodes)
        }
        others = list(self._process.elsewhere)
        for other in others:
            nodes |= other.groups()
        reports = dict(search.reports)
        data = {
            **to_json(search.snapshot.take_for_others()),
            "reports": [report.text for report in reports.values()],
            "rings": [list(ring) for ring in reports],
            "process": self._process.session.zid,
            "stalls": [*search.stalls.texts, *(text for other in others for text in other.stalls())],
            "nodes": nodes,
            "blocked_for": watchdog.blocked_for if watchdog.is_blocked else 0.0,
            "late": watchdog.late,
            "longest": watchdog.longest,
        }
        self._last_waits = json.dumps(data).encode()
        return self._last_waits

    def _numbers(self) -> bytes:
        """Answer a request for the numbers. Runs on any thread."""
        if not self._numbers_allowed.take():
            return self._last_numbers
        lag = self._lag()
        nodes = {node.full_name: node.statistics() for node in list(self._process.nodes)}
        complaints = {node.full_name: list(node.complaints()) for node in list(self._process.nodes)}
        data = {
            "process": self._process.session.zid,
            "lag": lag,
            "time_ns": time.time_ns(),
            "nodes": nodes,
            "complaints": {name: texts for name, texts in complaints.items() if texts},
        }
        self._last_numbers = json.dumps(data, default=str).encode()
        return self._last_numbers

    def _lag(self) -> float:
        """Return the seconds that the event loop takes to run a callback, or has taken so far without running it."""
        loop = self._process.loop
        if not loop.is_running():
            return 0.0
        answered = threading.Event()
        sent = time.monotonic()
        loop.call_soon_threadsafe(answered.set)
        # On the loop's own thread, waiting would only keep the loop from answering.
        if threading.get_ident() != self._thread:
            answered.wait(LAG_LIMIT)
        return max(time.monotonic() - sent, self._search.watchdog.blocked_for)

    def _look(self) -> bytes:
        """Search as another process asks. Runs on any thread."""
        if self._looks_allowed.take():
            self._search.look_now()
        return b""

    def _asked(self) -> None:
        for _ in range(min(MOVES_AT_ONCE, len(self._inbox.items))):
            request = self._inbox.items.popleft()
            if not self._moves_allowed.take():
                continue  # dropped without an answer, which the sender sees as a timeout
            try:
                if len(request.payload) > MOVE_BOUND:
                    raise InvalidName(f"a request of {len(request.payload)} bytes names no handler")
                wanted = json.loads(request.payload)
                answer = self._regroup(wanted)
            except (ValueError, KeyError, TypeError, RecursionError, GraphflowError) as error:
                request.reply_error(RemoteError(type(error).__name__, str(error)).to_payload())
            else:
                request.reply(json.dumps(answer).encode(), attachment.pack(0, 0, bytes(16)))
        if self._inbox.items:  # a flood of requests must not occupy the loop
            self._process.loop.call_soon(self._asked)

    def _regroup(self, wanted: Mapping[str, object]) -> dict[str, object]:
        """Move a handler, or change the limit of a group; return the groups, and the YAML that keeps the change."""
        name, group = str(wanted["node"]), str(wanted["group"])
        node = self._node(name)
        if "limit" in wanted:
            self._limit(node, group, wanted["limit"])
        else:
            self._move(node, str(wanted["handler"]), group)
        regrouping = node.groups.regrouping
        return {"groups": groups_of(node), "where": regrouping.where, "yaml": regrouping.lines(name, "  ")}

    def _node(self, name: str) -> Subject:
        node = next((n for n in self._process.nodes if n.full_name == name), None)
        if node is None:
            raise InvalidName(f"there is no node {name} in this process")
        if any(name in other.groups() for other in self._process.elsewhere):
            raise InvalidName(
                f"{name} is written for rclpy: its groups are those that its code gives, callback_group=..."
            )
        return node

    def _move(self, node: Subject, handler: str, group: str) -> None:
        mine = [r for r in _handlers(node) if r.spec.handler == handler]
        if not mine:
            known = sorted({r.spec.handler for r in _handlers(node)})
            near = did_you_mean(handler, known)
            raise InvalidName(f"{node.full_name} has no handler {handler!r}{near or '; it has ' + ', '.join(known)}")
        target = node.groups.named(group)
        for runner in mine:
            runner.move(target)
        node.groups.note_move(handler, group)

    def _limit(self, node: Subject, name: str, limit: object) -> None:
        if limit is not None and (type(limit) is not int or not 1 <= limit <= LIMIT_BOUND):
            raise InvalidName(f"the limit {str(limit)[:40]!r} is not a number from 1 to {LIMIT_BOUND:,}, and not none")
        known = node.groups.by_name
        if name not in known:
            near = did_you_mean(name, known)
            make = f"graphflow groups move {node.full_name} HANDLER GROUP makes one"
            there = f"; it has {', '.join(sorted(known))}" if known else f"; it has none, and {make}"
            raise InvalidName(f"{node.full_name} has no group {name!r}{near or there}")
        known[name].set_limit(limit, self._process.loop)
        node.groups.note_limit(name, limit)

    def close(self) -> None:
        """Stop answering."""
        for report in self._reports:
            report.close()
        self._server.close()


def groups_of(node: Subject) -> list[GroupRow]:
    """Return a node's groups with their handlers as plain data, last the handlers in no group."""
    runners = _handlers(node)
    groups = list(node.groups.by_name.items())
    found: list[GroupRow] = [
        {
            "name": name,
            "limit": group.limit,
            "when_full": group.when_full,
            "thread": group.is_threaded,
            "handlers": [_handler(node, r) for r in runners if r.group is group],
        }
        for name, group in groups
    ]
    rest = [_handler(node, r) for r in runners if r.group not in node.groups.by_name.values()]
    return [*found, {"name": "", "limit": 1, "when_full": "wait", "thread": False, "handlers": rest}]


def _handlers(node: Subject) -> list[Runner]:
    """Return the runners of the handlers that users wrote."""
    return [r for r in list(node.runners) if r.spec.kind in _KINDS and not r.spec.is_inner and not r.closed]


def _handler(node: Subject, runner: Runner) -> HandlerRow:
    return {
        "handler": runner.spec.handler,
        "kind": runner.spec.kind,
        "async": inspect.iscoroutinefunction(getattr(type(node.instance), runner.spec.handler, None)),
        "running": len(runner.active),
        "waiting": len(runner.items),
        "runs": runner.runs,
        "errors": runner.errors,
    }
