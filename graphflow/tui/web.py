"""The console in a browser, on this machine only: each tab is a console of its own."""

from __future__ import annotations

import shlex
from collections.abc import Sequence

from textual_serve.server import Server

HOST = "127.0.0.1"


def serve(words: Sequence[str], port: int) -> None:
    """Serve a page whose tabs each run a command; returns after Ctrl-C.

    Args:
        words: The command.
    """
    Server(shlex.join(words), host=HOST, port=port, title="graphflow").serve()
