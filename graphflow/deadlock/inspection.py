"""What a process reports of its handlers and groups, and lets others change, on keys that ROS 2 does not know.

@graphflow/<domain>/waits/<zid>      its waits, groups and deadlocks as JSON; answered while the loop is blocked, too
@graphflow/<domain>/numbers/<zid>    what its nodes have counted, how late its loop is, the time on its clock, and what
                                     its nodes know to be wrong with themselves; answered likewise
@graphflow/<domain>/look/<zid>       makes it look for a deadlock that another process found and it must report
@graphflow/<domain>/groups/<zid>     {"node", "handler", "group"}: move a handler into another group of its node;
                                     {"node", "group", "limit"}: let so many run in it at a time, null for any number
"""

from __future__ import annotations

import inspect
import json
import threading
import time
from typing import Any

from graphflow.deadlock.protocols import ProcessContext, Subject
from graphflow.deadlock.search import Search
from graphflow.errors import GraphflowError, InvalidName, RemoteError
from graphflow.executor.allowance import Allowance
from graphflow.executor.runner import Runner
from graphflow.machines.waits.wait_graph_json import to_json
from graphflow.names import did_you_mean
from graphflow.transport.base import Inbox
from graphflow.wire import attachment
from graphflow.wire.process import GROUPS, LOOK, NUMBERS, WAITS, answer_key

LAG_LIMIT = 0.2
"""Seconds to wait for the event loop to come round before it is called late."""
ANSWERS, LOOKS, MOVES = 50, 20, 200
"""How often a second other processes can have the waits or the numbers told anew, a deadlock looked for, or groups
changed."""
MOVES_AT_ONCE = 64
"""Requests that are taken in before others have a turn of the loop."""
MOVE_BOUND = 10_000
"""Bytes of a request to change groups."""
LIMIT_BOUND = 1_000_000
"""The largest limit that a group can be given."""
_KINDS = ("timer", "subscription", "service", "action")


class Inspection:
    """The answers of one process."""

    def __init__(self, process: ProcessContext, search: Search) -> None:
        self._process, self._search = process, search
        self._thread = threading.get_ident()
        now_ns = process.clock.monotonic_ns
        self._waits_allowed, self._numbers_allowed = Allowance(ANSWERS, now_ns), Allowance(ANSWERS, now_ns)
        self._looks_allowed, self._moves_allowed = Allowance(LOOKS, now_ns), Allowance(MOVES, now_ns)
        self._last_waits = self._last_numbers = b"{}"
        """What is answered to those who ask too often."""
        session, domain = process.session, process.domain
        self._reports = (
            session.open_report(answer_key(domain, WAITS, session.zid), self._waits),
            session.open_report(answer_key(domain, LOOK, session.zid), self._look),
            session.open_report(answer_key(domain, NUMBERS, session.zid), self._numbers),
        )
        self._inbox = Inbox(session.bell, MOVE_BOUND, self._asked)
        self._server = session.open_server(answer_key(domain, GROUPS, session.zid), self._inbox, is_paced=True)

    def _waits(self) -> bytes:
        """Runs on any thread."""
        if not self._waits_allowed.take():
            return self._last_waits
        search, watchdog = self._search, self._search.watchdog
        nodes = {node.full_name: groups_of(node) for node in list(self._process.nodes)}
        others = list(self._process.elsewhere)
        for other in others:
            nodes |= other.groups()
        reports = dict(search.reports)
        told = {
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
        self._last_waits = json.dumps(told).encode()
        return self._last_waits

    def _numbers(self) -> bytes:
        """Runs on any thread."""
        if not self._numbers_allowed.take():
            return self._last_numbers
        lag = self._lag()
        nodes = {node.full_name: node.statistics() for node in list(self._process.nodes)}
        complaints = {node.full_name: list(node.complaints()) for node in list(self._process.nodes)}
        told = {
            "process": self._process.session.zid,
            "lag": lag,
            "time_ns": time.time_ns(),
            "nodes": nodes,
            "complaints": {name: texts for name, texts in complaints.items() if texts},
        }
        self._last_numbers = json.dumps(told, default=str).encode()
        return self._last_numbers

    def _lag(self) -> float:
        """Seconds that the event loop takes to come round; where it has not, those since it should have."""
        loop = self._process.loop
        if not loop.is_running():
            return 0.0
        came = threading.Event()
        asked = time.monotonic()
        loop.call_soon_threadsafe(came.set)
        if threading.get_ident() != self._thread:
            came.wait(LAG_LIMIT)
        return max(time.monotonic() - asked, self._search.watchdog.blocked_for)

    def _look(self) -> bytes:
        """Runs on any thread."""
        if self._looks_allowed.take():
            self._search.look_now()
        return b""

    def _asked(self) -> None:
        for _ in range(min(MOVES_AT_ONCE, len(self._inbox.items))):
            request = self._inbox.items.popleft()
            if not self._moves_allowed.take():
                continue  # it ends without an answer
            try:
                if len(request.payload) > MOVE_BOUND:
                    raise InvalidName(f"a request of {len(request.payload)} bytes names no handler")
                wanted = json.loads(request.payload)
                answer = self._regroup(wanted)
            except (ValueError, KeyError, TypeError, RecursionError, GraphflowError) as error:
                request.reply_error(RemoteError(type(error).__name__, str(error)).to_payload())
            else:
                request.reply(json.dumps(answer).encode(), attachment.pack(0, 0, bytes(16)))
        if self._inbox.items:  # whoever asks all the time must not hold the loop
            self._process.loop.call_soon(self._asked)

    def _regroup(self, wanted: Any) -> dict[str, Any]:
        """Move a handler, or change the limit of a group; returns the groups and how to keep them."""
        name, group = str(wanted["node"]), str(wanted["group"])
        node = self._named(name)
        if "limit" in wanted:
            self._limit(node, group, wanted["limit"])
        else:
            self._move(node, str(wanted["handler"]), group)
        regrouping = node.groups.regrouping
        return {"groups": groups_of(node), "where": regrouping.where, "yaml": regrouping.lines(name, "  ")}

    def _named(self, name: str) -> Subject:
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


def groups_of(node: Subject) -> list[dict[str, Any]]:
    """A node's groups with their handlers, those in no group last, as plain data."""
    runners = _handlers(node)
    found = []
    for name, group in list(node.groups.by_name.items()):
        about = {"name": name, "limit": group.limit, "when_full": group.when_full, "thread": group.is_threaded}
        found.append({**about, "handlers": [_handler(node, r) for r in runners if r.group is group]})
    rest = [_handler(node, r) for r in runners if r.group not in node.groups.by_name.values()]
    return [*found, {"name": "", "limit": 1, "when_full": "wait", "thread": False, "handlers": rest}]


def _handlers(node: Subject) -> list[Runner]:
    """What runs the handlers that the node's class has declared or made."""
    return [r for r in list(node.runners) if r.spec.kind in _KINDS and not r.spec.is_inner and not r.closed]


def _handler(node: Subject, runner: Runner) -> dict[str, Any]:
    is_async = inspect.iscoroutinefunction(getattr(type(node.instance), runner.spec.handler, None))
    numbers = {"running": len(runner.active), "waiting": len(runner.items), "runs": runner.runs}
    about = {"handler": runner.spec.handler, "kind": runner.spec.kind, "async": is_async}
    return {**about, **numbers, "errors": runner.errors}
