"""The console as a job of its shell: suspended by Ctrl-Z, and resumed."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from collections.abc import Callable

from textual.app import App


class JobControl:
    """Gives the terminal to the shell, and takes it back.

    Args:
        app: The console that owns the terminal.
        taken: Called when the console has the terminal again.
    """

    def __init__(self, app: App[str], taken: Callable[[], object]) -> None:
        self._app, self._taken = app, taken

    @property
    def has_shell(self) -> bool:
        """Whether a shell may be able to resume the console."""
        return not (self._app.is_headless or self._app.is_web or sys.platform == "win32")

    def handle_signals(self) -> None:
        """Handle SIGCONT and SIGTSTP in place of Textual.

        After a SIGSTOP, Textual would start a second driver beside the first, whose threads then keep the process from
        exiting. A SIGTSTP from elsewhere would leave the terminal in raw mode: Ctrl-Z goes through `pause` instead.
        """
        if self.has_shell:
            loop = asyncio.get_running_loop()
            loop.add_signal_handler(signal.SIGCONT, self._take_terminal)
            loop.add_signal_handler(signal.SIGTSTP, lambda: None)

    def _take_terminal(self) -> None:
        with self._app.suspend():  # suspending and resuming the driver sets the terminal up
            self._taken()

    def pause(self) -> None:
        """Suspend the process until the shell's `fg`; the graph runs on.

        If no shell could resume it, the signal has no effect, and the console goes on at once.
        """
        loop = asyncio.get_running_loop()
        # The default action of SIGTSTP stops the process; after SIGCONT, leaving `suspend` restores the terminal.
        loop.remove_signal_handler(signal.SIGTSTP)
        loop.remove_signal_handler(signal.SIGCONT)
        with self._app.suspend():
            os.kill(os.getpid(), signal.SIGTSTP)
        self.handle_signals()
        self._app.refresh(layout=True)
