"""Interfaces of classes by importing them in a child of its own: for `check`, without a supervisor."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterable
from typing import Any

from graphflow.supervisor.preload import PROBE_LIMIT, answer_probe, probe_result, sweep
from graphflow.system import detached


def probe(classes: Iterable[str], root: str) -> dict[str, Any]:
    """What each class declares, as `classes.interfaces` returns it."""
    return finish(begin(classes, root), classes)


def begin(classes: Iterable[str], root: str) -> subprocess.Popen[bytes]:
    """Start importing classes."""
    request = json.dumps({"classes": sorted(set(classes)), "root": root})
    command = [sys.executable, "-P", "-m", "graphflow.supervisor.probe", request]
    quiet: dict[str, Any] = {"stdin": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, **detached()}
    return subprocess.Popen(command, stdout=subprocess.PIPE, **quiet)


def finish(probing: subprocess.Popen[bytes], classes: Iterable[str]) -> dict[str, Any]:
    """The result of the import; what it has started ends here."""
    with probing:
        try:
            out, _ = probing.communicate(timeout=PROBE_LIMIT)
        except subprocess.TimeoutExpired:
            return probe_result(b"", False, sorted(set(classes)))
        finally:
            probing.kill()
            if hasattr(os, "killpg"):
                sweep(probing.pid)
    return probe_result(out, True, sorted(set(classes)))


if __name__ == "__main__":
    answer_probe(json.loads(sys.argv[1]), os.dup(1))
    os._exit(0)  # a thread that the import has started may never end
