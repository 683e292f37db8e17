"""`graphflow demo`: walk through the example graphs step by step, in the console or as text."""

from __future__ import annotations

import os
import queue
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import IO

import click

from graphflow.cli import exits, output
from graphflow.cli.graphs.examples import DEADLOCKS, Step, graph_file, heading
from graphflow.cli.verbs import Verbs
from graphflow.domain import go_to
from graphflow.errors import UsageFault
from graphflow.names import did_you_mean

_AFTER_REPORT = 1.0
"""Seconds that a broken graph keeps running after its deadlock was reported."""
_END_LIMIT = 20.0


@click.group(cls=Verbs)
def demo() -> None:
    """Walk through an example, step by step."""


@demo.command()
@click.argument("steps", nargs=-1, metavar="[STEP]...")
@click.option("-l", "--list", "only_list", is_flag=True, help="Only list the steps.")
@click.option("--no-console", is_flag=True, help="Print everything instead of opening the console.")
@click.option("--from", "first", metavar="STEP", help="Begin with STEP and continue to the last.")
@click.option("-y", "--yes", is_flag=True, help="Print everything without asking before each step.")
def deadlock(steps: tuple[str, ...], only_list: bool, no_console: bool, first: str | None, yes: bool) -> int:
    """Show eleven deadlocks and races, and their remedies. Each is explained, then fixed by a change of its graph file.

    In the console you end each deadlock yourself; it shows which keys to press. Without a terminal, or with
    --no-console, the graphs' output is printed. They run in a domain and on a port of their own. Name STEPs to run
    only those.
    """
    known = {step.name: step for step in DEADLOCKS}
    if only_list:
        output.lines(f"{step.name:16} {heading(graph_file(step.name, 'broken'))}" for step in DEADLOCKS)
        return exits.OK
    for name in (*steps, *([first] if first else [])):
        if name not in known:
            raise UsageFault(f"there is no step {name!r}{did_you_mean(name, known) or '; --list shows all'}")
    if first:
        if steps:
            raise UsageFault(f"give either STEPs or --from; for one step: graphflow demo deadlock {first}")
        steps = tuple(known)[list(known).index(first) :]
    from graphflow.transport.rendezvous import free_endpoint

    go_to(1000 + os.getpid(), free_endpoint())
    if not (no_console or yes) and output.is_terminal():
        from graphflow.cli.graphs.tour import tour

        return tour([known[name] for name in steps or known])
    asks = sys.stdin.isatty() and not yes
    for i, step in enumerate(known[name] for name in steps or known):
        if i and asks:
            click.prompt("\nEnter for the next step, Ctrl-C to stop", default="", show_default=False)
        _show(step, asks=asks)
    return exits.OK


def _show(step: Step, *, asks: bool) -> None:
    for kind in ("broken", "fixed"):
        file = graph_file(step.name, kind)
        if kind == "fixed" and asks:
            click.prompt("\nEnter to see it fixed", default="", show_default=False)
        output.data(f"\n=== {step.name}, {kind}: {heading(file)}")
        output.data(f"--- {file}")
        output.lines(f"    {line}" for line in file.read_text(encoding="utf-8").splitlines()[1:])
        output.data("--- graphflow up")
        for line in _run(file, step.seconds):
            output.data(f"    {line}")


def _run(file: Path, seconds: float) -> Iterator[str]:
    """Run a graph for some seconds and yield the lines that it prints."""
    command = [sys.executable, "-m", "graphflow.cli.main", "up", str(file)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    assert process.stdout is not None
    lines: queue.SimpleQueue[str | None] = queue.SimpleQueue()
    threading.Thread(target=_collect, args=(process.stdout, lines), daemon=True).start()
    end = time.monotonic() + seconds
    try:
        while (left := end - time.monotonic()) > 0:
            try:
                line = lines.get(timeout=left)
            except queue.Empty:
                break
            if line is None:
                break
            if "DEADLOCK: " in line:
                end = min(end, time.monotonic() + _AFTER_REPORT)
            yield line
    finally:
        process.send_signal(signal.SIGINT)
        try:
            process.wait(_END_LIMIT)
        except subprocess.TimeoutExpired:
            process.kill()


def _collect(stream: IO[str], lines: queue.SimpleQueue[str | None]) -> None:
    for line in stream:
        lines.put(line.rstrip("\n"))
    lines.put(None)
