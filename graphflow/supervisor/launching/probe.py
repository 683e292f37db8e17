"""Probe classes for their interfaces by importing them in a child process: for `check`, without a supervisor."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterable
from typing import TYPE_CHECKING

from graphflow.supervisor.processes.preload import PROBE_LIMIT, answer_probe, probe_result, sweep
from graphflow.system import detached, end_with_parent

if TYPE_CHECKING:
    from graphflow.supervisor.processes.messages import InterfacesJson, ProbeRequest


def probe(classes: Iterable[str], root: str) -> InterfacesJson:
    """Return the interface of each class, with the slips in its source."""
    return finish(begin(classes, root, with_slips=True), classes)


def begin(classes: Iterable[str], root: str, *, with_slips: bool = False) -> subprocess.Popen[bytes]:
    """Start importing classes."""
    request: ProbeRequest = {
        "classes": sorted(set(classes)),
        "root": root,
        "slips": with_slips,
        "parent": os.getpid(),
    }
    return subprocess.Popen(
        [sys.executable, "-P", "-m", "graphflow.supervisor.launching.probe", json.dumps(request)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        **detached(),
    )


def finish(probing: subprocess.Popen[bytes], classes: Iterable[str]) -> InterfacesJson:
    """Return the result of the import, and end the processes that it has started."""
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
    request: ProbeRequest = json.loads(sys.argv[1])
    end_with_parent(request["parent"], int(signal.SIGKILL))  # so that an import that never ends does
    answer_probe(request, os.dup(1))
    os._exit(0)  # a thread that the import has started may never end
