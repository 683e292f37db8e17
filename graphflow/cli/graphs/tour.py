"""`graphflow demo` in the console: each example runs until the user ends its deadlock and continues."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory, TemporaryFile

from graphflow.cli import exits, output
from graphflow.cli.graphs.console import COMMAND, open_console
from graphflow.cli.graphs.examples import Step, graph_file, heading
from graphflow.errors import SupervisorError
from graphflow.supervisor.rundir import GraphRun, running
from graphflow.workspace.project import demos_root

_START_LIMIT = 20.0
_END_LIMIT = 20.0


def tour(steps: Sequence[Step]) -> int:
    """Show examples, in a copy of their project that the user may change; return the exit code."""
    with TemporaryDirectory(prefix="graphflow-tour-") as folder:
        root = _copy(Path(folder))
        for i, step in enumerate(steps, 1):
            where = f"{i}/{len(steps)} {step.name}"
            left = _run_step(root, step, "broken", where)
            if left == "fixed":
                left = _run_step(root, step, "fixed", where)
            if left != "next":
                break
    on = f"; to continue later: graphflow demo deadlock --from {step.name}" if left != "next" else ""
    output.talk(f"the tour is over, and its graph is down{on}")
    return exits.FAILED if left == "failed" else exits.OK


def _copy(folder: Path) -> Path:
    for name in ("graphs", "nodes", "interfaces"):
        shutil.copytree(demos_root() / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "pyproject.toml").touch()
    return folder


def _run_step(root: Path, step: Step, kind: str, where: str) -> str:
    """Run one graph with the console on it; return how the console was left."""
    file = root / "graphs" / "deadlock" / graph_file(step.name, kind).name
    text = file.read_text(encoding="utf-8")
    options: dict[str, object] = {"title": heading(file), "step": where, "seconds": step.seconds}
    if kind == "fixed":
        options["fixed"] = text.partition("\n")[2].rstrip()
    with _up(file) as run:
        left: str = open_console(run, run.domain, layout=_windows(options, "turtlesim" in text)).how
        return left


@contextmanager
def _up(file: Path) -> Iterator[GraphRun]:
    """Run a graph inside the block, and no longer than this process lives."""
    env = {**os.environ, "GRAPHFLOW_ENDS_WITH": str(os.getpid())}
    with TemporaryFile("w+") as errors:
        words = [*COMMAND, "up", "--no-console", str(file)]
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=errors, env=env)
        try:
            deadline = time.monotonic() + _START_LIMIT
            while not (found := [run for run in running() if run.file == str(file)]):
                if process.poll() is not None or time.monotonic() > deadline:
                    errors.seek(0)
                    raise SupervisorError(f"{file.name} did not start:\n{errors.read()}")
                time.sleep(0.02)
            yield found[0]
        finally:
            process.send_signal(signal.SIGINT)
            try:
                process.wait(_END_LIMIT)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def _windows(options: dict[str, object], has_turtle: bool) -> dict[str, object]:
    """Lay out one window: the guide, and beside it the turtle and the log."""
    beside = [{"view": name} for name in (["turtle"] if has_turtle else []) + ["log"]]
    panes = [{"view": "tour", "options": options, "size": 58}, {"split": "rows", "of": beside, "size": 42}]
    return {"windows": [{"name": "tour", "root": {"split": "columns", "of": panes}}]}
