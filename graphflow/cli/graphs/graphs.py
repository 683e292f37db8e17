"""`graphflow up`, `down`, `ps` and `logs`: start, stop and list graphs, and show their logs."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path
from textwrap import shorten
from typing import TYPE_CHECKING, Any

import click

from graphflow.cli import exits, output
from graphflow.cli.arguments import GraphCommand
from graphflow.cli.graphs.files import find_graph
from graphflow.cli.net_options import apply_reach, reach_options
from graphflow.cli.verbs import Verb
from graphflow.domain import ENDPOINT_VARIABLE, domain_id, go_to
from graphflow.errors import SupervisorError, UsageFault
from graphflow.times import ago
from graphflow.wire.profile import PROFILES, VARIABLE

if TYPE_CHECKING:
    from graphflow.cli.graphs.node_rows import NodeRow
    from graphflow.supervisor.rundir import GraphRun
    from graphflow.supervisor.starts import Start

_graph = click.option("--graph", "name", metavar="NAME", help="Name of the running graph, if there are several.")
_everywhere = click.option("--all", "everything", is_flag=True, help="Include the graphs of all domains.")

LEVELS = ("debug", "info", "warn", "error", "fatal")
DETAIL = 60
"""Most characters of a node's error that `ps` shows; its log has the rest."""
PS_LIMIT = 1.0
"""Seconds that a supervisor has to report the states of its nodes."""


@click.command(cls=GraphCommand)
@click.argument("graph", metavar="GRAPH.yaml|NAME")
@click.argument("args", nargs=-1, metavar="[NAME:=VALUE]...")
@click.option("-d", "--detach", is_flag=True, help="Leave it running in the background.")
@click.option("--no-console", is_flag=True, help="Show logs instead of the console; Ctrl-C then stops the graph.")
@click.option("-s", "--show-args", is_flag=True, help="Show the file's arguments without starting it.")
@click.option("--private", is_flag=True, help="Use a port and a domain of its own.")
@click.option("--races", is_flag=True, help="Report updates of node attributes that are lost between handlers.")
@click.option("--only", multiple=True, metavar="NODE", help="Start this node and those it waits for; may be repeated.")
@click.option("--replace", is_flag=True, help="Stop the graph first, if it is running.")
@click.option("--watch", is_flag=True, help="Restart nodes when their source changes.")
@click.option(
    "--debug", multiple=True, metavar="NODE", help="Start this node's process under debugpy; may be repeated."
)
@click.option("--domain", type=click.IntRange(0), help="Domain id; overrides the file's.")
@click.option("--wire", type=click.Choice(PROFILES), help="ROS 2 distribution whose message definitions to use.")
@click.option("--json", "as_json", is_flag=True, help="Print events as lines of JSON, without the console.")
@reach_options
def up(
    graph: str,
    args: tuple[str, ...],
    detach: bool,
    no_console: bool,
    show_args: bool,
    private: bool,
    races: bool,
    only: tuple[str, ...],
    replace: bool,
    watch: bool,
    debug: tuple[str, ...],
    domain: int | None,
    wire: str | None,
    as_json: bool,
    connect: tuple[str, ...],
    net: str | None,
) -> int:
    """Start a graph from its file and open the console on it.

    Without a terminal, or with --no-console, its logs are shown and Ctrl-C stops it.
    """
    if wire is not None:
        os.environ[VARIABLE] = wire
    if races:
        os.environ["GRAPHFLOW_RACES"] = "1"
    apply_reach(connect, net)
    path = find_graph(graph)
    if show_args:
        return _show_args(path)
    if private:
        domain = _go_private(domain)
    if domain is None and os.environ.get("GRAPHFLOW_DOMAIN"):
        domain = domain_id()
    if replace:
        _take_down_running(path)
    # Nothing heavy may be imported before the fork: the children inherit this process's memory.
    from graphflow.supervisor.launching.launch import launch

    uses_console = not (detach or no_console or as_json) and output.is_terminal()
    report, launched = launch(path, list(args), domain, only, debug, watch=watch)
    if not report["ok"]:
        output.error(report["message"]) if report["exit_code"] != exits.USAGE else output.talk(report["message"])
        return int(report["exit_code"])
    from graphflow.supervisor.rundir import GraphRun

    run = GraphRun(**report["run"])
    if uses_console:
        launched.let_go()
        return _open_console(run, launched.wait)
    from graphflow.cli.graphs.streaming import stream

    code = stream(run, report["classes"], detach=detach, end=launched.wait, as_json=as_json)
    if detach:
        launched.let_go()
    return code


def _take_down_running(path: Path) -> None:
    """Stop the running graph of a file, in this domain."""
    from graphflow.cli.graphs.streaming import take_down
    from graphflow.supervisor import rundir
    from graphflow.supervisor.starts import wait_started

    wait_started(_report_start, path)
    for run in rundir.running():
        if run.is_here and run.file == str(path.resolve()):
            take_down(run, now=False)


def _open_console(run: GraphRun, end: Callable[[], str]) -> int:
    from graphflow.cli.graphs.console import show
    from graphflow.cli.graphs.streaming import GONE_LIMIT, report_loss

    try:
        return show(run, run.domain)
    except SupervisorError:
        if not run.wait_gone(GONE_LIMIT):
            raise
        return report_loss(run, end)


def _go_private(domain: int | None) -> int:
    from random import SystemRandom

    from graphflow.transport.rendezvous import free_endpoint

    endpoint = free_endpoint()
    chosen = domain if domain is not None else SystemRandom().randrange(1000, 1_000_000)
    go_to(chosen, endpoint)
    output.talk(
        f"private: in other terminals first type\n  export {ENDPOINT_VARIABLE}={endpoint} GRAPHFLOW_DOMAIN={chosen}"
    )
    return chosen


def _show_args(path: Path) -> int:
    from graphflow.graph.checks.validation import Problems
    from graphflow.launchfiles.conversion import FROM_LAUNCH
    from graphflow.launchfiles.reading import read
    from graphflow.supervisor.launching.launch_python import described
    from graphflow.workspace.project import shown

    problems = Problems()
    top = read(path, shown(path), problems.add, describe=described)
    problems.raise_any()
    args = top.entries.get("args") if isinstance(top.value, dict) else None
    declared: Any = None if args is None or not isinstance(args.value, dict) else args.plain()
    texts = {n: t.value for n, t in top.entries[FROM_LAUNCH].entries.items()} if FROM_LAUNCH in top.entries else {}
    output.data("Arguments (pass arguments as '<name>:=<value>'):\n")
    for name, spec in (declared or {}).items():
        spec = spec if isinstance(spec, dict) else {}
        unit = f" [{spec['unit']}]" if spec.get("unit") else ""
        choices = f" One of: {spec['choices']}" if spec.get("choices") else ""
        output.data(f"    '{name}':\n        {spec.get('doc') or 'no description given'}{unit}{choices}")
        output.data(f"        (default: {texts.get(name, spec['default'])!r})\n" if "default" in spec else "")
    if not declared:
        output.data("    no arguments")
    return exits.OK


@click.command()
@click.argument("graph", required=False, metavar="[GRAPH]")
@_graph
@_everywhere
@click.option("--now", is_flag=True, help="Kill at once, without time for cleanup.")
@click.option("--json", "as_json", is_flag=True, help="Print a line of JSON for each graph.")
def down(graph: str | None, name: str | None, everything: bool, now: bool, as_json: bool) -> int:
    """Stop a running graph and wait until all its processes have ended.

    Without a name or --all, stop the graph of this domain.
    """
    if graph is not None and graph.endswith((".yaml", ".yml")):
        graph = Path(graph).stem
    runs = _to_stop(graph or name, everything=everything)
    from graphflow.cli.graphs.streaming import take_down

    return max(take_down(run, now=now, as_json=as_json) for run in runs)


def _to_stop(name: str | None, *, everything: bool) -> list[GraphRun]:
    """Choose the graphs to stop; wait for graphs that are being started, which may be among them."""
    from graphflow.supervisor.control.choosing import choose, running_here
    from graphflow.supervisor.starts import wait_started

    has_waited = everything and wait_started(_report_start)
    while True:
        try:
            return running_here(everything=True) if everything else [choose(name)]
        except SupervisorError as error:
            if error.exit_code != exits.NOT_RUNNING or has_waited or not wait_started(_report_start):
                if name is not None and (meant := _node_meant(name)):
                    raise UsageFault(meant) from None
                raise
            has_waited = True


def _node_meant(word: str) -> str:
    """Return the error text for the name of a node in the place of a graph; empty if it is none."""
    from graphflow.cli.graphs import not_graphs
    from graphflow.cli.graphs.nodes import by_itself

    return not_graphs.answer(word, not_graphs.running()) or by_itself(f"/{word.strip('/')}")


def _report_start(start: Start) -> None:
    output.talk(f"waiting for {start}")


@click.command(cls=Verb)
@_graph
@_everywhere
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def ps(name: str | None, everything: bool, as_json: bool) -> int:
    """List the nodes of running graphs in this domain: state, process and uptime."""
    from graphflow.cli.graphs.node_rows import node_rows
    from graphflow.supervisor.control.choosing import choose, running_here

    runs = [choose(name)] if name else running_here(everything=everything)
    rows: list[tuple[GraphRun, NodeRow]] = []
    silent = []
    for run in runs:
        try:
            rows += [(run, row) for row in node_rows(run.socket, PS_LIMIT)]
        except SupervisorError:
            silent.append(run)
    if as_json:
        output.as_json([{"graph": run.graph, "domain": run.domain, **row} for run, row in rows])
    elif rows:
        output.lines(_table(rows))
    for run in runs:
        if run.unguarded:
            output.talk(f"warning: {run.graph}: {run.guard_again}")
    for run in silent:
        output.error(
            f"the supervisor of {run.graph} (process {run.pid}) does not answer; if stopped: kill -CONT {run.pid}"
        )
    return exits.TIMEOUT if silent else exits.OK


def _table(rows: list[tuple[GraphRun, NodeRow]]) -> list[str]:
    head = ("GRAPH", "NODE", "STATE", "PID", "FOR", "CLASS")
    now = time.time()
    cells = [head] + [
        (
            run.graph,
            row["node"],
            (row.get("lifecycle") or row["state"])
            + (f" ({shorten(row['detail'], DETAIL, placeholder=' ...')})" if row["detail"] else ""),
            str(row["pid"] or "-"),
            ago(now - row["since"]),
            row["class"],
        )
        for run, row in rows
    ]
    return output.columns(cells)


@click.command()
@click.argument("nodes", nargs=-1, metavar="[NODE]...")
@click.option("-f", "--follow", is_flag=True, help="Keep printing new lines, until Ctrl-C.")
@click.option("-n", "--lines", type=click.IntRange(0), help="Only the last N lines of each node.")
@click.option("--node", "more", multiple=True, metavar="NODE", help="Same as NODE.")
@click.option("--level", type=click.Choice(LEVELS), help="Only messages of this level or higher.")
@click.option("--since", metavar="TIME", help="Only messages of the last 30s, 5m or 2h, or since 14:05[:30].")
@_graph
@click.option("--json", "as_json", is_flag=True, help="Print each line as a line of JSON.")
def logs(
    nodes: tuple[str, ...],
    follow: bool,
    lines: int | None,
    more: tuple[str, ...],
    level: str | None,
    since: str | None,
    name: str | None,
    as_json: bool,
) -> int:
    """Show the logs of a graph's nodes, even after it has ended."""
    from graphflow.cli.graphs.loglines import Chosen
    from graphflow.cli.graphs.streaming import LogReader
    from graphflow.names import did_you_mean
    from graphflow.supervisor import rundir
    from graphflow.supervisor.control.choosing import choose
    from graphflow.supervisor.last_end import how_ended

    try:
        folder = Path(choose(name).logs)
        alive = True
    except SupervisorError as error:
        if error.exit_code != exits.NOT_RUNNING:
            raise
        found = rundir.latest_logs(name)
        if found is None:
            raise
        folder, alive = found, False
        output.talk(f"{error}\nthe latest run of {folder.parent.name}, {folder.name}:")
        if how := how_ended(folder):
            output.talk(f"how it ended: {how}")
    files = {f.stem: f for f in sorted(folder.glob("*.log")) if f.name != rundir.SUPERVISOR_LOG}
    wanted = [n.strip("/").replace("/", ".") for n in (*nodes, *more)] or list(files)
    for node in wanted:
        if node not in files:
            raise SupervisorError(f"{node!r} has no log in {folder}{did_you_mean(node, files)}")
    chosen = Chosen(level, since) if level or since else None
    reader = LogReader([files[n] for n in wanted], max(map(len, wanted), default=0), chosen, as_json=as_json)
    reader.show(last=lines)
    while follow and alive:
        time.sleep(0.1)
        reader.show()
        alive = any(str(folder) == r.logs for r in rundir.running())
    reader.show()
    if not reader.count and lines != 0:
        output.talk(f"no lines{' of that level or time' if chosen else ''}; the logs are in {folder}")
    return exits.OK
