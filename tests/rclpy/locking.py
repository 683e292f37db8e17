"""Code that holds locks, in a file of its own: what is done to them elsewhere would count as well."""

from __future__ import annotations

import threading
from typing import Any

WHOSE = threading.Lock()


class Account:
    def __init__(self) -> None:
        self.lock = threading.RLock()


class Bank:
    """Each method pauses inside of a lock, and outside of it."""

    shared = threading.Lock()

    def __init__(self) -> None:
        self.account = Account()
        self.first, self.signal, self.given = threading.Lock(), threading.Lock(), threading.Lock()
        self.loose, self.shown = threading.Lock(), threading.Lock()
        self.condition = threading.Condition(self.given)

    def enters(self) -> Any:
        with self.first:
            yield
        yield

    def enters_part(self) -> Any:
        account = self.account
        with account.lock:
            yield
        yield

    def enters_what_all_have(self) -> Any:
        with self.shared, WHOSE:
            yield
        yield

    def acquires(self) -> Any:
        self.first.acquire()
        try:
            yield
        finally:
            self.first.release()
        yield

    def lets_go_within(self) -> Any:
        with self.loose:
            self.loose.release()
            yield
            self.loose.acquire()

    def shows(self) -> Any:
        known = self.shown
        return known

    def takes_signal(self) -> Any:
        self.signal.acquire()
        yield

    def gives_signal(self) -> None:
        self.signal.release()

    def tries(self) -> Any:
        if self.first.acquire(timeout=1.0):
            yield
            self.first.release()

    def is_inside_on_one_line(self) -> Any:
        # fmt: off
        with self.first: yield  # noqa: E701 - that is the case
        # fmt: on
