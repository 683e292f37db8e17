"""The entry point: Ctrl-C ends the process quietly from here on, even while commands are still being imported."""

from __future__ import annotations

import os
import signal
import sys
from contextlib import suppress
from typing import TYPE_CHECKING

from graphflow.system import collect_rarely

if TYPE_CHECKING:
    from graphflow.supervisor.starts import Announcement


def _end(*_: object) -> None:
    os._exit(0)  # nothing has been started yet, so there is nothing to clean up


_TAKES_INTERRUPTS = signal.getsignal(signal.SIGINT) is signal.default_int_handler
"""Whether Ctrl-C is meant for this process: shells make background processes ignore it."""
if _TAKES_INTERRUPTS:
    signal.signal(signal.SIGINT, _end)


def main() -> None:
    """Run the command that the command line names."""
    collect_rarely()  # until nodes or a supervisor run here
    is_start = sys.argv[1:2] == ["up"]
    if is_start:
        _announce()
    if os.environ.get("GRAPHFLOW_ENDS_WITH"):  # removed from the environment, so that nodes do not inherit it
        from graphflow.system import end_with_parent

        end_with_parent(int(os.environ.pop("GRAPHFLOW_ENDS_WITH")), signal.SIGINT)
    from graphflow.cli.main import main

    if _TAKES_INTERRUPTS:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        main()
    except SystemExit as end:
        if is_start:
            _announced().end()
        _leave(end)


def _announce() -> None:
    """Announce that a graph is being started, so that a `down` given from now on waits for it."""
    from graphflow.errors import SupervisorError

    with suppress(SupervisorError):  # the command meets the same error and reports it
        _announced().begin()


def _announced() -> Announcement:
    from graphflow.supervisor.starts import ANNOUNCEMENT

    return ANNOUNCEMENT


def _leave(end: SystemExit) -> None:
    """End the process without the interpreter's finalization, which takes as long as a listing.

    A process that has run a node ends normally: the user's code may have registered `atexit` functions.
    """
    if "graphflow.runtime.node" not in sys.modules and isinstance(end.code, int):
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(end.code)
    raise end
