"""`graphflow waits` and `groups`: show which handlers hold slots and wait, and change groups."""

from __future__ import annotations

from typing import Literal

import click

from graphflow.cli import output
from graphflow.cli.verbs import Verb, Verbs
from graphflow.domain import domain_id
from graphflow.errors import RemoteError, UsageFault
from graphflow.introspect import concurrency as found
from graphflow.introspect.graph_view import View
from graphflow.names import did_you_mean

ANSWER_LIMIT = 1.0
"""Seconds that the processes of a graph have to answer."""
_COUNTS: tuple[Literal["running", "waiting", "errors"], ...] = ("running", "waiting", "errors")
"""Counters of a handler that are shown unless they are 0."""


def _read(view: View) -> found.ConcurrencyReport:
    return found.read(view.reports(f"@graphflow/{view.domain}/waits/*", ANSWER_LIMIT))


@click.command(cls=Verb)
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
    """`groups NODE` alongside the verbs, such as `groups move`."""

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        # A node is the only argument: a word with others after it is a verb, perhaps misspelt.
        is_node = args and args[0] not in self.commands and not args[0].startswith("-")
        if is_node and ("/" in args[0] or all(word.startswith("-") for word in args[1:])):
            args = ["show", *args]
        return super().resolve_command(ctx, args)


@click.group(cls=_Groups, invoke_without_command=False)
def groups() -> None:
    """Show a node's groups, or change them while it runs.

    \b
    graphflow groups NODE
    graphflow groups move NODE HANDLER... GROUP
    graphflow groups limit NODE GROUP LIMIT
    graphflow groups thread NODE HANDLER...
    """  # noqa: D301 - click wants the character


@groups.command(hidden=True)
@click.argument("node")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def show(node: str, as_json: bool) -> None:
    """List a node's groups and the handlers in each."""
    with View(domain_id()) as view:
        full = view.node(node)
        rows = _groups_of(view, full)
    _show(full, rows, as_json=as_json)


def _groups_of(view: View, node: str) -> list[found.GroupRow]:
    read = _read(view)
    if node not in read.nodes:
        raise UsageFault(f"the groups of {node} are unknown: it runs in {view.owner(node)}")
    return read.nodes[node]


def _show(node: str, known: list[found.GroupRow], *, as_json: bool) -> None:
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
            output.data("  in no group  (each waits only for its own runs)")
        for handler in group["handlers"]:
            counts = [] if handler["runs"] is None else [f"{handler['runs']} runs"]  # not counted in rclpy
            counts += [f"{handler[word]} {word}" for word in _COUNTS if handler[word]]
            output.data(f"    {handler['handler']}  {handler['kind']}  {', '.join(counts)}".rstrip())


_timeout = click.option(
    "--timeout", type=click.FloatRange(0, min_open=True), default=2.0, show_default=True, help="Seconds to wait."
)
_as_json = click.option("--json", "as_json", is_flag=True, help="Print JSON.")


@groups.command()
@click.argument("node")
@click.argument("handlers", metavar="HANDLER...", nargs=-1, required=True)
@click.argument("group")
@_timeout
@_as_json
def move(node: str, handlers: tuple[str, ...], group: str, timeout: float, as_json: bool) -> None:
    """Move handlers of a running node into another group. It is created if missing; `none` is no group.

    Print the lines of a graph file that make the move permanent.
    """
    _change(node, [{"handler": handler, "group": group} for handler in handlers], timeout, as_json=as_json)


@groups.command()
@click.argument("node")
@click.argument("group")
@click.argument("number", metavar="LIMIT")
@_timeout
@_as_json
def limit(node: str, group: str, number: str, timeout: float, as_json: bool) -> None:
    """Set how many handlers of a group may run at a time. `none` removes the limit.

    Print the lines of a graph file that make the change permanent.
    """
    if number != "none" and not (number.isascii() and number.isdecimal() and int(number[:9]) > 0):
        raise UsageFault(f"{number!r} is not a limit; write a number of at least 1, or none")
    wanted: dict[str, object] = {"group": group, "limit": None if number == "none" else int(number[:9])}
    _change(node, [wanted], timeout, as_json=as_json)


@groups.command()
@click.argument("node")
@click.argument("handlers", metavar="HANDLER...", nargs=-1, required=True)
@click.option("--graph", "name", metavar="NAME", help="Name of the running graph, if there are several.")
def thread(node: str, handlers: tuple[str, ...], name: str | None) -> int:
    """Restart a node with some handlers in threads. They may block there without blocking the event loop.

    Only `def` handlers can run in threads. The change lasts until the graph stops.
    """
    from graphflow.cli.graphs.nodes import restart_node

    with View(domain_id()) as view:
        full = view.node(node)
        known = {h["handler"]: h for group in _groups_of(view, full) for h in group["handlers"]}
    for handler in handlers:
        if handler not in known:
            near = did_you_mean(handler, known)
            raise UsageFault(f"{full} has no handler {handler!r}{near or '; it has ' + ', '.join(sorted(known))}")
        if known[handler].get("async"):
            raise UsageFault(
                f"{handler} of {full} is async, and only def handlers run in threads: await what it waits for"
            )
    return restart_node(full, name, threads=list(handlers))


def _change(node: str, requests: list[dict[str, object]], timeout: float, *, as_json: bool) -> None:
    with View(domain_id()) as view:
        full = view.node(node)
        try:
            answer = found.change_groups(view, full, [{"node": full, **request} for request in requests], timeout)
        except RemoteError as error:
            raise UsageFault(error.message) from None
    if as_json:
        output.as_json({"node": full, **answer})
        return
    _show(full, answer["groups"], as_json=False)
    output.data(f"\nTo make this permanent, {answer['where']}")
    output.lines(answer["yaml"])
