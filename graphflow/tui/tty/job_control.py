"""The console as a job of its shell: stopped by Ctrl-Z and others, and continued."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from collections.abc import Callable
from typing import Any

from textual.app import App


class JobControl:
    """Gives the terminal to the shell, and takes it back.

    Args:
        app: The console, whose terminal it is.
        taken: Called when it has the terminal again.
    """

    def __init__(self, app: App[Any], taken: Callable[[], object]) -> None:
        self._app, self._taken = app, taken

    @property
    def has_shell(self) -> bool:
        """Whether there may be a shell behind the console."""
        return not (self._app.is_headless or self._app.is_web or sys.platform == "win32")

    def hear_signals(self) -> None:
        """Take the terminal anew when the process goes on after a SIGSTOP.

        Textual would start it a second time beside the first, whose threads then keep the process from ending. A
        SIGTSTP of others would leave the terminal as it is: Ctrl-Z goes through `pause`.
        """
        if self.has_shell:
            loop = asyncio.get_running_loop()
            loop.add_signal_handler(signal.SIGCONT, self._take_terminal)
            loop.add_signal_handler(signal.SIGTSTP, lambda: None)

    def _take_terminal(self) -> None:
        with self._app.suspend():  # to leave the terminal and come back is what sets it up
            self._taken()

    def pause(self) -> None:
        """Stop until the shell says `fg`; the graph runs on.

        Where no shell could continue it, the signal does nothing, and the console goes on at once.
        """
        loop = asyncio.get_running_loop()
        loop.remove_signal_handler(signal.SIGTSTP)
        loop.remove_signal_handler(signal.SIGCONT)
        with self._app.suspend():
            os.kill(os.getpid(), signal.SIGTSTP)
        self.hear_signals()
        self._app.refresh(layout=True)
