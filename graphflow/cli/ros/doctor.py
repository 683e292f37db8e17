"""`graphflow doctor`: report problems and their remedies; `doctor hello`: test which machines reach each other."""

from __future__ import annotations

import os
import re
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from importlib import metadata

import click

from graphflow.cli import exits, output
from graphflow.cli.ros.supervised import supervised
from graphflow.cli.verbs import Verbs
from graphflow.domain import domain_id
from graphflow.errors import SupervisorError
from graphflow.introspect import concurrency, installation
from graphflow.introspect.empty_hint import nothing_here
from graphflow.introspect.graph_view import View
from graphflow.introspect.health import Look, examine, needs_second
from graphflow.introspect.lifecycles import idle
from graphflow.machines.matching import complaints
from graphflow.names import is_hidden
from graphflow.rclpy import enabling
from graphflow.wire.process import NUMBERS, WAITS, answer_key, stopped

ANSWER_LIMIT = 1.0
"""Seconds that the processes of a graph have to answer."""
LATE = 1.0
"""Seconds by which an event loop that was late once is named."""
SAMPLE_INTERVAL = 0.5
"""Seconds between two readings of the nodes' counters."""

NAMED = 10
"""Nodes of one kind that are named, before the rest are counted."""

Findings = dict[str, list[str]]
"""Texts of findings, by the name of the check."""


@click.group(cls=Verbs, invoke_without_command=True, subcommand_metavar="[hello]")
@click.option("-r", "--report", is_flag=True, help="Print a full report on this system and the graph.")
@click.option("-rf", "--report-failed", is_flag=True, help="Print only the sections of the report whose check failed.")
@click.option("-iw", "--include-warnings", is_flag=True, help="Count hints as faults.")
@click.option(
    "-ep", "--exclude-packages", is_flag=True, hidden=True, help="Accepted for ROS 2; no packages are checked."
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def doctor(report: bool, report_failed: bool, include_warnings: bool, as_json: bool, **_: bool) -> int:
    """Check the running graph for problems: deadlocks, groups occupied for long, processes that do not answer, event
    loops that are blocked or were late, incompatible endpoints, duplicate node names, nodes that receive their own
    messages, lost messages, floods of log messages, topics without publishers, remap rules that match nothing, clocks
    that differ. Also check the installation, graphs that were killed, and a ROS 2 in this shell that could not see the
    graph.

    Exit code 1: there is a fault. Late event loops do not count, nor do hints without --include-warnings.
    """
    if click.get_current_context().invoked_subcommand is not None:
        return exits.OK
    try:
        view = View(domain_id())
    except SupervisorError as error:
        if error.exit_code != exits.NOT_RUNNING or not _check_installation(report=report, as_json=as_json):
            raise
        return exits.OK
    with view:
        first = _sample(view)
        here, remarks = _here()  # takes a while, by which the second sample, if needed, is later
        faults, notes, count = _graph(view, first)
    faults |= here
    notes |= remarks
    failed = [name for name, texts in faults.items() if texts]
    if as_json:
        output.as_json({**faults, **notes})
    elif not report:
        _print(faults, notes, count)
    if (report or report_failed) and not as_json:
        from graphflow.cli.ros.report import sections

        output.lines(sections(None if report else failed))
    is_well = not failed and not (include_warnings and notes["hints"])
    return exits.OK if is_well else exits.FAILED


def _check_installation(*, report: bool, as_json: bool) -> bool:
    """Print the findings without a running graph; return whether a report was wanted and there is no fault."""
    here, remarks = _here()
    if report:
        from graphflow.cli.ros.report import installed

        output.lines(installed())
    if as_json:
        output.as_json({**here, **remarks})
    elif not report:
        output.lines(text for texts in [*here.values(), *remarks.values()] for text in texts)
    return report and not any(here.values())


def _here() -> tuple[Findings, Findings]:
    """Check this machine without the graph; return faults and notes."""
    faults = {"installation": list(installation.faults(_environment(), _version)), "runs": list(_unguarded())}
    notes = {
        "rclpy": list(_whose_rclpy()),
        "left": list(_left_over()),
        "starts": list(installation.recompiled(installation, writes=not sys.dont_write_bytecode)),
    }
    return faults, notes


def _graph(view: View, first: Look) -> tuple[Findings, Findings, int]:
    """Check the graph; return faults, notes and the number of its nodes."""
    read = concurrency.read(view.reports(answer_key(view.domain, WAITS), ANSWER_LIMIT))
    second = first
    if needs_second(view, first):
        time.sleep(max(0.0, first.at + SAMPLE_INTERVAL - time.monotonic()))
        second = _sample(view)
    health = examine(view, first, second)
    ours = view.processes()
    profiles = [f"{p}: nodes beyond it can be listed, but nothing else is known about them" for p in view.profiles()]
    others = [
        name for name in view.cache.nodes(hidden=False) if not any(e.zid in ours for e in view.cache.owners(name))
    ]
    managed = supervised(view.cache.nodes())
    silent = concurrency.unresponsive(read, view)
    reported = " ".join([*silent, *managed.faults])
    silent += [text for pid, text in stopped(view.domain).items() if not re.search(rf"\b{pid}\b", reported)]
    faults = {
        "deadlocks": read.reports,
        "stalls": read.stalls,
        "unresponsive": silent,
        "supervised": [text for text in managed.faults if not _is_reported(text, silent)],
        "blocked": [
            f"{who}: the event loop has been blocked for {seconds:.1f} s; see its log" for who, seconds in read.blocked
        ],
        "misfits": list(complaints(view.cache)),
        "health": health.faults,
    }
    lifecycles = idle(view, ANSWER_LIMIT)
    late = [
        f"{who}: the event loop was late {'once' if n == 1 else f'{n} times'}, by {most:.1f} s at most"
        for who, n, most in read.late
        if n > 1 or most >= LATE  # on a busy machine, any is late now and then
    ]
    unread = (
        [f"processes running another version of graphflow, not understood: {read.unreadable}"]
        if read.unreadable
        else []
    )
    notes = {
        "late": late,
        "hints": [*health.hints, *lifecycles.hints, *managed.ended],
        "silent": others,
        "unreadable": unread,
        "unseen": [*managed.unseen, *_unknown(lifecycles.unknown)],
        "kept_back": profiles,
    }
    return faults, notes, sum(not is_hidden(name) for name in read.nodes)


def _unknown(nodes: Sequence[str]) -> list[str]:
    """Return a line that names lifecycle nodes whose states are not known."""
    if not nodes:
        return []
    more = f" and {len(nodes) - NAMED} more" if len(nodes) > NAMED else ""
    return [f"lifecycle nodes that did not tell their states: {', '.join(nodes[:NAMED])}{more}"]


def _sample(view: View) -> Look:
    at, began_ns = time.monotonic(), time.time_ns()
    return Look(view.reports(answer_key(view.domain, NUMBERS), ANSWER_LIMIT), began_ns, time.time_ns(), at)


def _print(faults: Findings, notes: Findings, count: int) -> None:
    output.lines(f"{text}\n" for name in ("deadlocks", "stalls") for text in faults[name])
    output.lines(t for name, texts in faults.items() if name not in ("deadlocks", "stalls") for t in texts)
    output.lines([*notes["late"], *notes["hints"], *notes["rclpy"], *notes["starts"]])
    if notes["silent"]:
        beyond = ", or beyond a net profile" if notes["kept_back"] else ""
        output.data(f"not graphflow nodes{beyond}, so their handlers are unknown: {', '.join(notes['silent'])}")
    output.lines([*notes["kept_back"], *notes["unreadable"], *notes["unseen"]])
    if not any(faults.values()) and not notes["late"]:
        nodes = f"{count} node{'s' if count != 1 else ''}" if count else "no node of graphflow's"
        is_empty = not count and not notes["silent"]
        output.data(nothing_here("no nodes") if is_empty else f"{nodes}, {_verdict(notes)}")


def _verdict(notes: Findings) -> str:
    """Return the last line if there is no fault; it must not vouch for what could not be seen."""
    if any(notes[kind] for kind in ("silent", "unreadable", "unseen", "kept_back")):
        return "no fault in what could be checked; the lines above list what could not"
    return "no fault; the lines above may be intended" if notes["hints"] else "nothing wrong"


def _is_reported(text: str, silent: list[str]) -> bool:
    """Whether the node of a supervisor's fault is already reported as not answering."""
    node = text.partition(" ")[0]
    return any(node in other.split() for other in silent)


def _environment() -> Mapping[str, str]:
    """Return the environment from before this command's options changed it."""
    found: Mapping[str, str] = click.get_current_context().find_root().obj or os.environ
    return found


def _version(name: str) -> str | None:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _whose_rclpy() -> Iterator[str]:
    """Report which rclpy is imported if there are two."""
    other = enabling.elsewhere()
    if other is not None:
        yield f"import rclpy imports that of the ROS 2 in this shell, {other}; graphflow's is used if none is sourced"


def _left_over() -> Iterator[str]:
    from graphflow.supervisor.rundir import left_over

    for folder, run in left_over():
        yield (
            f"graph {run.graph} (domain {run.domain}) was killed and left {folder}: start it again, "
            "which cleans up, or delete that folder"
        )


def _unguarded() -> Iterator[str]:
    from graphflow.supervisor.rundir import running

    for run in running():
        if run.unguarded:
            yield f"graph {run.graph} (domain {run.domain}): {run.guard_again}"


@doctor.command()
@click.option("-t", "--topic", default="/canyouhearme", show_default=True, help="Topic to publish and subscribe to.")
@click.option("-ep", "--emit-period", type=click.FloatRange(0.01), default=0.1, help="Seconds between messages. [0.1]")
@click.option("-pp", "--print-period", type=click.FloatRange(0.1), default=1.0, help="Seconds between tables. [1.0]")
@click.option("-1", "--once", is_flag=True, help="Exit after the first table.")
@click.option("--ttl", type=int, hidden=True, help="Accepted for ROS 2; multicast is not used.")
def hello(topic: str, emit_period: float, print_period: float, once: bool, ttl: int | None) -> int:  # noqa: ARG001
    """Find out which machines reach each other: run it on each of them. Ctrl-C ends it."""
    from graphflow.cli.ros.hello import greet

    return greet(topic, emit_period, print_period, once=once)
