"""A script that warms up."""

from __future__ import annotations

import threading

from graphflow.supervisor.processes.warmup import warm_up

assert warm_up(), "it did not hear itself"
assert threading.active_count() == 1, threading.enumerate()
