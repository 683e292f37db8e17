"""`graphflow start`, `stop`, `restart`, `status` and `wait`: control single nodes of a running graph."""

from __future__ import annotations

import math
import time
from pathlib import Path

import click

from graphflow.cli import exits, output
from graphflow.cli.graphs import not_nodes
from graphflow.cli.graphs.node_rows import NodeRow, node_rows
from graphflow.domain import domain_id
from graphflow.errors import SupervisorError, UsageFault
from graphflow.introspect.graph_view import View
from graphflow.machines.process import START_LIMIT, STOP_LIMIT
from graphflow.names import did_you_mean
from graphflow.supervisor import rundir
from graphflow.supervisor.control.choosing import choose
from graphflow.supervisor.control.client import ControlClient
from graphflow.supervisor.rundir import GraphRun
from graphflow.supervisor.starts import being_started
from graphflow.system import host_name
from graphflow.times import ago

LIMIT = START_LIMIT + 2 * STOP_LIMIT
"""Seconds that a node may take to end and become ready again."""
LAST_LINES = 20
"""Lines of a node's log that `status` shows."""
POLL = 0.05
"""Seconds between two looks at a graph."""
POLL_EMPTY = 0.25
"""The same while no graph is running, which takes more work to find out."""
SAID_AFTER = 2.0
"""Seconds without a graph after which `wait` says what it waits for."""
OVER = ("failed", "given_up", "ended")
"""States that a node leaves only by command."""

_graph = click.option("--graph", "name", metavar="NAME", help="Name of the running graph, if there are several.")
_nodes = click.argument("nodes", nargs=-1, required=True, metavar="NODE...")


@click.command()
@_nodes
@_graph
def start(nodes: tuple[str, ...], name: str | None) -> int:
    """Start nodes that have ended or failed, and wait until they are ready."""
    for file in (node for node in nodes if node.endswith((".yaml", ".yml"))):
        raise UsageFault(f"{file} is a graph file; start it with: graphflow up {file}")
    return max(_ask("start", node, name) for node in nodes)


@click.command()
@_nodes
@_graph
def restart(nodes: tuple[str, ...], name: str | None) -> int:
    """Restart nodes, whether they run or have ended, and wait until they are ready."""
    return max(restart_node(node, name) for node in nodes)


@click.command()
@_nodes
@_graph
def stop(nodes: tuple[str, ...], name: str | None) -> int:
    """Stop nodes; the others keep running. `graphflow start` starts them again."""
    return max(_ask("stop", node, name) for node in nodes)


@click.command()
@click.argument("node", metavar="NODE")
@_graph
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def status(node: str, name: str | None, as_json: bool) -> int:
    """Show a node's state, how it last ended, and the end of its log.

    Exit code 0: it has not failed; 1: it has.
    """
    run = choose(name)
    [row] = _select((node,), node_rows(run.socket), "status", name)
    last = _last_lines(Path(row["log"]))
    is_bad = row["state"] in ("failed", "given_up")
    if as_json:
        output.as_json({"graph": run.graph, **row, "last_lines": last})
        return exits.FAILED if is_bad else exits.OK
    state = f"{row['state']}, {row['lifecycle']}" if row["lifecycle"] else row["state"]
    process = f", process {row['pid']}" if row["pid"] and row["state"] not in (*OVER, "waiting", "pending") else ""
    output.data(f"{row['node']}: {state} for {ago(time.time() - row['since'])}{process}")
    facts = {
        "": row["detail"],
        "class": row["class"],
        "shared process": row["process"],
        "restarted": {0: "", 1: "once"}.get(row["restarts"], f"{row['restarts']} times"),
        "last end": row["last_end"],
        "log": row["log"],
    }
    output.lines(f"  {what}: {fact}" if what else f"  {fact}" for what, fact in facts.items() if fact)
    if last:
        output.data(f"  last {len(last)} lines:" if len(last) > 1 else "  last line:")
        output.lines(f"    {line}" for line in last)
    return exits.FAILED if is_bad else exits.OK


@click.command()
@click.argument("nodes", nargs=-1, metavar="[NODE]...")
@click.option("--ready", is_flag=True, help="Wait until they are ready; the default.")
@click.option("--ended", is_flag=True, help="Wait until they have ended.")
@click.option("--timeout", type=click.FloatRange(0), default=60.0, show_default=True, help="Seconds to wait.")
@_graph
@click.option("--json", "as_json", is_flag=True, help="Print the final states of the nodes as JSON, as `ps` does.")
def wait(nodes: tuple[str, ...], ready: bool, ended: bool, timeout: float, name: str | None, as_json: bool) -> int:
    """Wait until nodes are ready: all nodes of a graph, if none is named. The graph need not have been started yet.

    Exit code 0: they are; 1: one has failed; 4: --timeout has passed.
    """
    if ready and ended:
        raise UsageFault("give either --ready or --ended")
    rows, code, why = _wait_for(nodes, name, timeout, ended=ended)
    if as_json:
        output.as_json(rows)
    if why:
        output.error(why)
    return code


def _wait_for(
    nodes: tuple[str, ...], graph: str | None, timeout: float, *, ended: bool
) -> tuple[list[NodeRow], int, str]:
    """Wait for nodes; return their rows, the exit code and, unless it is 0, the reason."""
    deadline = time.monotonic() + timeout
    silent_until = time.monotonic() + SAID_AFTER
    while True:
        rows = _rows_if_any(graph)
        if rows is None and ended:
            return [], exits.OK, ""
        if rows is None and time.monotonic() > silent_until:
            silent_until = math.inf
            output.talk(f"{_not_there()}; waiting for one for {timeout:g} s")
        wanted = _select(nodes, rows, "wait", graph) if rows is not None else []
        failed = [row for row in wanted if row["state"] in ("failed", "given_up")]
        if failed and not ended:
            text = f"{failed[0]['node']} has failed: {failed[0]['detail']}\n  its log: {failed[0]['log']}"
            return wanted, exits.FAILED, text
        good = OVER if ended else ("ready", "ended")
        if wanted and all(row["state"] in good for row in wanted):
            return wanted, exits.OK, ""
        if time.monotonic() > deadline:
            left = ", ".join(f"{row['node']} is {row['state']}" for row in wanted if row["state"] not in good)
            return wanted, exits.TIMEOUT, f"after {timeout:g} s {left or _not_there()}"
        time.sleep(POLL_EMPTY if rows is None else POLL)


def _not_there() -> str:
    return f"no graph is running yet; {starts}" if (starts := being_started()) else "no graph is running"


def _rows_if_any(graph: str | None) -> list[NodeRow] | None:
    """Return the rows of all nodes; None while no graph is running."""
    try:
        return node_rows(choose(graph).socket)
    except SupervisorError as error:
        if error.exit_code in (exits.NOT_RUNNING, exits.FAILED):  # it has not started yet, or has just ended
            return None
        raise


def _select(nodes: tuple[str, ...], rows: list[NodeRow], verb: str, graph: str | None) -> list[NodeRow]:
    if not nodes:
        return rows
    known = {row["node"]: row for row in rows}
    for word in nodes:
        if (node := _full(word)) not in known:
            other = not_nodes.answer(verb, word, choose(graph), known)
            raise SupervisorError(other or f"the graph has no node {node}{did_you_mean(node, known)}")
    return [known[_full(node)] for node in nodes]


def _full(node: str) -> str:
    return node if node.startswith("/") else f"/{node}"


def _row(socket: str, node: str) -> NodeRow:
    """Return the row of a node that the graph has. Raises SupervisorError if it has ended meanwhile."""
    found = next((row for row in node_rows(socket) if row["node"] == node), None)
    if found is None:
        raise SupervisorError(f"the graph has no node {node}")
    return found


def _last_lines(log: Path) -> list[str]:
    try:
        with log.open("rb") as file:
            file.seek(max(0, file.seek(0, 2) - 65536))
            return file.read().decode(errors="replace").splitlines()[-LAST_LINES:]
    except OSError:
        return []


def restart_node(node: str, graph: str | None, *, threads: list[str] | None = None) -> int:
    """Restart a node, wait until it is ready, and return the exit code.

    Args:
        threads: Handlers to run in threads from then on.
    """
    return _ask("restart", node, graph, **({"threads": threads} if threads else {}))


def _ask(what: str, word: str, graph: str | None, **more: object) -> int:
    node = _full(word)
    try:
        run = choose(graph)
    except SupervisorError as error:
        if error.exit_code == exits.NOT_RUNNING and (text := by_itself(node)):
            raise SupervisorError(text, exits.NOT_RUNNING) from None
        raise
    with ControlClient(run.socket) as client:
        client.send(do=what, node=node, **more)
        answer = next(client.receive(), {})
    if answer.get("event") == "error":
        raise SupervisorError(by_itself(node) or _not_a_node(what, word, run) or answer["message"])
    try:
        row = _await(run.socket, node, "ended" if what == "stop" else "ready")
    except (SupervisorError, UsageFault):
        if what != "stop" or _rows_if_any(run.graph):
            raise
        output.data(f"{node} has ended; it was the last one running, so graph {run.graph} has ended, too")
        return exits.OK
    if what == "stop":
        output.data(f"{node} has ended")
        return exits.OK
    if row["state"] != "ready":
        output.error(f"{node} did not start: {row['detail']}\n  its log: {row['log']}")
        return exits.FAILED
    output.data(f"{node} is running again, process {row['pid']}")
    return exits.OK


def _not_a_node(verb: str, word: str, run: GraphRun) -> str:
    """Describe what a word is, if it is no node of a graph; empty if it is one, or nothing known."""
    nodes = [row["node"] for row in node_rows(run.socket)]
    return "" if _full(word) in nodes else not_nodes.answer(verb, word, run, nodes)


def by_itself(node: str) -> str:
    """Describe where a node outside all graphs runs and how to end it; empty if the network shows no such node."""
    try:
        if any(row["node"] == node for run in rundir.running() if run.is_here for row in node_rows(run.socket)):
            return ""
        with View(domain_id()) as view:
            if node not in view.cache.nodes():
                return ""
            owner, process = view.owner(node), view.process_of(node)
    except SupervisorError:  # nothing is running, or it is just ending
        return ""
    end = f", or by: kill {process.pid}" if process is not None and process.host == host_name() else ""
    return f"{node} was not started by `up`; it runs in {owner}; end it there with Ctrl-C{end}"


def _await(socket: str, node: str, wanted: str) -> NodeRow:
    """Wait until a node is in the wanted state or in one that it does not leave; return its row."""
    deadline = time.monotonic() + LIMIT
    while True:
        row = _row(socket, node)
        if row["state"] in (wanted, *OVER):
            return row
        if time.monotonic() > deadline:
            raise SupervisorError(f"{node} is still {row['state']} after {LIMIT:g} s", exits.TIMEOUT)
        time.sleep(POLL)
