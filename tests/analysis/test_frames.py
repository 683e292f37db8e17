"""What code has in its frames, copied while its owner is known to be there."""

from __future__ import annotations

import gc
import subprocess
import sys
import threading
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from dataclasses import replace
from types import FrameType

import pytest

from graphflow.analysis import frames
from graphflow.analysis.frames import awaited, code_of, running, stack_of, suspended, uncollected
from tests.cases import slow


def counting(limit: int) -> Generator[FrameType, None, None]:
    """Yield its own frame, which may outlive it."""
    for _number in range(limit):
        yield sys._getframe()


def test_a_suspended_generator_shows_its_locals() -> None:
    """As they are now; the copy stays what it is."""
    steps = counting(3)
    next(steps)
    first = suspended(steps)
    next(steps)
    second = suspended(steps)
    assert first is not None
    assert second is not None
    assert (first.f_locals["_number"], second.f_locals["_number"]) == (0, 1)
    assert first.f_code is counting.__code__
    assert first == second
    assert len({first, second}) == 1


def test_a_frame_whose_generator_was_closed() -> None:
    """CPython 3.13 would read freed memory, whether the generator is still there or not. 3.12 keeps what it had."""
    steps = counting(3)
    frame = next(steps)
    steps.close()
    assert suspended(steps) is None
    left = next(counting(3))
    for gone in (frame, left):
        assert running(gone).f_locals in ({}, {"limit": 3, "_number": 0})
        assert running(gone).f_code is counting.__code__


def test_a_running_generator_is_read() -> None:
    """It has a caller, to which it returns."""

    def looking() -> Generator[dict[str, object], None, None]:
        answer = 42
        assert answer
        yield running(sys._getframe()).f_locals

    assert next(looking())["answer"] == 42


def test_a_function_that_has_ended_is_read() -> None:
    """Its frame keeps what it had."""

    def ended() -> FrameType:
        answer = 42
        assert answer
        return sys._getframe()

    assert running(ended()).f_locals["answer"] == 42


def test_the_column_of_what_runs() -> None:
    """It is that of the expression in its line; a frame whose instruction is not known has none."""
    steps = counting(1)
    next(steps)
    copy = suspended(steps)
    here = running(sys._getframe())
    assert copy is not None
    assert copy.column == len("        ")
    assert here.column == len("    here = ")
    assert replace(here, f_lasti=-1).column is None


def test_other_awaitables_have_no_frame() -> None:
    """Futures, and objects with an `__await__` of their own."""
    assert suspended(None) is None
    assert suspended(object()) is None
    assert code_of(object()) is None
    assert list(awaited(None)) == []


def test_code_of_what_is_suspended() -> None:
    """It is gone with the end."""
    steps = counting(1)
    assert code_of(steps) is counting.__code__
    steps.close()
    assert code_of(steps) is None


def test_stack_of_a_thread() -> None:
    """From the outermost frame to the innermost; of an unknown thread there is none."""
    gate, inside = threading.Event(), threading.Event()

    def inner() -> None:
        inside.set()
        gate.wait()

    thread = threading.Thread(target=inner)
    thread.start()
    assert inside.wait(10.0)
    assert thread.ident is not None
    names = [frame.f_code.co_name for frame in stack_of(thread.ident)]
    gate.set()
    thread.join()

    assert names.index("run") < names.index("inner")
    assert stack_of(-1) == []


_COLLECTING = """
import gc, threading, time
from graphflow.analysis.frames import stack_of

def leaf(a, b):
    return [a, b]

def work():
    while True:
        leaf(1, 2)

worker = threading.Thread(target=work, daemon=True)
worker.start()
gc.callbacks.append(lambda *_: threading.current_thread() is worker or time.sleep(0.0002))
gc.set_threshold(3)
kept = []
for number in range(60):
    kept += [[] for _ in range(number % 3)]
    kept.append(stack_of(worker.ident))
assert gc.isenabled()
"""


@slow
def test_a_stack_that_is_read_while_collections_run() -> None:
    """They let other threads run; CPython 3.11 would then read frames that are gone, and crash."""
    subprocess.run([sys.executable, "-c", _COLLECTING], check=True, timeout=60)


def test_collections_that_wait() -> None:
    """In CPython 3.11 alone; afterwards they run again."""
    assert gc.isenabled()
    with uncollected():
        assert gc.isenabled() is (sys.version_info >= (3, 12))
    assert gc.isenabled()


@pytest.mark.parametrize("read", [lambda: suspended(counting(1)), lambda: stack_of(threading.get_ident())])
def test_what_is_read_while_collections_wait(monkeypatch: pytest.MonkeyPatch, read: Callable[[], object]) -> None:
    """Frames that others may leave at any moment."""
    waits: list[bool] = []

    @contextmanager
    def noted() -> Iterator[None]:
        waits.append(True)
        yield

    monkeypatch.setattr(frames, "uncollected", noted)
    assert read()
    assert waits


def test_a_program_without_collections() -> None:
    """They stay off, if the program has switched them off."""
    gc.disable()
    try:
        with uncollected():
            pass
        assert not gc.isenabled()
    finally:
        gc.enable()
