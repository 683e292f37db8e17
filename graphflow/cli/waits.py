"""`graphflow waits` and `groups`: who holds what, and who waits for whom."""

from __future__ import annotations

import json
from typing import Any

import click

from graphflow.cli import output
from graphflow.cli.verbs import Verbs
from graphflow.domain import domain_id
from graphflow.errors import CallTimeout, RemoteError, UsageFault
from graphflow.introspect import concurrency as found
from graphflow.introspect.view import View

ANSWER_LIMIT = 1.0
"""Seconds that the processes of a graph have to answer."""


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
        raise UsageFault(f"{node} is not a graphflow node, or on another machine, so its groups are unknown")
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
            counts = [] if handler["runs"] is None else [f"{handler['runs']} runs"]  # rclpy's are not counted
            counts += [f"{handler[word]} {word}" for word in ("running", "waiting", "errors") if handler[word]]
            output.data(f"    {handler['handler']}  {handler['kind']}  {', '.join(counts)}".rstrip())


@groups.command()
@click.argument("node")
@click.argument("handlers", metavar="HANDLER...", nargs=-1, required=True)
@click.argument("group")
@click.option("--timeout", type=click.FloatRange(0, min_open=True), default=2.0, show_default=True, help="Seconds.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def move(node: str, handlers: tuple[str, ...], group: str, timeout: float, as_json: bool) -> None:
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
    if as_json:
        output.as_json({"node": full, **told})
        return
    _show(full, told["groups"], as_json=False)
    output.data(f"\nTo keep it so, {told['where']}")
    output.lines(told["yaml"])
