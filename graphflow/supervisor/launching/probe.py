"""Interfaces of classes by importing them in a child of its own: for `check`, without a supervisor."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterable
from typing import Any

from graphflow.supervisor.processes.preload import PROBE_LIMIT, answer_probe, probe_result, sweep
from graphflow.system import detached, end_with_parent


def probe(classes: Iterable[str], root: str) -> dict[str, Any]:
    """What each class declares, as `classes.interfaces` returns it, with the slips in its source."""
    return finish(begin(classes, root, with_slips=True), classes)


def begin(classes: Iterable[str], root: str, *, with_slips: bool = False) -> subprocess.Popen[bytes]:
    """Start importing classes."""
    asked = {"classes": sorted(set(classes)), "root": root, "slips": with_slips, "parent": os.getpid()}
    request = json.dumps(asked)
    command = [sys.executable, "-P", "-m", "graphflow.supervisor.launching.probe", request]
    quiet: dict[str, Any] = {"stdin": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, **detached()}
    return subprocess.Popen(command, stdout=subprocess.PIPE, **quiet)


def finish(probing: subprocess.Popen[bytes], classes: Iterable[str]) -> dict[str, Any]:
    """The result of the import; what it has started ends here."""
    with probing:
        try:
            out, _ = probing.communicate(timeout=PROBE_LIMIT)
        except subprocess.TimeoutExpired:
            return probe_result(b"", False, sorted(set(classes)), 0)
        finally:
            probing.kill()
            if hasattr(os, "killpg"):
                sweep(probing.pid)
    return probe_result(out, True, sorted(set(classes)), probing.returncode)


if __name__ == "__main__":
    asked: dict[str, Any] = json.loads(sys.argv[1])
    end_with_parent(asked["parent"], int(signal.SIGKILL))  # an import that never ends ends with who waits for it
    answer_probe(asked, os.dup(1))
    os._exit(0)  # a thread that the import has started may never end
