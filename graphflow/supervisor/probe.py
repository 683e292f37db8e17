"""Interfaces of classes by importing them in a child of its own: for `check`, without a supervisor."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterable
from typing import Any

from graphflow.supervisor.preload import PROBE_LIMIT, answer_probe, probe_result


def probe(classes: Iterable[str], root: str) -> dict[str, Any]:
    """What each class declares, as `worker.interfaces` gives it."""
    wanted = sorted(set(classes))
    request = json.dumps({"classes": wanted, "root": root})
    command = [sys.executable, "-P", "-m", "graphflow.supervisor.probe", request]
    try:
        result = subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, timeout=PROBE_LIMIT, check=False
        )
    except subprocess.TimeoutExpired:
        return probe_result(b"", False, wanted)
    return probe_result(result.stdout, True, wanted)


if __name__ == "__main__":
    answer_probe(json.loads(sys.argv[1]), os.dup(1))
