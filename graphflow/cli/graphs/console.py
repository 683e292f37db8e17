"""`graphflow attach`, `ls` and `console`: list runs and attach the console to one."""

from __future__ import annotations

import sys
import time
from collections import Counter
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import click

from graphflow.cli import exits, output
from graphflow.cli.graphs.node_rows import graph_rows, node_rows
from graphflow.cli.graphs.streaming import take_down
from graphflow.cli.net_options import apply_reach, reach_options
from graphflow.cli.tree import verbs
from graphflow.domain import domain_id, go_to
from graphflow.errors import SupervisorError, UsageFault
from graphflow.supervisor import rundir
from graphflow.supervisor.control.choosing import choose, running_here
from graphflow.supervisor.rundir import GraphRun
from graphflow.times import ago
from graphflow.workspace.project import shown

COMMAND = (sys.executable, "-m", "graphflow")
"""The command that starts this program."""


def open_console(
    run: GraphRun | None, domain: int, prefix: str | None = None, layout: dict[str, object] | None = None
) -> Any:
    """Open the console and return how it was left, a `tui.main.Left`.

    Args:
        layout: The initial windows; None for those saved with the run, the graph file's, or the default.
    """
    # Textual is imported only here, once a console is really opened: it is most of the console's start-up time.
    tui = import_module("graphflow.tui.main")
    return tui.open_console(run, domain, command=COMMAND, verbs=verbs, prefix=prefix, layout=layout)


def show(run: GraphRun | None, domain: int, prefix: str | None = None) -> int:
    """Open the console, print how it was left, and return the exit code."""
    left = open_console(run, domain, prefix)
    if left.run is None:
        output.talk(f"[left domain {domain}: its nodes keep running]")
        return exits.OK
    return _report_end(left.run, left.how, left.exit_code)


def _report_end(run: GraphRun, how: str, exit_code: int | None) -> int:
    if exit_code is not None:
        output.talk(f"graph {run.graph} has ended; its logs are in {run.logs}")
        return exit_code
    if how == "stop":
        return take_down(run, now=False)
    if not run.is_alive:
        output.error(f"the supervisor of {run.graph} died; its log is {run.logs}/{rundir.SUPERVISOR_LOG}")
        output.talk(f"start the graph again with: graphflow up {shown(Path(run.file))}")
        return exits.FAILED
    nodes = len(node_rows(run.socket))
    which = f" --graph {run.graph}" if len(rundir.running()) > 1 else ""
    if how == "failed":
        output.error("the console failed, but the graph keeps running; please report the error above")
    output.talk(
        f"[detached from {run.graph}: {nodes} node{'s' if nodes != 1 else ''} keep{'s' if nodes == 1 else ''} running]"
        f"   graphflow attach{which}   |   graphflow down{which}"
    )
    return exits.FAILED if how == "failed" else exits.OK


@click.command()
@click.argument("graph", required=False, metavar="[GRAPH]")
@click.option("--graph", "name", metavar="NAME", help="Name of the running graph, if there are several.")
@click.option("--prefix", metavar="KEY", help="The prefix key, such as ctrl+a; else GRAPHFLOW_PREFIX, or ctrl+b.")
@reach_options
def attach(graph: str | None, name: str | None, prefix: str | None, connect: tuple[str, ...], net: str | None) -> int:
    """Open the console on a running graph, the newest if there are several. Detaching (ctrl+b d) stops nothing.

    If no graph of yours is running, it shows the nodes that others have started in the domain, such as a robot's
    with --connect, without control of their processes.
    """
    apply_reach(connect, net)
    if not output.is_terminal():
        raise UsageFault("the console needs a terminal; without one, see graphflow ps, logs -f and waits")
    try:
        run = _choose(name or graph)
    except SupervisorError as error:
        if error.exit_code != exits.NOT_RUNNING or name or graph or not _anybody(bool(connect or net)):
            raise
        return show(None, domain_id(), prefix)
    return show(run, run.domain, prefix)


def _choose(name: str | None) -> GraphRun:
    """Choose the run to attach to: the newest if none is named, as in tmux."""
    runs = rundir.running()
    runs = [run for run in runs if run.is_here] or runs
    return max(runs, key=lambda run: run.began) if name is None and runs else choose(name)


def _anybody(reaches_out: bool) -> bool:
    """Whether there may be nodes that no supervisor of ours has started."""
    from graphflow.introspect.graph_view import View

    try:
        with View(domain_id()) as view:
            return reaches_out or bool(view.cache.nodes(hidden=False))
    except SupervisorError:
        return False


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def ls(as_json: bool) -> int:
    """List running graphs with their nodes and attached consoles."""
    rows = []
    for run in running_here(everything=True):
        answer = graph_rows(run.socket)
        states = Counter(node["state"] for node in answer["nodes"])
        rows.append(
            {
                "graph": run.graph,
                "domain": run.domain,
                "nodes": dict(states),
                "began": run.began,
                "consoles": [c["name"] for c in answer["consoles"]],
                "file": run.file,
            }
        )
    if as_json:
        output.as_json(rows)
        return exits.OK
    output.lines(_table(rows))
    return exits.OK


def _table(rows: list[dict[str, Any]]) -> list[str]:
    head = ("GRAPH", "DOMAIN", "NODES", "UP", "CONSOLES", "FILE")
    cells = [head] + [
        (
            row["graph"],
            str(row["domain"]),
            ", ".join(f"{n} {'running' if state == 'ready' else state}" for state, n in row["nodes"].items()),
            ago(time.time() - row["began"]),
            ", ".join(row["consoles"]) or "none",
            shown(Path(row["file"])),
        )
        for row in rows
    ]
    return output.columns(cells)


@click.command()
@click.option("--web", is_flag=True, help="Serve it to a browser on this machine.")
@click.option("--port", type=click.IntRange(1, 65535), default=8147, show_default=True, help="Port for --web.")
@click.option("--graph", "name", metavar="NAME", help="Name of the running graph, if there are several.")
@click.option("--prefix", metavar="KEY", help="The prefix key, such as ctrl+a.")
def console(web: bool, port: int, name: str | None, prefix: str | None) -> int:
    """Open the console on a running graph, here or in a browser."""
    run = choose(name)
    if not web:
        if not output.is_terminal():
            raise UsageFault("the console needs a terminal; --web shows it in a browser")
        return show(run, run.domain, prefix)
    if find_spec("textual_serve") is None:
        from graphflow.introspect.installation import requirement

        raise UsageFault(f"--web needs the extra `web`: pip install {requirement('web')}")
    words = [*COMMAND, "attach", "--graph", run.graph, *(["--prefix", prefix] if prefix else [])]
    go_to(run.domain, run.endpoint)
    output.talk(
        f"the console of {run.graph} is at http://127.0.0.1:{port}; from another machine: "
        f"ssh -L {port}:127.0.0.1:{port} THIS_MACHINE\nCtrl-C stops serving it; the graph keeps running"
    )
    import_module("graphflow.tui.web").serve(words, port)
    return exits.OK
