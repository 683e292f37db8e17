"""`graphflow waits`, `groups` and `doctor`: who holds what, who waits for whom, and what is wrong with the graph."""

from __future__ import annotations

import json
import time
from typing import Any

import click

from graphflow.cli import exits, output
from graphflow.cli.verbs import Verbs
from graphflow.domain import domain_id
from graphflow.errors import CallTimeout, RemoteError, UsageFault
from graphflow.introspect import concurrency as found
from graphflow.introspect.health import examine
from graphflow.introspect.view import View
from graphflow.machines.matching import complaints
from graphflow.names import is_hidden
from graphflow.wire.process import NUMBERS, answer_key

ANSWER_LIMIT = 1.0
"""Seconds that the processes of a graph have to answer."""
BETWEEN_LOOKS = 0.5
"""Seconds between two looks at what nodes have counted."""


def _read(view: View) -> found.ConcurrencyReport:
    return found.read(view.reports(f"@graphflow/{view.domain}/waits/*", ANSWER_LIMIT))


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def waits(as_json: bool) -> None:
    """Show which handlers hold slots, what they wait for, and where."""
    with View(domain_id()) as view:
        read = _read(view)
        unresponsive = found.unresponsive(read, view)
    rows, queued = found.rows(read), found.queued(read)
    if as_json:
        output.as_json(
            {
                "activities": rows,
                "queued": queued,
                "deadlocks": read.reports,
                "stalls": read.stalls,
                "unresponsive": unresponsive,
            }
        )
        return
    if not rows and not queued:
        output.data("nothing is waiting")
    for row in rows:
        holds = f", holds {row['holds']!r}" if row["holds"] else ""
        waiting = f" waiting for {row['waits_for']}, {row['since']:.1f} s so far" if row["waits_for"] else " running"
        left = f", times out in {row['left']:.1f} s" if row["left"] is not None else ""
        output.data(f"{'!' if row['stuck'] else ' '} {row['activity']}{holds}:{waiting}{left}")
        if row["place"]:
            output.data(f"      {row['place']}")
    for queue in queued:
        group = f"group {queue['group']!r}" if queue["group"] else "its turn"
        by = f", held by {' and '.join(queue['held_by'])}" if queue["held_by"] else ""
        dropped = f", {queue['dropped']} dropped" if queue["dropped"] else ""
        output.data(f"  {queue['handler']} is queued for {group}{by}: {queue['waiting']} waiting{dropped}")
    for report in [*read.reports, *read.stalls, *unresponsive]:
        output.data(f"\n{report}")


class _Groups(Verbs):
    """`groups NODE` alongside `groups move ...`."""

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if args and args[0] not in self.commands and not args[0].startswith("-"):
            args = ["show", *args]
        return super().resolve_command(ctx, args)


@click.group(cls=_Groups, invoke_without_command=False)
def groups() -> None:
    """Show a node's groups, or move a handler into another.

    \b
    graphflow groups NODE
    graphflow groups move NODE HANDLER... GROUP
    """  # noqa: D301 - click wants the character


@groups.command(hidden=True)
@click.argument("node")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def show(node: str, as_json: bool) -> None:
    """List a node's groups and the handlers in each."""
    with View(domain_id()) as view:
        full = view.node(node)
        read = _read(view)
    _show(full, _groups_of(read, full), as_json=as_json)


def _groups_of(read: found.ConcurrencyReport, node: str) -> list[dict[str, Any]]:
    if node not in read.nodes:
        raise UsageFault(f"{node} is not a graphflow node, so its groups are unknown")
    return read.nodes[node]


def _show(node: str, known: list[dict[str, Any]], *, as_json: bool) -> None:
    if as_json:
        output.as_json({"node": node, "groups": known})
        return
    output.data(node)
    for group in known:
        if group["name"]:
            limit = "no limit" if group["limit"] is None else f"limit {group['limit']}"
            more = "" if group["when_full"] == "wait" else f", {group['when_full']}"
            output.data(f"  {group['name']}  ({limit}{more}{', in threads' if group['thread'] else ''})")
        elif group["handlers"]:
            output.data("  in no group  (each queues behind itself only)")
        for handler in group["handlers"]:
            numbers = f"{handler['runs']} runs"
            for word in ("running", "waiting", "errors"):
                numbers += f", {handler[word]} {word}" if handler[word] else ""
            output.data(f"    {handler['handler']}  {handler['kind']}  {numbers}")


@groups.command()
@click.argument("node")
@click.argument("handlers", metavar="HANDLER...", nargs=-1, required=True)
@click.argument("group")
@click.option("--timeout", type=click.FloatRange(0, min_open=True), default=2.0, show_default=True, help="Seconds.")
def move(node: str, handlers: tuple[str, ...], group: str, timeout: float) -> None:
    """Move handlers of a running node into another group, made if missing; `none` for no group.

    Prints the lines of a graph file that make the move permanent.
    """
    with View(domain_id()) as view:
        full = view.node(node)
        zid = view.cache.owners(full)[0].zid
        for handler in handlers:
            wanted = {"node": full, "handler": handler, "group": group}
            try:
                answer = view.ask(f"@graphflow/{view.domain}/groups/{zid}", json.dumps(wanted).encode(), timeout)
            except TimeoutError:
                text = f"{full} did not answer within {timeout:g} s; its event loop may be blocked: see graphflow waits"
                raise CallTimeout(text) from None
            if answer.is_error:
                raise UsageFault(RemoteError.from_payload(answer.payload, "").message)
    told = json.loads(answer.payload)
    _show(full, told["groups"], as_json=False)
    output.data(f"\nTo keep it so, {told['where']}")
    output.lines(told["yaml"])


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def doctor(as_json: bool) -> int:
    """Check the running graph for problems: deadlocks, groups held for long, processes that do not answer, event loops
    that are blocked or were late, endpoints that do not match, nodes of one name, nodes that hear themselves, lost
    messages, floods in logs, topics that nobody publishes.

    Exit code 1 when there is one; late loops alone do not count, nor does what may be meant so.
    """
    with View(domain_id()) as view:
        counted, began = view.reports(answer_key(view.domain, NUMBERS), ANSWER_LIMIT), time.monotonic()
        read = _read(view)
        time.sleep(max(0.0, began + BETWEEN_LOOKS - time.monotonic()))
        again = view.reports(answer_key(view.domain, NUMBERS), ANSWER_LIMIT)
        health = examine(view, counted, again, time.monotonic() - began)
        misfits = list(complaints(view.cache))
        unresponsive = found.unresponsive(read, view)
        ours = view.processes()
        nodes = view.cache.nodes(hidden=False)
        others = [name for name in nodes if not any(e.zid in ours for e in view.cache.owners(name))]
    late = [
        f"{who}: the event loop was late {'once' if n == 1 else f'{n} times'}, by {most:.1f} s at most"
        for who, n, most in read.late
    ]
    blocked = [
        f"{who}: the event loop has been blocked for {seconds:.1f} s; see its log" for who, seconds in read.blocked
    ]
    faults = {
        "deadlocks": read.reports,
        "stalls": read.stalls,
        "unresponsive": unresponsive,
        "blocked": blocked,
        "misfits": misfits,
        "health": health.faults,
    }
    if as_json:
        output.as_json({**faults, "late": late, "hints": health.hints, "silent": others})
    else:
        output.lines(f"{text}\n" for text in read.reports + read.stalls)
        output.lines([*unresponsive, *blocked, *misfits, *health.faults, *late, *health.hints])
        if others:
            output.data(f"not graphflow nodes, so their handlers are unknown: {', '.join(others)}")
        if read.unreadable:
            output.data(f"processes running another version of graphflow, not understood: {read.unreadable}")
        if not any(faults.values()) and not late:
            count = sum(not is_hidden(name) for name in read.nodes)
            output.data(f"{count} node{'s' if count != 1 else ''}, nothing wrong")
    return exits.FAILED if any(faults.values()) else exits.OK
