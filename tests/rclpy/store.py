"""Something with a lock of its own, in a file of its own, whose attributes nobody confuses with a node's."""

from __future__ import annotations

import threading
import time

LONG = 0.8
"""Seconds that everything takes."""


class Store:
    """Has a lock of the same name as a node's."""

    def __init__(self) -> None:
        self.lock = threading.Lock()

    def fill(self) -> None:
        """Keep it for long."""
        with self.lock:
            time.sleep(LONG)
