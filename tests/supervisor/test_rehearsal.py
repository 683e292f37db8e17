"""The rehearsal in the preload process."""

from __future__ import annotations

import subprocess
import sys

SCRIPT = """
import threading
from graphflow.supervisor.rehearsal import rehearse

assert rehearse(), "it did not hear itself"
assert threading.active_count() == 1, threading.enumerate()
"""


def test_it_leaves_nothing_behind() -> None:
    """It runs to its end, says nothing to anybody, and starts no thread: forking goes on being safe."""
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
