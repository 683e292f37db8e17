"""`graphflow top`: CPU and memory of the running graph's processes, and message rates of their nodes."""

from __future__ import annotations

import time
from collections.abc import Mapping

import click

from graphflow.cli import output
from graphflow.domain import domain_id
from graphflow.errors import harmless
from graphflow.introspect.empty_hint import nothing_here
from graphflow.introspect.graph_view import View
from graphflow.introspect.numbers import Numbers
from graphflow.introspect.usage import Cost, Costs
from graphflow.names import is_hidden
from graphflow.system import host_name
from graphflow.wire.process import NUMBERS, answer_key

ANSWER_LIMIT = 1.0
"""Seconds that the processes of a graph have to answer."""
HEAD = ("PID", "CPU", "MEM", "THREADS", "LAG", "OUT/S", "IN/S", "DROPPED", "NODES")


@click.command()
@click.option(
    "-d", "--delay", type=click.FloatRange(0.1), default=1.0, show_default=True, help="Seconds between updates."
)
@click.option("-M", "--by-memory", is_flag=True, help="Sort by memory, not by CPU.")
@click.option("--once", is_flag=True, help="Print once and end; the default without a terminal.")
@click.option("--json", "as_json", is_flag=True, help="Print once, as JSON.")
def top(delay: float, by_memory: bool, once: bool, as_json: bool) -> None:
    """Show CPU, memory and message rates of running processes. The busiest come first; Ctrl-C ends it.

    \b
    PID      8123+2 has two child processes, which are included
    LAG      delay of the event loop, in milliseconds
    OUT, IN  messages per second that nodes publish, and that reach their subscriptions
    DROPPED  messages that slow subscriptions have dropped since their start
    """  # noqa: D301 - click wants the character
    costs, numbers = Costs(), Numbers()
    with View(domain_id()) as view:
        _measure(view, costs, numbers, by_memory=by_memory)
        while True:
            time.sleep(delay)
            view.refresh()
            found = _measure(view, costs, numbers, by_memory=by_memory)
            if as_json:
                output.as_json([{**cost._asdict(), **_flows(cost, numbers)} for cost in found])
            elif once or not output.is_terminal():
                output.lines(_table(found, numbers))
            else:
                output.screen("\n".join(harmless(line) for line in _table(found, numbers)))
                continue
            if not found and not as_json:
                output.talk(nothing_here("no nodes"))
            return


def _measure(view: View, costs: Costs, numbers: Numbers, *, by_memory: bool) -> list[Cost]:
    numbers.take(view.reports(answer_key(view.domain, NUMBERS), ANSWER_LIMIT), time.monotonic())
    pids = {token.zid: token.pid for token in view.processes().values() if token.host == host_name()}
    owners: dict[int, list[str]] = {}
    for entity in view.cache:
        pid = pids.get(entity.zid)
        if pid is not None and not is_hidden(entity.node_name) and entity.node_name not in owners.setdefault(pid, []):
            owners[pid].append(entity.node_name)
    return costs.look({pid: sorted(nodes) for pid, nodes in owners.items() if nodes}, by_memory=by_memory)


def _flows(cost: Cost, numbers: Numbers) -> Mapping[str, float | None]:
    """Sum up lag and message rates of a process's nodes; the lag is None if the process has not reported it."""
    lags = [numbers.lags[node] for node in cost.nodes if node in numbers.lags]

    def rate(kind: str) -> float:
        return sum(n for flow, n in numbers.rates.items() if flow.node in cost.nodes and flow.kind == kind)

    dropped = sum(n for flow, n in numbers.dropped.items() if flow.node in cost.nodes)
    return {
        "lag": max(lags, default=None),
        "out": round(rate("publisher"), 1),
        "in": round(rate("subscription"), 1),
        "dropped": dropped,
    }


def _table(found: list[Cost], numbers: Numbers) -> list[str]:
    rows = [HEAD]
    for cost in found:
        flows = _flows(cost, numbers)
        lag = "-" if flows["lag"] is None else f"{flows['lag'] * 1000:.1f}"
        pid = f"{cost.pid}+{cost.children}" if cost.children else str(cost.pid)
        used = (pid, f"{cost.cpu:.0f}%", f"{cost.memory / 1e6:.0f}M", str(cost.threads), lag)
        rows.append((*used, f"{flows['out']:.1f}", f"{flows['in']:.1f}", f"{flows['dropped']}", ", ".join(cost.nodes)))
    return output.columns(rows)
