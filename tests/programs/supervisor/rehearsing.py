"""A script that rehearses."""

from __future__ import annotations

import threading

from graphflow.supervisor.rehearsal import rehearse

assert rehearse(), "it did not hear itself"
assert threading.active_count() == 1, threading.enumerate()
