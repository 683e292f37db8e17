"""The warm-up in the preload process."""

from __future__ import annotations

import subprocess
import sys

from tests.cases import slow
from tests.conftest import PROGRAMS

SCRIPT = PROGRAMS / "supervisor" / "warming_up.py"


@slow
def test_it_leaves_nothing_behind() -> None:
    """It runs to its end, says nothing to anybody, and starts no thread: forking goes on being safe."""
    done = subprocess.run([sys.executable, SCRIPT], capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
